#pragma once
#include <optional>
#include <string>
#include <vector>

#include "io/climatology/casts.h"
#include "io/climatology/tiles.h"

namespace asdic::detail::climatology {

/// One water column: temperature in situ and practical salinity, or the speed of sound itself.
struct WaterColumn {
  std::vector<double> depth{};                    ///< [levels] [m]
  std::vector<double> temperature{}, salinity{};  ///< [°C], [psu]
  std::vector<double> speed{};                    ///< [m/s], in place of them

  bool operator==(const WaterColumn&) const = default;
};

/// Speed of sound at depths [m], in the way of scenarios: PCHIP between measured levels, the last
/// one's water going on below; a measured speed grows there by 0.017 (m/s)/m, as the pressure does.
[[nodiscard]] std::vector<double> speeds_of(const WaterColumn& column,
                                            const std::vector<double>& depths, double latitude);

/// The water of files: on grids, or of the cast that is nearest to a place.
class Water {
 public:
  /// \param latitude, longitude  where casts are wanted
  /// \throws InputError naming file and variable for what is missing or in another unit
  Water(const OceanSources& sources, const OceanTime& when, double latitude, double longitude);

  /// Of the nearest grid point, down to the first level that is missing; empty on land.
  /// Conservative and potential temperatures become those in situ.
  [[nodiscard]] WaterColumn at(double latitude, double longitude) const;
  /// \throws InputError that names file, variable and place
  [[nodiscard]] WaterColumn require(double latitude, double longitude) const;
  /// Whether two places have one grid point's water.
  [[nodiscard]] bool same(double latitude, double longitude, double other_latitude,
                          double other_longitude) const;
  [[nodiscard]] bool is_everywhere_the_same() const { return cast_.has_value(); }
  [[nodiscard]] bool has_speeds() const { return speed_.has_value() || is_cast_speed_; }
  /// Measured levels [m], all that there are.
  [[nodiscard]] const std::vector<double>& levels() const;

  /// Files, variables and times, of the place.
  [[nodiscard]] std::vector<std::string> origins() const;
  struct Source {
    std::string quantity, time;
    std::vector<DataFile> files;
  };
  [[nodiscard]] std::vector<Source> used(double latitude, double longitude) const;
  /// What the user should know, of the place.
  [[nodiscard]] std::vector<std::string> notes(double latitude, double longitude) const;

  /// The grids, for cropping; none of a cast.
  [[nodiscard]] const Tiles* temperature() const { return temperature_ ? &*temperature_ : nullptr; }
  [[nodiscard]] const Tiles* salinity() const { return salinity_ ? &*salinity_ : nullptr; }
  [[nodiscard]] const Tiles* speed() const { return speed_ ? &*speed_ : nullptr; }
  /// A column of values at levels as the files have them: T and S become those in situ.
  [[nodiscard]] WaterColumn in_situ(WaterColumn column, double latitude) const;

 private:
  void read_cast(const std::vector<DataFile>& files, const OceanTime& when, double latitude,
                 double longitude);

  enum class Scale { in_situ, potential, conservative };
  std::optional<Tiles> temperature_, salinity_, speed_;
  std::optional<Cast> cast_;
  std::vector<DataFile> cast_files_;
  bool is_cast_speed_ = false, absolute_salinity_ = false;
  Scale scale_ = Scale::in_situ;
  std::vector<std::string> notes_;
  bool dated_ = false;
};

}  // namespace asdic::detail::climatology
