#include "sonar/scenario/transmitter.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "core/error.h"
#include "core/geometry.h"
#include "core/propagation_memory.h"
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

/// Where a value lies between the nodes of an axis.
struct Between {
  std::size_t low, high;
  double share;
};

Between between(const std::vector<double>& axis, double value) noexcept {
  const auto above =
      static_cast<std::size_t>(std::upper_bound(axis.begin(), axis.end(), value) - axis.begin());
  if (above == 0) return {0, 0, 0.0};
  if (above == axis.size()) return {above - 1, above - 1, 0.0};
  return {above - 1, above, (value - axis[above - 1]) / (axis[above] - axis[above - 1])};
}

Between between_on_circle(const std::vector<double>& axis, double angle) noexcept {
  double a = std::fmod(angle - axis.front(), 2.0 * pi);
  if (a < 0.0) a += 2.0 * pi;
  a += axis.front();  // from the first node to a turn further
  if (a < axis.back() || axis.size() == 1) return between(axis, a);
  const double gap = axis.front() + 2.0 * pi - axis.back();
  return {axis.size() - 1, 0, gap > 0.0 ? (a - axis.back()) / gap : 0.0};
}

double level_of(const BeamTable& table, double bearing, double elevation) noexcept {
  const Between b = between_on_circle(table.bearings, bearing),
                e = between(table.elevations, elevation);
  const auto level = [&](std::size_t i, std::size_t j) {
    return table.level_db[i * table.elevations.size() + j];
  };
  return std::lerp(std::lerp(level(b.low, e.low), level(b.low, e.high), e.share),
                   std::lerp(level(b.high, e.low), level(b.high, e.high), e.share), b.share);
}

void require(bool good, const char* where, double got, const char* expected) {
  if (good) return;
  std::ostringstream text;
  text << got;
  throw InputError({.where = where, .got = text.str(), .expected = expected});
}

}  // namespace

BeamPattern::BeamPattern(const Transmitter& transmitter, double wavelength, double sound_speed,
                         double heading, double reference)
    : taper_(transmitter.taper),
      wavelength_(wavelength),
      sound_speed_(sound_speed),
      table_(transmitter.table) {
  require(wavelength > 0.0 && std::isfinite(wavelength), "wavelength", wavelength, "above 0 m");
  require(std::abs(transmitter.elevation) <= 0.5 * pi, "elevation", transmitter.elevation,
          "between -pi/2 and pi/2 rad");
  const double frame = transmitter.frame == BearingFrame::heading ? heading : 0.0;
  turned_ = frame + transmitter.bearing;
  if (!transmitter.projectors.empty()) {
    const Vec3 axis = direction(turned_, transmitter.elevation);
    const double s = std::sin(frame), c = std::cos(frame);
    double sum = 0.0;
    for (const Projector& p : transmitter.projectors) sum += std::abs(p.amplitude);
    for (const Projector& p : transmitter.projectors) {
      const Vec3 place = Vec3(c * p.offset.x() + s * p.offset.y(),
                              c * p.offset.y() - s * p.offset.x(), p.offset.z()) /
                         wavelength;
      const double cycles = p.delay * sound_speed / wavelength + axis.dot(place);
      elements_.push_back(
          {place, std::polar(1.0, p.phase - 2.0 * pi * cycles) * (p.amplitude / sum)});
    }
    return;
  }
  if (table_ || taper_ == Taper::omnidirectional) return;
  require(transmitter.beamwidth > 0.0 && transmitter.beamwidth < pi, "beamwidth",
          transmitter.beamwidth, "between 0 and pi rad");
  // u where the pattern is 1/√2: half of the full −3 dB width.
  const double half_power = taper_ == Taper::hann ? 0.7202912901 : 0.4429464707;
  length_over_wavelength_ = half_power / std::sin(0.5 * transmitter.beamwidth);
  if (reference > 0.0) length_over_wavelength_ *= reference / wavelength;
  sin_axis_ = std::sin(transmitter.elevation);
}

double BeamPattern::line(double elevation) const noexcept {
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

double BeamPattern::operator()(double elevation) const noexcept {
  if (all_round()) return line(elevation);
  constexpr int bearings = 360;
  double power = 0.0;
  for (int i = 0; i < bearings; ++i)
    power += std::norm(towards(2.0 * pi * i / bearings, elevation)) / bearings;
  return std::sqrt(power);
}

std::complex<double> BeamPattern::towards(double bearing, double elevation) const noexcept {
  if (table_) return amplitude_from_db(level_of(*table_, bearing - turned_, elevation));
  if (elements_.empty()) return line(elevation);
  const Vec3 d = direction(bearing, elevation);
  std::complex<double> sum = 0.0;  // what lies further on in that direction is heard earlier
  for (const Element& e : elements_) sum += e.weight * std::polar(1.0, 2.0 * pi * d.dot(e.place));
  return sum;
}

bool BeamPattern::add_to(ExactKey& key) const {
  // Every member by name: one more does not compile until it is here.
  const auto& [taper, wavelength, sound_speed, length, axis, turned, elements, table] = *this;
  key.add(static_cast<int>(taper)).add_all(wavelength, sound_speed, length, axis, turned);
  key.add(elements.size());
  for (const auto& [place, weight] : elements) key.add_all(place, weight.real(), weight.imag());
  key.add(table ? 1 : 0);
  if (!table) return true;
  const auto& [bearings, elevations, level_db] = *table;
  key.add_all(bearings, elevations, level_db);
  return true;
}

double BeamPattern::longest_delay() const noexcept {
  if (table_) return 0.0;
  if (elements_.empty()) return 2.0 * length_over_wavelength_ * wavelength_ / sound_speed_;
  double furthest = 0.0;
  for (const Element& e : elements_) furthest = std::max(furthest, e.place.norm());
  return 4.0 * furthest * wavelength_ / sound_speed_;
}

}  // namespace asdic
