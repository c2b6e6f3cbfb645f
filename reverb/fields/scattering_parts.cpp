#include "reverb/fields/scattering_parts.h"

#include <algorithm>
#include <cmath>
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
                                             double wind_speed, double sound_speed) {
  std::vector<ScatteringPart> found;
  if (!settings.enabled) return found;
  if (settings.surface_scatters) {
    AnySurfaceScattering law = settings.surface;
    set_sea(law, wind_speed, sound_speed);
    found.push_back({BoundaryKind::surface, law_of(law), settings.surface_field,
                     Draw::surface_weight, std::uint64_t{0}});
  }
  if (settings.bottom)
    found.push_back({BoundaryKind::bottom, law_of(*settings.bottom), settings.bottom_field,
                     Draw::bottom_weight, std::uint64_t{1}});
  std::uint64_t id = 2;
  for (const VolumeLayer& layer : settings.volume) {
    const double height = layer.bottom - layer.top;
    const int sheets =
        layer.sheets.value_or(std::max(1, static_cast<int>(std::ceil(height / 50.0))));
    const double thickness = height / sheets;
    for (int i = 0; i < sheets; ++i)
      found.push_back({GroundLevel(layer.top + (i + 0.5) * thickness),
                       VolumeSheet{layer.strength_db, thickness}, layer.field, Draw::volume_weight,
                       id++, thickness});
  }
  return found;
}

void move_aside(ScatteringPart& part, double depth) noexcept {
  const double aside = 0.1 * part.thickness;
  if (part.level.boundary || std::abs(part.level.depth - depth) >= 0.5 * aside) return;
  part.level = GroundLevel(depth + (part.level.depth < depth ? -aside : aside));
}

}  // namespace asdic::detail
