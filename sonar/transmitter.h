#pragma once
#include <optional>
#include <string>
#include <vector>

#include "core/units.h"
#include "sonar/pulse.h"
#include "sonar/transmit_pattern.h"

namespace asdic {

enum class Taper { omnidirectional, rectangular, hann };

/// The projector: a vertical line with a taper, steered in elevation; one direction in azimuth (all
/// round).
struct Transmitter {
  double source_level_db =
      220.0;  ///< SL [dB re 1 µPa rms at 1 m]: peak envelope/√2 of the pulse before its window
  double elevation = 0.0;                  ///< of the beam's axis, positive up [rad]
  double beamwidth = 0.10471975511965978;  ///< full −3 dB width of the unsteered line [rad]
  Taper taper = Taper::hann;
  std::string name = "transmitter";
  int platform = 0;                    ///< that carries it, an index
  Vec3 offset = Vec3::Zero();          ///< from the platform [m]
  std::optional<PulseSettings> pulse;  ///< none: the scenario's
  double first_ping_time = 0.0;        ///< since the start of the scenario [s]
  std::optional<double> interval;      ///< from ping to ping [s]; none: the schedule's
  std::vector<double> elevations;      ///< of each ping [rad], repeated as needed; empty: the
                                       ///< schedule's, and without those `elevation`
};

/// Far-field amplitude pattern of a continuous vertical line, 1 on its axis; real, with the side
/// lobes' signs.
///
/// Hann: sinc(u)/(1 − u²); rectangular: sinc(u); u = (L/λ)(sin θ − sin θ₀), sinc(u) = sin(πu)/(πu).
/// The length follows from the beamwidth: L/λ = u₃/sin(width/2), u₃ = 0.7203 (Hann), 0.4429
/// (rectangular). λ is that at the source.
class BeamPattern final : public TransmitPattern {
 public:
  BeamPattern(const Transmitter& transmitter, double wavelength);

  [[nodiscard]] double operator()(
      double elevation) const noexcept;  ///< \param elevation of launch, positive up [rad]
  [[nodiscard]] std::complex<double> towards(double /*bearing*/,
                                             double elevation) const noexcept override {
    return (*this)(elevation);
  }
  [[nodiscard]] bool all_round() const noexcept override { return true; }
  [[nodiscard]] double line_length() const noexcept {
    return length_over_wavelength_ * wavelength_;
  }  ///< [m]

 private:
  Taper taper_;
  double wavelength_, length_over_wavelength_ = 0.0, sin_axis_ = 0.0;
};

}  // namespace asdic
