#include "reverb/fields/scattering_parts.h"

#include <algorithm>
#include <cmath>
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

std::vector<ScatteringPart> scattering_parts(const ReverberationSettings& settings,
                                             double wind_speed, double sound_speed,
                                             std::span<const int> winds) {
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
    const double height = layer.bottom - layer.top;
    const int sheets =
        layer.sheets.value_or(std::max(1, static_cast<int>(std::ceil(height / 50.0))));
    const double thickness = height / sheets;
    const ScatteringSheet::Law law = VolumeSheet{layer.strength_db, thickness};
    for (int i = 0; i < sheets; ++i) {
      const ScatteringPart sheet{.level = GroundLevel(layer.top + (i + 0.5) * thickness),
                                 .law = law,
                                 .field = layer.field,
                                 .weights = Draw::volume_weight,
                                 .id = id++,
                                 .thickness = thickness};
      found.push_back(sheet);
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
