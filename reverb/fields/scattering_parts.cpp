#include "reverb/fields/scattering_parts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <variant>

namespace asdic::detail {
namespace {

/// The law of a boundary out of the settings' shorter lists.
template <class... Model>
ScatteringSheet::Law law_of(const std::variant<Model...>& law) {
  return std::visit([](const auto& model) { return ScatteringSheet::Law(model); }, law);
}

}  // namespace

std::vector<double> sheets_of(const VolumeLayer& layer, const LayerEnds& ends) {
  constexpr double thickest = 50.0, share = 0.115;
  constexpr std::size_t most = 200;
  const double height = layer.bottom - layer.top;
  if (layer.sheets || ends.depths.empty()) {
    const int count =
        layer.sheets.value_or(std::max(1, static_cast<int>(std::ceil(height / thickest))));
    return std::vector<double>(static_cast<std::size_t>(count), height / count);
  }
  const bool upward = std::all_of(ends.depths.begin(), ends.depths.end(),
                                  [&](double depth) { return depth >= layer.bottom; });
  const double edge = upward ? layer.bottom : layer.top;  // where the first sheet begins
  const auto nearest = [&](double from, double to) {      // distance of an end from that piece
    const double low = upward ? edge - to : edge + from, high = upward ? edge - from : edge + to;
    double distance = std::numeric_limits<double>::infinity();
    for (const double depth : ends.depths)
      distance = std::min(distance, std::max({0.0, low - depth, depth - high}));
    return distance;
  };
  for (double finest = ends.finest;; finest *= 2.0) {
    std::vector<double> found;
    double cut = 0.0;
    while (cut < height && found.size() <= most) {
      const double allowed = found.empty() ? 0.5 * share : share;
      double next = thickest;
      while (next > finest && next > allowed * nearest(cut, cut + next)) next *= 0.9;
      found.push_back(std::max(next, finest));
      cut += found.back();
    }
    if (found.size() > most) continue;
    for (double& thickness : found) thickness *= height / cut;
    if (upward) std::reverse(found.begin(), found.end());
    return found;
  }
}

std::vector<ScatteringPart> scattering_parts(const ReverberationSettings& settings,
                                             double wind_speed, double sound_speed,
                                             std::span<const int> winds, const LayerEnds& ends) {
  std::vector<ScatteringPart> found;
  if (!settings.enabled) return found;
  if (settings.surface_scatters) {
    AnySurfaceScattering law = settings.surface;
    set_sea(law, wind_speed, sound_speed);
    ScatteringSheet::Laws laws = law_of(law);
    for (const int kind : winds) {
      set_sea(law, wind_of_kind(kind), sound_speed);
      laws.of_kind.emplace(kind, law_of(law));
    }
    found.push_back({BoundaryKind::surface, std::move(laws), settings.surface_field,
                     Draw::surface_weight, std::uint64_t{0}});
  }
  if (settings.bottom) {
    ScatteringSheet::Laws laws = law_of(*settings.bottom);
    for (const SeabedScattering& one : settings.seabed)
      laws.of_kind.emplace(one.number, law_of(one.law));
    found.push_back({BoundaryKind::bottom, std::move(laws), settings.bottom_field,
                     Draw::bottom_weight, std::uint64_t{1}});
  }
  std::uint64_t id = 2;
  for (const VolumeLayer& layer : settings.volume) {
    double top = layer.top;
    for (const double thickness : sheets_of(layer, ends)) {
      const ScatteringPart sheet{.level = GroundLevel(top + 0.5 * thickness),
                                 .law = VolumeSheet{layer.strength_db, thickness},
                                 .field = layer.field,
                                 .weights = Draw::volume_weight,
                                 .id = id++,
                                 .thickness = thickness};
      found.push_back(sheet);
      top += thickness;
    }
  }
  return found;
}

void move_aside(ScatteringPart& part, double depth) noexcept {
  const double aside = 0.1 * part.thickness;
  if (part.level.boundary || std::abs(part.level.depth - depth) >= 0.5 * aside) return;
  part.level = GroundLevel(depth + (part.level.depth < depth ? -aside : aside));
}

}  // namespace asdic::detail
