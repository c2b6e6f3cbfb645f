#pragma once
#include <netcdf.h>

#include <filesystem>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace asdic::detail::support {

/// Writes a netCDF file as a maker of data would: axes, then variables on them.
class NetcdfWriter {
 public:
  using Texts = std::map<std::string, std::string>;
  using Numbers = std::map<std::string, double>;

  explicit NetcdfWriter(const std::filesystem::path& path, int format = NC_CLOBBER) {
    check(nc_create(path.c_str(), format, &file_));
  }
  NetcdfWriter(const NetcdfWriter&) = delete;
  NetcdfWriter& operator=(const NetcdfWriter&) = delete;
  ~NetcdfWriter() { nc_close(file_); }

  int id() const { return file_; }
  void dimension(const std::string& name, std::size_t size) {
    nc_redef(file_);
    check(nc_def_dim(file_, name.c_str(), size, &dimensions_[name]));
  }
  /// An axis: a dimension and the variable of its name.
  void axis(const std::string& name, const std::vector<double>& values, const Texts& texts = {},
            nc_type type = NC_DOUBLE) {
    dimension(name, values.size());
    variable(name, type, {name}, values, texts);
  }
  /// \param values  as they are stored; {}: none is written
  /// \param numbers  attributes of the variable's own type, but for the factors of packing
  int variable(const std::string& name, nc_type type, const std::vector<std::string>& dimensions,
               const std::vector<double>& values, const Texts& texts = {},
               const Numbers& numbers = {}) {
    std::vector<int> ids;
    for (const std::string& dimension : dimensions) ids.push_back(dimensions_.at(dimension));
    int id = 0;
    nc_redef(file_);
    check(nc_def_var(file_, name.c_str(), type, static_cast<int>(ids.size()), ids.data(), &id));
    for (const auto& [key, text] : texts)
      check(nc_put_att_text(file_, id, key.c_str(), text.size(), text.c_str()));
    for (const auto& [key, number] : numbers) {
      const bool packing = key == "scale_factor" || key == "add_offset";
      check(nc_put_att_double(file_, id, key.c_str(), packing ? NC_DOUBLE : type, 1, &number));
    }
    check(nc_enddef(file_));
    if (!values.empty()) check(nc_put_var_double(file_, id, values.data()));
    return id;
  }
  void text(const std::string& key, const std::string& value) {
    nc_redef(file_);
    check(nc_put_att_text(file_, NC_GLOBAL, key.c_str(), value.size(), value.c_str()));
    check(nc_enddef(file_));
  }

 private:
  static void check(int status) {
    if (status != NC_NOERR) throw std::runtime_error(nc_strerror(status));
  }
  int file_ = -1;
  std::map<std::string, int> dimensions_;
};

}  // namespace asdic::detail::support
