#include "sonar/transmitter.h"

#include <cmath>
#include <sstream>

#include "core/error.h"
#include "core/units.h"

namespace asdic {
namespace {

double sinc(double u) noexcept {  // sin(πu)/(πu)
  const double x = pi * u;
  return std::abs(x) < 1e-4 ? 1.0 - x * x / 6.0 : std::sin(x) / x;
}

/// sinc(u)/(1 − u²). At u = ±1 the zero of the sine cancels that of 1 − u²:
/// sin(πu) = sin(π(1 − u)), so the pattern is sinc(1 − |u|)/(|u|(1 + |u|)), stable at |u| = 1.
double hann_pattern(double u) noexcept {
  const double a = std::abs(u);
  return a < 0.5 ? sinc(a) / (1.0 - a * a) : sinc(1.0 - a) / (a * (1.0 + a));
}

void require(bool good, const char* where, double got, const char* expected) {
  if (good) return;
  std::ostringstream text;
  text << got;
  throw InputError({.where = where, .got = text.str(), .expected = expected});
}

}  // namespace

BeamPattern::BeamPattern(const Transmitter& transmitter, double wavelength)
    : taper_(transmitter.taper), wavelength_(wavelength) {
  require(wavelength > 0.0 && std::isfinite(wavelength), "wavelength", wavelength, "above 0 m");
  require(std::abs(transmitter.elevation) <= 0.5 * pi, "elevation", transmitter.elevation,
          "between -pi/2 and pi/2 rad");
  if (taper_ == Taper::omnidirectional) return;
  require(transmitter.beamwidth > 0.0 && transmitter.beamwidth < pi, "beamwidth",
          transmitter.beamwidth, "between 0 and pi rad");
  // u where the pattern is 1/√2: half of the full −3 dB width.
  const double half_power = taper_ == Taper::hann ? 0.7202912901 : 0.4429464707;
  length_over_wavelength_ = half_power / std::sin(0.5 * transmitter.beamwidth);
  sin_axis_ = std::sin(transmitter.elevation);
}

double BeamPattern::operator()(double elevation) const noexcept {
  const double u = length_over_wavelength_ * (std::sin(elevation) - sin_axis_);
  switch (taper_) {
    case Taper::omnidirectional:
      return 1.0;
    case Taper::rectangular:
      return sinc(u);
    case Taper::hann:
      return hann_pattern(u);
  }
  return 1.0;
}

}  // namespace asdic
