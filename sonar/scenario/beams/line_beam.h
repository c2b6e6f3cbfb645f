#pragma once
#include <complex>
#include <span>
#include <string>
#include <string_view>

#include "sonar/scenario/beams/beam.h"

namespace asdic::detail {

enum class Taper { hann, rectangular, omnidirectional };
inline constexpr std::string_view taper_words[] = {"hann", "rectangular", "omnidirectional"};
constexpr std::span<const std::string_view> words(Taper /*any*/) { return taper_words; }

/// A vertical line with a taper: 1 on its axis; real, with the side lobes' signs; the same all
/// round. Hann: sinc(u)/(1 − u²); rectangular: sinc(u); u = (L/λ)(sin θ − sin θ₀),
/// sinc(u) = sin(πu)/(πu). The length follows from the beamwidth: L/λ = u₃/sin(width/2),
/// u₃ = 0.7203 (Hann), 0.4429 (rectangular), λ at the reference wavelength.
/// Source: docs/theory/projector.md
class LinePattern {
 public:
  static constexpr bool azimuthally_symmetric = true;
  LinePattern(Taper taper, double beamwidth, const BeamMount& mount);
  [[nodiscard]] std::complex<double> towards(double /*bearing*/, double elevation) const noexcept {
    return at(elevation);
  }
  [[nodiscard]] double longest_delay() const noexcept { return 2.0 * length() / sound_speed_; }
  [[nodiscard]] double length() const noexcept {
    return length_over_wavelength_ * wavelength_;
  }  ///< [m]

 private:
  [[nodiscard]] double at(double elevation) const noexcept;
  Taper taper_;
  double wavelength_, sound_speed_, length_over_wavelength_ = 0.0, sin_axis_ = 0.0;
};

/// The projector of most scenarios.
struct LineBeam {
  static constexpr std::string_view name = "line";
  static constexpr bool steers = true;
  Taper taper = Taper::hann;
  double beamwidth = 0.10471975511965978;  ///< full −3 dB width of the unsteered line [rad]

  void describe(Fields& field);
  [[nodiscard]] LinePattern pattern(const BeamMount& mount) const {
    return {taper, beamwidth, mount};
  }
  [[nodiscard]] std::string text(double elevation) const;
  /// Full −3 dB width of the main lobe when it is steered to an elevation [rad]. A lobe that
  /// reaches the vertical goes on beyond it, so its width is twice the angle from its edge to the
  /// vertical.
  [[nodiscard]] double steered_width(double elevation) const noexcept;
};

}  // namespace asdic::detail
