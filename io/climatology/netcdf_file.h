#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace asdic::detail {

/// A netCDF file, open for reading: for the child process that handles it (io/isolated/child.h).
class NetcdfFile {
 public:
  /// \throws InputError
  explicit NetcdfFile(const std::filesystem::path& path);
  NetcdfFile(const NetcdfFile&) = delete;
  NetcdfFile& operator=(const NetcdfFile&) = delete;
  ~NetcdfFile();

  [[nodiscard]] int id() const noexcept { return id_; }
  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }
  /// \throws InputError if a call of netCDF failed. \param about  a variable
  void check(int status, const std::string& about) const;
  /// A text attribute, as characters or as one string; "" without it.
  [[nodiscard]] std::string text(int variable, const char* key) const;
  /// A numeric attribute; {} without it.
  [[nodiscard]] std::vector<double> numbers(int variable, const char* key) const;

 private:
  std::filesystem::path path_;
  int id_ = -1;
};

/// Once before children open files: what is set up here they need not.
void prepare_netcdf();

/// An array of a file that is no grid: numbers, or characters.
struct NetcdfArray {
  std::string name{}, units{};
  std::vector<std::size_t> shape{};
  std::vector<double> numbers{};  ///< NaN where missing
  std::string characters{};
};

/// Those of these variables that a file has, read whole in a child process.
/// \throws InputError if it is no netCDF file, or for an array of more than 10⁸ values
[[nodiscard]] std::vector<NetcdfArray> read_netcdf_arrays(const std::filesystem::path& path,
                                                          const std::vector<std::string>& names);

/// Names of a file's variables that have two dimensions or more, but for bounds of axes; of all if
/// there are none. \throws InputError if it is no netCDF file
[[nodiscard]] std::vector<std::string> netcdf_variables(const std::filesystem::path& path);

}  // namespace asdic::detail
