#include "sonar/scenario/transmitter.h"

#include <cmath>

#include "core/error.h"
#include "core/propagation_memory.h"
#include "core/quantities.h"
#include "core/text.h"
#include "core/units.h"

namespace asdic::detail {
namespace {

void require(bool good, const char* where, double got, const char* expected) {
  if (!good) throw InputError({.where = where, .got = to_text(got), .expected = expected});
}

AnyBeamPattern pattern_of(const AnyBeam& beam, const BeamMount& mount) {
  require(mount.wavelength > 0.0 && std::isfinite(mount.wavelength), "wavelength", mount.wavelength,
          "above 0 m");
  require(std::abs(mount.elevation) <= 0.5 * pi, "elevation", mount.elevation,
          "between -pi/2 and pi/2 rad");
  return std::visit([&](const auto& one) -> AnyBeamPattern { return one.pattern(mount); }, beam);
}

}  // namespace

void add_to(ExactKey& key, const BeamMount& mount) {
  // Every member by name: one more does not compile until it is here.
  const auto& [wavelength, sound_speed, heading, elevation, reference] = mount;
  key.add_all(wavelength, sound_speed, heading, elevation, reference);
}

void Transmitter::describe(Fields& field) {
  field.name(name, "by which others name it");
  field.reference("platform", platform, "platform", "that carries it");
  field("offset", offset, quantity::coordinate, "from the platform");
  field("first_ping_time", first_ping_time, {.noun = "time", .unit = "s", .low = 0.0, .high = 1e9},
        "of its first ping");
  field(by_default("interval", "that of [pings]"), interval, quantity::interval,
        "from ping to ping");
  field(by_default("elevations", "those of [pings]"), elevations, quantity::elevation,
        "of each ping in turn, repeated as needed");
  if (!elevations.empty()) field.excludes("elevations_deg", {"elevation_deg"});
  field(live(required("source_level_db")), source_level_db, quantity::level_re("1 µPa at 1 m"),
        "rms, of the pulse's peak before its window");
  const bool of_pings = !field.reads() && field.known("pings.elevations") > 0.0;
  if (field.reads() || (steers(beam) && elevations.empty() && !of_pings))
    field(live("elevation"), elevation, quantity::elevation, "of the beam's axis, positive up");
  field.one_of("kind", beam, "what it sends where");
  field(live("pulse"), pulse, "that it sends in place of the scenario's");
}

BeamPattern::BeamPattern(const Transmitter& transmitter, double wavelength, double sound_speed,
                         double heading, double reference)
    : beam_(transmitter.beam),
      mount_{.wavelength = wavelength,
             .sound_speed = sound_speed,
             .heading = heading,
             .elevation = transmitter.elevation,
             .reference = reference},
      pattern_(pattern_of(beam_, mount_)) {}

double BeamPattern::operator()(double elevation) const noexcept {
  if (azimuthally_symmetric()) return towards(0.0, elevation).real();
  constexpr int bearings = 360;
  double power = 0.0;
  for (int i = 0; i < bearings; ++i)
    power += std::norm(towards(2.0 * pi * i / bearings, elevation)) / bearings;
  return std::sqrt(power);
}

std::complex<double> BeamPattern::towards(double bearing, double elevation) const noexcept {
  return std::visit([&](const auto& one) { return one.towards(bearing, elevation); }, pattern_);
}

bool BeamPattern::azimuthally_symmetric() const noexcept {
  return std::visit([](const auto& one) { return one.azimuthally_symmetric; }, pattern_);
}

bool BeamPattern::add_to(ExactKey& key) const {
  key.add_all(beam_, mount_);
  return true;
}

double BeamPattern::longest_delay() const noexcept {
  return std::visit([](const auto& one) { return one.longest_delay(); }, pattern_);
}

double BeamPattern::line_length() const noexcept {
  const auto* const line = std::get_if<LinePattern>(&pattern_);
  return line != nullptr ? line->length() : 0.0;
}

}  // namespace asdic::detail
