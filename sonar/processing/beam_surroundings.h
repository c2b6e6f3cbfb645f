#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "sonar/processing/array_shape.h"

namespace asdic {

/// What the beams around a beam hear at the same time: the background of what is loud at all
/// bearings but not for long (the sea answering from right above or below, the first reverberation
/// of a path), to which the beam's surroundings in time are silent.
///
/// The beams meant are 2 to 6 resolution cells (λ/extent) away. The median of their powers is
/// nearly their mean (0.9 of it where each is the mean of three exponential cells), and a few loud
/// ones among them, another echo, do not count: an ordered-statistic CFAR over bearing; Rohling,
/// IEEE Trans. AES 19, 608 (1983). docs/theory/processing.md, "Background and threshold"
class BeamSurroundings {
 public:
  BeamSurroundings(const ArrayShape& shape, std::span<const Vec3> looks, double wavelength);

  /// Indices of the beams meant; none where fewer than eight are there.
  [[nodiscard]] std::span<const std::uint32_t> of(std::size_t beam) const noexcept {
    return {around_.data() + first_[beam], around_.data() + first_[beam + 1]};
  }

 private:
  std::vector<std::uint32_t> around_;
  std::vector<std::size_t> first_;  // [beams + 1]
};

/// The filters' mean power in every cell of time: what a whole ping's beams hear, in brief.
class CellPowers {
 public:
  /// \param cell  samples of a cell, may be a fraction
  CellPowers(std::size_t filters, std::size_t beams, std::size_t samples, double cell);

  void set(std::size_t filter, std::size_t beam, std::span<const float> power) noexcept;
  /// Mean power there in the cell of a sample and the one on either side.
  [[nodiscard]] float near(std::size_t filter, std::size_t beam, std::size_t sample) const noexcept;
  /// The background by the beams around one; 0 where there are none. \param scratch  any
  [[nodiscard]] float background(const BeamSurroundings& around, std::size_t filter,
                                 std::size_t beam, std::size_t sample,
                                 std::vector<float>& scratch) const;

 private:
  std::size_t beams_, samples_, cells_;
  double cell_;
  std::vector<float> mean_;  // [filters × beams × cells]
};

}  // namespace asdic
