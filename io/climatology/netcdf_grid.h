#pragma once
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace asdic::detail {

/// One variable of a gridded netCDF file on longitude × latitude (× depth) (× time), by the COARDS
/// and CF conventions: axes are known by their units, standard_name, axis or positive attributes.
///
/// Values come unpacked (scale_factor, add_offset) and NaN where missing (missing_value,
/// _FillValue, valid_range). Longitudes may run 0..360, −180..180 or anything else; the grid wraps
/// when it goes round. The netCDF library is not thread-safe: one thread at a time.
class NetcdfGrid {
 public:
  enum class Axis { longitude, latitude, depth, time };

  /// Opens a variable by standard_name, else by name (letter case does not matter).
  /// \param names  in order of preference   \return nothing if the file has none of them
  /// \throws InputError if the file is not readable netCDF, or the variable has no longitude and
  /// latitude, or a dimension longer than one that is no known axis
  [[nodiscard]] static std::optional<NetcdfGrid> find(const std::filesystem::path& path,
                                                      const std::vector<std::string>& names);
  NetcdfGrid(NetcdfGrid&&) noexcept;
  NetcdfGrid& operator=(NetcdfGrid&&) noexcept;
  ~NetcdfGrid();

  [[nodiscard]] const std::string& variable() const noexcept;
  [[nodiscard]] const std::string& units() const noexcept;
  [[nodiscard]] bool has(Axis axis) const noexcept;
  /// [levels] of the depth axis, positive down, in increasing order [m]; empty without one
  [[nodiscard]] const std::vector<double>& depths() const noexcept;
  [[nodiscard]] std::size_t times() const noexcept;  ///< 1 without a time axis

  /// The value of the nearest grid point (never a mixture of land and sea).
  /// \param longitude, latitude  [° east], [° north]   \param level  of depths()   \return NaN if
  /// missing there, or if the grid does not reach there
  [[nodiscard]] double nearest(double longitude, double latitude, std::size_t level = 0,
                               std::size_t time = 0) const;
  /// Between the four grid points around; missing ones are left out and the weights of the others
  /// scaled up. \return NaN if all four are missing
  [[nodiscard]] double bilinear(double longitude, double latitude, std::size_t level = 0,
                                std::size_t time = 0) const;

 private:
  struct Impl;
  explicit NetcdfGrid(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace asdic::detail
