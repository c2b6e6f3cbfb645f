#include <cstdio>

#include "raytrace/ocean/strongest_reflection.h"
#include "raytrace/warnings/warnings.h"

namespace asdic::detail::checks {
namespace {

/// \param where  "environment.bottom"   \param range, depth  where the water is taken [m]
std::string of_material(const char* where, const BoundaryMaterial& material,
                        const Environment& ocean, double range, double depth) {
  if (!std::holds_alternative<ElasticHalfSpace>(material)) return "";  // fluids only lose
  const WaterAtBoundary water{.speed = sound_speed(ocean, range, depth).c,
                              .density = ocean.water_density.at(depth)};
  const StrongestReflection most = strongest_reflection(material, water);
  if (most.magnitude <= most_reflection) return "";
  char text[200];
  std::snprintf(text, sizeof text,
                "%s: its solid at range %g m reflects more than comes in, %.4g times at %.1f "
                "degrees: its shear waves lose too much beside its compressional ones",
                where, range, most.magnitude, degrees(most.grazing));
  return text;
}

std::string of_boundary(const char* where, const Boundary& boundary, const Environment& ocean) {
  if (!boundary.shape || boundary.shape->materials().empty())
    return of_material(where, boundary.material, ocean, 0.0, boundary.depth_at(0.0));
  const BoundaryShape& shape = *boundary.shape;
  for (std::size_t i = 0; i < shape.materials().size(); ++i) {
    std::string text =
        of_material(where, shape.materials()[i], ocean, shape.ranges()[i], shape.depths()[i]);
    if (!text.empty()) return text;
  }
  return "";
}

}  // namespace

std::string gaining_boundary(const Environment& ocean) {
  std::string text = of_boundary("environment.surface", ocean.surface, ocean);
  return text.empty() ? of_boundary("environment.bottom", ocean.bottom, ocean) : text;
}

}  // namespace asdic::detail::checks
