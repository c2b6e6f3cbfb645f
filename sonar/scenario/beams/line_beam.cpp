#include "sonar/scenario/beams/line_beam.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

#include "core/error.h"
#include "core/text.h"
#include "core/units.h"
#include "sonar/signal/windowed_sinc.h"

namespace asdic::detail {
namespace {

double sinc(double u) noexcept { return sine_over(pi * u); }

/// sinc(u)/(1 − u²). At u = ±1 the zero of the sine cancels that of 1 − u²:
/// sin(πu) = sin(π(1 − u)), so the pattern is sinc(1 − |u|)/(|u|(1 + |u|)), stable at |u| = 1.
double hann_pattern(double u) noexcept {
  const double a = std::abs(u);
  return a < 0.5 ? sinc(a) / (1.0 - a * a) : sinc(1.0 - a) / (a * (1.0 + a));
}

}  // namespace

void LineBeam::describe(Fields& field) {
  field.excludes("a vertical line", {"bearing_deg", "bearing_from", "projector", "table"});
  field("taper", taper, "of the line; omnidirectional is no line");
  if (const auto only = field.only("taper", taper, {Taper::hann, Taper::rectangular}))
    field(live(required("beamwidth")), beamwidth, AngleQuantity{"beamwidth", 0.01, 179.0},
          "full width at -3 dB of the line when it is not steered");
  else
    field.excludes("omnidirectional taper", {"beamwidth_deg"});
}

std::string LineBeam::text(double elevation) const {
  if (taper == Taper::omnidirectional) return "omnidirectional";
  std::ostringstream text;
  text << "elevation " << degrees(elevation) << " deg, beamwidth " << degrees(beamwidth) << " deg";
  const double width = steered_width(elevation);
  if (width > 1.05 * beamwidth)
    text << " unsteered, " << std::setprecision(3) << degrees(width) << " deg as it is steered";
  return text.str();
}

double LineBeam::steered_width(double elevation) const noexcept {
  // The pattern depends on sin θ − sin θ₀ alone, and is −3 dB where that is ± sin(width/2).
  const double axis = std::sin(elevation), beside = std::sin(0.5 * beamwidth);
  const auto edge = [](double sine) { return std::asin(std::clamp(sine, -1.0, 1.0)); };
  const double lowest = axis - beside, highest = axis + beside;
  if (lowest <= -1.0 && highest >= 1.0) return 2.0 * pi;
  if (highest >= 1.0) return 2.0 * (0.5 * pi - edge(lowest));
  if (lowest <= -1.0) return 2.0 * (edge(highest) + 0.5 * pi);
  return edge(highest) - edge(lowest);
}

LinePattern::LinePattern(Taper taper, double beamwidth, const BeamMount& mount)
    : taper_(taper), wavelength_(mount.wavelength), sound_speed_(mount.sound_speed) {
  if (taper_ == Taper::omnidirectional) return;
  if (!(beamwidth > 0.0 && beamwidth < pi))
    throw InputError(
        {.where = "beamwidth", .got = to_text(beamwidth), .expected = "between 0 and pi rad"});
  // u where the pattern is 1/√2: half of the full −3 dB width.
  const double half_power = taper_ == Taper::hann ? 0.7202912901 : 0.4429464707;
  length_over_wavelength_ = half_power / std::sin(0.5 * beamwidth);
  if (mount.reference > 0.0) length_over_wavelength_ *= mount.reference / mount.wavelength;
  sin_axis_ = std::sin(mount.elevation);
}

double LinePattern::at(double elevation) const noexcept {
  if (taper_ == Taper::omnidirectional) return 1.0;
  const double u = length_over_wavelength_ * (std::sin(elevation) - sin_axis_);
  return taper_ == Taper::rectangular ? sinc(u) : hann_pattern(u);
}

}  // namespace asdic::detail
