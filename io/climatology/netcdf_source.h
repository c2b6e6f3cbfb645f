#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "io/climatology/grid_source.h"

namespace asdic::detail {

/// A variable of a netCDF file, in a child process (io/isolated/child.h) that has it open, by the
/// COARDS and CF conventions: axes are known by their units, standard_name, axis or positive
/// attributes. Of packed values (scale_factor, add_offset) it tells what is missing: missing_value,
/// _FillValue, netCDF's own fill value, valid_range, valid_min, valid_max.
/// \param names  standard_names or names, in order of preference; letter case does not matter
/// \return one whose variable is not `found` if the file has none of them
/// \throws InputError if the file is not readable netCDF, or the variable has no longitude and
/// latitude (or projected x and y), a dimension longer than one that is no known axis, or an axis
/// that neither rises nor falls
[[nodiscard]] std::unique_ptr<const GridSource> open_netcdf(const std::filesystem::path& path,
                                                            const std::vector<std::string>& names);

}  // namespace asdic::detail
