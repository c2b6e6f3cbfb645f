#include "sonar/scenario/beams/projector_beam.h"

#include <algorithm>
#include <cmath>

#include "core/geometry.h"
#include "core/quantities.h"
#include "core/text.h"

namespace asdic::detail {

void Projector::describe(Fields& field) {
  field(required("offset"), offset, quantity::coordinate, "from the transmitter's place");
  field("amplitude", amplitude, {.noun = "amplitude", .low = 0.0, .high = 1e6},
        "beside those of the others");
  field("phase", phase, AngleQuantity{"phase", -360.0, 360.0}, "of what it sends");
  field("delay", delay, {.noun = "delay", .unit = "s", .low = -10.0, .high = 10.0},
        "of what it sends");
}

void ProjectorBeam::describe(Fields& field) {
  field.excludes("kind = \"projectors\"", {"taper", "beamwidth_deg"});
  turned.describe(field);
  field.excludes("kind = \"projectors\"", {"table"});
  field("projector", projectors, "those that send the pulse together");
  if (!field.checks()) return;
  if (projectors.empty())
    field.fault("projector", "at least one [[transmitter.projector]]", "none");
  const bool sends = std::any_of(projectors.begin(), projectors.end(),
                                 [](const Projector& one) { return one.amplitude > 0.0; });
  if (!sends) field.fault("projector", "an amplitude above 0", "none");
}

std::string ProjectorBeam::text(double /*elevation*/) const {
  return count_of(projectors.size(), "projector") + ", steered to " + turned.text();
}

ProjectorPattern::ProjectorPattern(const std::vector<Projector>& projectors,
                                   const BeamBearing& turned, const BeamMount& mount)
    : wavelength_(mount.wavelength), sound_speed_(mount.sound_speed) {
  const double frame = turned.north_of_frame(mount.heading);
  const Vec3 axis = direction(frame + turned.bearing, mount.elevation);
  const double s = std::sin(frame), c = std::cos(frame);
  double sum = 0.0;
  for (const Projector& p : projectors) sum += std::abs(p.amplitude);
  for (const Projector& p : projectors) {
    const Vec3 place = Vec3(c * p.offset.x() + s * p.offset.y(),
                            c * p.offset.y() - s * p.offset.x(), p.offset.z()) /
                       mount.wavelength;
    const double cycles = p.delay * mount.sound_speed / mount.wavelength + axis.dot(place);
    elements_.push_back(
        {place, std::polar(1.0, p.phase - 2.0 * pi * cycles) * (p.amplitude / sum)});
  }
}

std::complex<double> ProjectorPattern::towards(double bearing, double elevation) const noexcept {
  const Vec3 d = direction(bearing, elevation);
  std::complex<double> sum = 0.0;  // what lies further on in that direction is received earlier
  for (const Element& e : elements_) sum += e.weight * std::polar(1.0, 2.0 * pi * d.dot(e.place));
  return sum;
}

double ProjectorPattern::longest_delay() const noexcept {
  double furthest = 0.0;
  for (const Element& e : elements_) furthest = std::max(furthest, e.place.norm());
  return 4.0 * furthest * wavelength_ / sound_speed_;
}

}  // namespace asdic::detail
