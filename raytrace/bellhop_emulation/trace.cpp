#include "raytrace/bellhop_emulation/trace.h"

#include <cmath>

namespace asdic::detail::bellhop_emulation {
namespace {
constexpr double faintest = 0.005;  // amplitude, the source pattern included
constexpr std::size_t most_points = 100'000;
}  // namespace

void trace(const LiteralOcean& ocean, double source_depth, double declination, double amplitude,
           CervenyBeams::Curvature curvature, LiteralRay& out) {
  out.declination = declination;
  out.points.clear();
  RayPlace place;
  const Vec2 direction(std::cos(declination), std::sin(declination));
  LiteralPoint y{.x = {0.0, source_depth}, .amplitude = amplitude};
  ocean.water.locate(y.x, direction, place.cell);
  const WaterPoint source = ocean.water.at(y.x, place.cell);
  y.c = source.c;
  y.gradient = source.gradient();
  y.t = direction / y.c;
  const auto settle = [&] {
    ocean.surface.locate(y.x.x(), y.t.x(), place.surface);
    ocean.bottom.locate(y.x.x(), y.t.x(), place.bottom);
  };
  settle();
  out.points.push_back(y);
  double above = ocean.surface.outside(y.x, place.surface);
  double below = ocean.bottom.outside(y.x, place.bottom);
  if (above >= 0.0 || below >= 0.0) return;

  while (out.points.size() < most_points) {
    Landing landing = Landing::water;
    y = step(ocean, y, place, landing);
    settle();
    out.points.push_back(y);
    if (landing != Landing::water) {
      const BoundaryKind kind =
          landing == Landing::surface ? BoundaryKind::surface : BoundaryKind::bottom;
      y = reflect(ocean, y, kind, place, curvature);
      settle();
      out.points.push_back(y);
    }
    const double now_above = ocean.surface.outside(y.x, place.surface);
    const double now_below = ocean.bottom.outside(y.x, place.bottom);
    if (std::abs(y.x.x()) >= ocean.box_range || std::abs(y.x.y()) >= ocean.box_depth) return;
    if (y.amplitude < faintest) return;
    if ((above > 0.0 && now_above > 0.0) || (below > 0.0 && now_below > 0.0)) return;
    above = now_above;
    below = now_below;
  }
}

}  // namespace asdic::detail::bellhop_emulation
