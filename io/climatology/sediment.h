#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/climatology/tiles.h"

namespace asdic::detail {

/// A kind of sea floor as a scenario says it.
struct Sediment {
  int number = 0;    ///< of the table of docs/guide/real-ocean.md, from 1
  std::string name;  ///< "fine sand"
  /// Mean grain size [φ]; none: a fluid of the values below.
  std::optional<double> grain_size{};
  double speed = 0.0, density = 0.0;  ///< [m/s], [kg/m³]
  double attenuation = 0.0;           ///< [dB per wavelength]
  bool operator==(const Sediment&) const = default;

  /// kind = … and its keys, a line each.
  [[nodiscard]] std::string toml() const;
};

/// Names and mean grain sizes of the APL-UW High-Frequency Ocean Environmental Acoustic Models
/// Handbook, APL-UW TR 9407 (1994), ch. IV, table 2; rock, gravel and abyssal clay as fluids.
[[nodiscard]] const std::vector<Sediment>& sediments();

/// Where no map says it, by the depth of the water: fine sand on the shelf (to 200 m), silt on the
/// slope (to 2500 m), clay in the abyss. Of continental terraces and abyssal plains that is the
/// most common; Hamilton, JASA 68, 1313 (1980). \return one of sediments()
[[nodiscard]] const Sediment& sediment_at_depth(double depth);
/// "shelf", "slope" or "abyss"
[[nodiscard]] std::string_view province_at_depth(double depth);

/// A map of grain sizes [φ] or of classes: by flag_meanings where it has them, whose words are
/// names of sediments() or Folk's, else by the numbers of sediments().
class SedimentMap {
 public:
  /// \throws InputError for words that are no known sediment
  SedimentMap(const std::vector<DataFile>& files, const OceanTime& when);

  /// Of the nearest grid point; nothing where the map has none there. \throws InputError for a
  /// number that is no class
  [[nodiscard]] std::optional<Sediment> at(double latitude, double longitude) const;
  /// Of a value of the map. \param where  for messages
  [[nodiscard]] Sediment of_value(double value, const std::string& where) const;

  [[nodiscard]] const climatology::Tiles& tiles() const { return tiles_; }

 private:
  climatology::Tiles tiles_;
  bool is_grain_size_ = false;
  std::vector<std::pair<double, Sediment>> classes_;  // by number
};

}  // namespace asdic::detail
