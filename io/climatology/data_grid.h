#pragma once
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "io/climatology/calendar.h"
#include "io/climatology/grid_source.h"

namespace asdic::detail {

/// One variable of a gridded file on longitude × latitude, or on projected x × y, (× depth)
/// (× time), whatever the file is: netCDF (netcdf_source.h), a raster (raster_source.h), text
/// (ascii_grid.h).
///
/// The file is opened, not loaded: its axes are in memory, and of its values what was asked for.
/// They come unpacked (scale and offset) and NaN where missing. Longitudes may run 0..360,
/// −180..180 or anything else; the grid wraps when it goes round. One thread at a time.
class DataGrid {
 public:
  using Axis = GridAxis;

  /// The first and last of some indices along an axis, both included.
  struct Indices {
    std::size_t first, last;
    bool operator==(const Indices&) const = default;
  };

  /// A part of the grid at one time, on axes that all rise.
  struct Block {
    std::vector<double> eastings{}, northings{};  ///< [° east], [° north]; or x, y [m]
    std::vector<double> depths{};                 ///< [m], positive down; empty without such axis
    /// [levels × northings × eastings], the last fastest; one level without depths
    std::vector<double> values{};

    [[nodiscard]] double at(std::size_t i, std::size_t j, std::size_t level = 0) const {
      return values[(level * northings.size() + j) * eastings.size() + i];
    }
  };

  /// \return nothing if the source has no such variable   \throws InputError for axes that do not
  /// belong together
  [[nodiscard]] static std::optional<DataGrid> of(const std::filesystem::path& path,
                                                  std::unique_ptr<const GridSource> source);
  /// Of a netCDF file (netcdf_source.h): by standard_name, else by name.
  /// \return nothing if the file has none of these names   \throws InputError
  [[nodiscard]] static std::optional<DataGrid> find(const std::filesystem::path& path,
                                                    const std::vector<std::string>& names);
  DataGrid(DataGrid&&) noexcept;
  DataGrid& operator=(DataGrid&&) noexcept;
  ~DataGrid();

  [[nodiscard]] const std::filesystem::path& path() const noexcept;
  [[nodiscard]] const std::string& variable() const noexcept;
  [[nodiscard]] const std::string& units() const noexcept;
  [[nodiscard]] const std::string& standard_name() const noexcept;  ///< "" without one
  [[nodiscard]] const std::string& long_name() const noexcept;      ///< "" without one
  /// Of a variable of classes (CF's flag_values and flag_meanings): a word for each value.
  [[nodiscard]] const std::vector<double>& flag_values() const noexcept;
  [[nodiscard]] const std::string& flag_meanings() const noexcept;  ///< words between spaces
  [[nodiscard]] bool has(Axis axis) const noexcept;
  /// Of projected axes, where the file tells: the projection's name, and a text that is the same
  /// for the same projection; else "".
  [[nodiscard]] const std::string& projection_name() const noexcept;
  [[nodiscard]] const std::string& projection() const noexcept;
  /// A place of such axes [m] on the Earth; nothing where the file does not tell.
  [[nodiscard]] std::optional<GridSource::Place> on_earth(double x, double y) const;
  /// What a user should know of it.
  [[nodiscard]] const std::vector<std::string>& remarks() const noexcept;
  /// Whether the horizontal axes are longitude and latitude; else they are x and y.
  [[nodiscard]] bool geographic() const noexcept;
  /// The horizontal axes in the order of the file: [° east] without a jump, or x [m]
  [[nodiscard]] const std::vector<double>& eastings() const noexcept;
  [[nodiscard]] const std::vector<double>& northings() const noexcept;  ///< [° north], or y [m]
  /// Whether a geographic grid goes round the globe, to within one and a half of its steps.
  [[nodiscard]] bool wraps() const noexcept;
  /// [levels] of the depth axis, positive down, in increasing order [m]; empty without one
  [[nodiscard]] const std::vector<double>& depths() const noexcept;
  [[nodiscard]] std::size_t times() const noexcept;  ///< 1 without a time axis

  /// Times by the file's calendar; empty without a time axis, or if its units are not "… since …".
  [[nodiscard]] const std::vector<Moment>& moments() const noexcept;
  /// [2·times] begin and end of what each step stands for, if the file has them; else empty.
  [[nodiscard]] const std::vector<Moment>& spans() const noexcept;
  [[nodiscard]] Calendar calendar() const noexcept;
  /// Whether the file says that its times are those of every year (climatology, modulo).
  [[nodiscard]] bool every_year() const noexcept;

  /// A part of the grid: whatever the order of dimensions in the file and the direction of its axes
  /// there, axes rise and values are unpacked. Read in pieces, so it may be large.
  /// \param east, north  indices into eastings() and northings(). A grid that wraps may be read
  /// across its seam: `east.first` is then the greater, and eastings go on rising past it.
  /// \param levels  of depths(), which has none: {0, 0}   \param time  below times()
  /// \throws std::out_of_range
  [[nodiscard]] Block block(Indices east, Indices north, Indices levels = {},
                            std::size_t time = 0) const;

  /// The grid point that is nearest to a place, in the order of the file; nothing where the grid
  /// does not reach.
  struct Point {
    std::size_t i, j;
    bool operator==(const Point&) const = default;
  };
  [[nodiscard]] std::optional<Point> nearest_point(double longitude, double latitude) const;

  /// The value of the nearest grid point (never a mixture of land and sea).
  /// \param longitude, latitude  [° east], [° north]; of a projected grid x, y [m]   \param level
  /// of depths()   \return NaN if missing there, or if the grid does not reach there
  [[nodiscard]] double nearest(double longitude, double latitude, std::size_t level = 0,
                               std::size_t time = 0) const;
  /// Between the four grid points around; missing ones are left out and the weights of the others
  /// scaled up. \return NaN if all four are missing
  [[nodiscard]] double bilinear(double longitude, double latitude, std::size_t level = 0,
                                std::size_t time = 0) const;

 private:
  struct Impl;
  explicit DataGrid(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace asdic::detail
