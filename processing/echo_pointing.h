#pragma once
#include <complex>
#include <span>
#include <vector>

#include "processing/array_shape.h"
#include "processing/detection.h"
#include "processing/replica.h"
#include "sonar/synthesis/synthesis.h"

namespace asdic::detail {

/// Where an echo comes from, by the phones' own filter outputs at its time and Doppler factor: the
/// maximum-likelihood direction of one plane wave in white noise. What it refers to must outlive
/// it. Of sub-bands the loudest one tells. docs/theory/processing.md, "Detections"
class EchoPointing {
 public:
  /// \param phones  [channels]   \param weights  [channels], sum 1   \param spacing  of the beams,
  /// BeamGrid::spacing   \param lowest_doppler  of the bank
  EchoPointing(const Baseband& baseband, std::span<const Vec3> phones, double sound_speed,
               const Replica& replica, const ArrayShape& shape, std::span<const double> weights,
               double spacing, double lowest_doppler, int sub_bands = 1);

  /// Sets the direction (look, cosine, bearing, elevation) of what a beam receives at d.time and
  /// d.doppler. \param beam  its look
  void point(Detection& d, const Vec3& beam) const;
  /// |y|² of the conventional beam exactly there.
  [[nodiscard]] double power_at(const Detection& d) const;

 private:
  /// The phones' own outputs at a time and factor, delays taken out as the beam does. Only the
  /// segment of the record that the replica covers is transformed: the rest would add nothing.
  /// \return [sub-bands][phones]
  [[nodiscard]] std::vector<std::vector<std::complex<double>>> snapshot(double time, double doppler,
                                                                        const Vec3& look) const;
  /// y of the conventional beam of one sub-band's outputs.
  [[nodiscard]] std::complex<double> beam_of(const std::vector<std::complex<double>>& x,
                                             const Vec3& look) const;

  const Baseband& baseband_;
  std::span<const Vec3> phones_;
  double sound_speed_;
  const Replica& replica_;
  const ArrayShape& shape_;
  std::span<const double> weights_;
  double spacing_, wavelength_;
  std::vector<double> cuts_;  // between sub-bands [Hz]
  std::size_t cut_;           // samples of baseband that a snapshot looks at
};

}  // namespace asdic::detail
