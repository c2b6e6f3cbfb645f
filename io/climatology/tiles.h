#pragma once
#include <optional>
#include <string>
#include <vector>

#include "core/error.h"
#include "io/climatology/sources.h"
#include "io/climatology/times.h"

namespace asdic::detail::climatology {

/// What one quantity's files may say it in, and how that becomes our unit: value·scale + offset.
struct UnitRule {
  std::vector<std::string> units;  ///< in lower case
  double scale = 1.0, offset = 0.0;
};

/// A quantity as its makers write it.
struct GriddedQuantity {
  std::string name;                ///< "bathymetry", for messages
  std::vector<std::string> names;  ///< standard_names and names of variables, the best first
  std::vector<UnitRule> rules;
  std::string unit;  ///< ours: "m"
};

[[nodiscard]] const GriddedQuantity& temperature_quantity();
[[nodiscard]] const GriddedQuantity& salinity_quantity();
[[nodiscard]] const GriddedQuantity& sound_speed_quantity();
[[nodiscard]] const GriddedQuantity& bathymetry_quantity();
[[nodiscard]] const GriddedQuantity& wind_speed_quantity();
[[nodiscard]] const GriddedQuantity& eastward_wind_quantity();
[[nodiscard]] const GriddedQuantity& northward_wind_quantity();
[[nodiscard]] const GriddedQuantity& sediment_quantity();

/// A variable of a gridded file. \param projected  whether x and y will do in place of longitude
/// and latitude \throws InputError for a missing file or variable
[[nodiscard]] DataGrid require_grid(const DataFile& file, const GriddedQuantity& quantity,
                                    bool projected = false);
/// How its units become ours. \param remarks  grows where it has none \throws InputError for others
[[nodiscard]] UnitRule rule_of(const DataGrid& grid, const GriddedQuantity& quantity,
                               std::vector<std::string>& remarks);

/// Whether the first of these files is gridded and has such a variable; so also for a missing file,
/// of which require() complains.
[[nodiscard]] bool has_quantity(const std::vector<DataFile>& files,
                                const GriddedQuantity& quantity);

/// One quantity on grids of longitude and latitude: files joined in space (tiles), in time, and in
/// depth. Where several hold a place, the one whose time fits best is taken, and of those the
/// finest.
class Tiles {
 public:
  /// \throws InputError naming file and variable for what is missing or in another unit
  Tiles(const std::vector<DataFile>& files, const GriddedQuantity& quantity, const OceanTime& when);

  /// The grid points about a place may lie in two tiles; a missing one is left out and the weights
  /// of the others scaled up. \return NaN where nothing is known
  [[nodiscard]] double bilinear(double latitude, double longitude) const;
  /// The same of each time step, with its weight: for what is not linear in the values.
  struct Weighted {
    double value, weight;
  };
  [[nodiscard]] std::vector<Weighted> bilinear_steps(double latitude, double longitude) const;
  [[nodiscard]] double nearest(double latitude, double longitude) const;

  /// Values of the nearest grid point on levels, down to the first that is missing.
  struct Column {
    std::vector<double> depths{}, values{};  ///< [levels]
    std::string continued{};                 ///< a note, if deeper levels are another file's
    std::size_t tile = 0;                    ///< with the point: columns of the same are the same
    DataGrid::Point point{};
  };
  [[nodiscard]] std::optional<Column> column(double latitude, double longitude) const;
  /// The tile and point whose column() that is, without reading it.
  struct Where {
    std::size_t tile;
    DataGrid::Point point;
    bool operator==(const Where&) const = default;
  };
  [[nodiscard]] std::optional<Where> where(double latitude, double longitude) const;

  /// "file.nc: variable" of the tile that holds a place, else of the first.
  [[nodiscard]] std::string name_at(double latitude, double longitude) const;
  /// The same without its folder.
  [[nodiscard]] std::string short_name_at(double latitude, double longitude) const;
  [[nodiscard]] bool holds(double latitude, double longitude) const;
  /// \throws InputError that says which tiles there are, if none holds the place
  void check_holds(double latitude, double longitude) const;

  /// Distance between grid lines that a track meets there [m].
  [[nodiscard]] double spacing(double latitude, double longitude, double bearing_deg) const;
  /// In steps of the grid's axes; nothing outside.
  struct GridPlace {
    std::size_t tile;
    double east, north;
  };
  [[nodiscard]] std::optional<GridPlace> grid_place(double latitude, double longitude) const;

  /// What had to be assumed of the files: "FILE: VARIABLE has no units: taken as m".
  [[nodiscard]] const std::vector<std::string>& remarks() const { return remarks_; }
  /// What was averaged or interpolated in time there.
  [[nodiscard]] const TimeChoice& time_at(double latitude, double longitude) const;
  [[nodiscard]] const std::vector<DataFile>& files() const { return files_; }  ///< with variables
  [[nodiscard]] const DataGrid& first() const { return tiles_.front().grids.front(); }
  [[nodiscard]] const std::vector<double>& levels() const;  ///< of the first tile

  /// All that lies in a box of degrees (and one point around it), of its finest tiles, joined, in
  /// the grid's own resolution; the uppermost level of a volume. \param values  else the axes alone
  [[nodiscard]] DataGrid::Block crop(double south, double north, double west, double east,
                                     bool values = true) const;

 private:
  struct Tile {
    std::vector<DataGrid> grids{};  ///< on the same axes
    TimeChoice time{};
    std::optional<InputFault> fault{};         ///< why it has no such time
    double step_east = 0.0, step_north = 0.0;  ///< [°]
    UnitRule rule{};
  };
  [[nodiscard]] bool holds(const Tile& tile, double latitude, double longitude) const;
  [[nodiscard]] const Tile* tile_at(double latitude, double longitude) const;
  [[nodiscard]] std::vector<double> read_column(const Tile& tile, DataGrid::Point point) const;
  [[nodiscard]] DataGrid::Block read_block(const Tile& tile, DataGrid::Indices east,
                                           DataGrid::Indices north, DataGrid::Indices levels) const;

  GriddedQuantity quantity_;
  std::vector<DataFile> files_;
  std::vector<Tile> tiles_;  // the best first
  std::vector<std::string> remarks_;
};

}  // namespace asdic::detail::climatology
