#pragma once
#include <memory>
#include <optional>
#include <string>

#include "core/fields.h"
#include "io/scenario/ocean.h"
#include "io/text/toml_table.h"
#include "raytrace/area/area.h"

namespace asdic::detail {

inline constexpr std::string_view map_interpolation_words[] = {"bicubic", "faceted"};
constexpr std::span<const std::string_view> words(MapInterpolation) {
  return map_interpolation_words;
}

namespace scenario {

/// [environment.area], its files opened; the water and the sea floor that it has are not yet those
/// of an ocean.
class AreaReading {
 public:
  /// \param origin  of the map's [0, 0]; none: it is not known
  /// \throws InputError for keys and files that do not fit
  AreaReading(TomlTable table, const OceanReading& reading,
              const std::optional<OceanOrigin>& origin);

  [[nodiscard]] const ScalarMap& floor() const { return *floor_; }
  [[nodiscard]] const std::optional<WaterMap>& water() const { return water_; }
  /// Of the wind at a place [m/s]; none: there is no map of it.
  [[nodiscard]] std::optional<double> wind_speed(double x, double y) const;

  /// What the numbers of the sea floor stand for, and then the area. \param ocean  all that has no
  /// map
  [[nodiscard]] std::shared_ptr<const Area> build(const Environment& ocean,
                                                  const Transect& transect);

 private:
  TomlTable table_;
  OceanReading reading_;
  AreaSettings settings_;
  std::optional<ScalarMap> floor_;
  std::optional<WaterMap> water_;
  std::optional<ClassMap> seabed_;
  std::optional<ScalarMap> wind_;
};

/// How far a map reaches, for messages: "x from -20 to 20 m, y from -5 to 5 m", where the grid is
/// projected on its own axes; of a geographic grid in degrees and, about [0, 0], in metres.
[[nodiscard]] std::string extent_text(const ScalarMap& map, bool on_its_axes = false);
/// Whether nothing of a map of depths is below 0, as far as 256 of its places tell.
[[nodiscard]] bool seems_all_land(const ScalarMap& map);

/// [environment.area], for a walker that does not read. \param settings  none: there is no area
void describe_area(Fields& field, const AreaSettings* settings);

}  // namespace scenario
}  // namespace asdic::detail
