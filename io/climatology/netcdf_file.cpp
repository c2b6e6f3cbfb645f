#include "io/climatology/netcdf_file.h"

#include <netcdf.h>

#include <cmath>
#include <limits>

#include "core/error.h"
#include "core/text.h"
#include "io/files/input_file.h"
#include "io/files/output_lock.h"
#include "io/hdf5/gate.h"
#include "io/hdf5/handles.h"
#include "io/isolated/child.h"
#include "io/isolated/pack.h"

namespace asdic::detail {
namespace {

/// What else a user may have named: it says how to make netCDF of it.
std::string advice_of(const std::filesystem::path& path) {
  if (refuses_locks(path))
    return "HDF5_USE_FILE_LOCKING=FALSE in the environment: the file system there has no locks";
  const std::string start = InputFile(path, "a netCDF file").read(4);
  using namespace std::string_literals;
  if (start == "II*\0"s || start == "MM\0*"s || start == "II+\0"s || start == "MM\0+"s)
    return "a netCDF file: \"gdal_translate -of netCDF\" makes one of a GeoTIFF";
  if (start == "GRIB") return "a netCDF file: \"grib_to_netcdf\" makes one of GRIB";
  if (start.starts_with("PK") || start.starts_with("\x1f\x8b"))
    return "a netCDF file: unpack the archive";
  return "a netCDF file";
}

}  // namespace

NetcdfFile::NetcdfFile(const std::filesystem::path& path) : path_(path) {
  hdf5::check_contents(path);  // of netCDF-4
  if (const int status = nc_open(path.c_str(), NC_NOWRITE, &id_); status != NC_NOERR) {
    id_ = -1;
    throw InputError(
        {.where = path.string(),
         .got = "a file that cannot be opened (" + std::string(nc_strerror(status)) + ")",
         .expected = advice_of(path)});
  }
}

NetcdfFile::~NetcdfFile() {
  if (id_ >= 0) nc_close(id_);
}

void NetcdfFile::check(int status, const std::string& about) const {
  if (status != NC_NOERR)
    throw InputError({.where = path_.string() + ": " + about,
                      .got = "a netCDF error (" + std::string(nc_strerror(status)) + ")",
                      .expected = "a readable variable"});
}

std::string NetcdfFile::text(int variable, const char* key) const {
  std::size_t size = 0;
  nc_type type = NC_NAT;
  if (nc_inq_att(id_, variable, key, &type, &size) != NC_NOERR) return "";
  if (type == NC_STRING && size == 1) {
    char* string = nullptr;
    if (nc_get_att_string(id_, variable, key, &string) != NC_NOERR || string == nullptr) return "";
    const std::string value = string;
    nc_free_string(1, &string);
    return value;
  }
  if (type != NC_CHAR) return "";
  std::string value(size, '\0');
  if (nc_get_att_text(id_, variable, key, value.data()) != NC_NOERR) return "";
  return value.substr(0, value.find('\0'));
}

std::vector<double> NetcdfFile::numbers(int variable, const char* key) const {
  std::size_t size = 0;
  nc_type type = NC_NAT;
  if (nc_inq_att(id_, variable, key, &type, &size) != NC_NOERR) return {};
  if (type == NC_CHAR || type == NC_STRING) return {};
  std::vector<double> values(size);
  if (nc_get_att_double(id_, variable, key, values.data()) != NC_NOERR) return {};
  return values;
}

void prepare_netcdf() {
  hdf5::prepare();
  nc_initialize();
}

template <class Visit>
void fields(NetcdfArray& array, Visit visit) {
  visit(array.name);
  visit(array.units);
  visit(array.shape);
  visit(array.numbers);
  visit(array.characters);
}

namespace {

NetcdfArray read_array(const NetcdfFile& file, int id, const std::string& name) {
  constexpr std::size_t most = 100'000'000;
  NetcdfArray array{.name = name, .units = file.text(id, "units")};
  int rank = 0;
  file.check(nc_inq_varndims(file.id(), id, &rank), name);
  std::vector<int> ids(static_cast<std::size_t>(rank));
  file.check(nc_inq_vardimid(file.id(), id, ids.data()), name);
  std::size_t size = 1;
  for (const int dimension : ids) {
    array.shape.push_back(0);
    file.check(nc_inq_dimlen(file.id(), dimension, &array.shape.back()), name);
    if (array.shape.back() > most || size * std::max<std::size_t>(array.shape.back(), 1) > most)
      throw InputError({.where = file.path().string() + ": " + name,
                        .got = "an array of more than 1e8 values",
                        .expected = "profiles"});
    size *= array.shape.back();
  }
  nc_type type = NC_NAT;
  file.check(nc_inq_vartype(file.id(), id, &type), name);
  if (type == NC_CHAR) {
    array.characters.resize(size);
    file.check(nc_get_var_text(file.id(), id, array.characters.data()), name);
    return array;
  }
  array.numbers.resize(size);
  file.check(nc_get_var_double(file.id(), id, array.numbers.data()), name);
  const auto fill = file.numbers(id, "_FillValue");
  const auto scale = file.numbers(id, "scale_factor"), offset = file.numbers(id, "add_offset");
  for (double& value : array.numbers) {
    const bool missing =
        !std::isfinite(value) || (!fill.empty() && value == fill[0]) || std::abs(value) > 1e30;
    value = missing ? std::numeric_limits<double>::quiet_NaN()
                    : value * (scale.empty() ? 1.0 : scale[0]) + (offset.empty() ? 0.0 : offset[0]);
  }
  return array;
}

}  // namespace

std::vector<NetcdfArray> read_netcdf_arrays(const std::filesystem::path& path,
                                            const std::vector<std::string>& names) {
  require_file(path, "a netCDF file");
  prepare_netcdf();
  isolated::Child child(path, "netCDF", [&] {
    auto file = std::make_shared<const NetcdfFile>(path);
    return [file, names](std::string_view) {
      std::vector<NetcdfArray> arrays;
      for (const std::string& name : names)
        if (int id = -1; nc_inq_varid(file->id(), name.c_str(), &id) == NC_NOERR)
          arrays.push_back(read_array(*file, id, name));
      isolated::Packed out;
      out.put(arrays);
      return out.bytes();
    };
  });
  return isolated::Unpacked(child.ask("")).get<std::vector<NetcdfArray>>();
}

std::vector<std::string> netcdf_variables(const std::filesystem::path& path) {
  require_file(path, "a netCDF file");
  prepare_netcdf();
  isolated::Child child(path, "netCDF", [&] {
    auto file = std::make_shared<const NetcdfFile>(path);
    return [file](std::string_view) {
      int count = 0;
      file->check(nc_inq_nvars(file->id(), &count), "variables");
      std::vector<std::string> all, maps;
      for (int id = 0; id < count; ++id) {
        char text[NC_MAX_NAME + 1] = {};
        int rank = 0;
        file->check(nc_inq_varname(file->id(), id, text), "variables");
        file->check(nc_inq_varndims(file->id(), id, &rank), text);
        const std::string name = text;
        all.push_back(name);
        if (rank > 1 && name.find("bnds") == std::string::npos &&
            name.find("bounds") == std::string::npos)
          maps.push_back(name);
      }
      isolated::Packed out;
      out.put(maps.empty() ? all : maps);
      return out.bytes();
    };
  });
  return isolated::Unpacked(child.ask("")).get<std::vector<std::string>>();
}

}  // namespace asdic::detail
