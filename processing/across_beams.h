#pragma once
#include <map>
#include <span>
#include <vector>

#include "processing/array_shape.h"
#include "processing/beam_surroundings.h"

namespace asdic::detail {

/// Corrects a background over time by what the beams around receive, where that is louder by more
/// than even noise ever makes it. docs/theory/processing.md, "Across the beams"
class AcrossBeams {
 public:
  /// \param phones, weights  must outlive it   \param looks  of the beams   \param cell  of time,
  /// in samples
  AcrossBeams(const ArrayShape& shape, std::span<const Vec3> phones,
              std::span<const double> weights, std::span<const Vec3> looks, double wavelength,
              std::size_t filters, std::size_t samples, double cell);

  /// \param power  [samples] of one beam's filter; any thread, each beam once
  void set(std::size_t filter, std::size_t beam, std::span<const float> power) noexcept {
    received_.set(filter, beam, power);
  }

  /// \param at  with beam, filter, sample, power, background and threshold, the last two corrected
  void correct(auto& at) {
    const float around = background(at.filter, at.beam, at.sample, at.power, at.background);
    if (!(around > at.background)) return;
    at.threshold *= around / at.background;
    at.background = around;
  }

 private:
  float background(std::size_t filter, std::size_t beam, std::size_t sample, double power,
                   float over_time);
  const OwnLeak& leak_of(std::size_t beam);

  std::span<const Vec3> phones_;
  std::span<const double> weights_;
  std::vector<Vec3> looks_;
  double wavenumber_;
  BeamSurroundings around_;
  CellPowers received_;
  std::map<std::size_t, OwnLeak> leaks_;  // of beams, as they are asked for
  std::vector<float> scratch_;
};

}  // namespace asdic::detail
