#pragma once
#include <filesystem>
#include <optional>

#include "io/climatology/data_grid.h"

namespace asdic::detail {

/// A grid of heights as text, by ESRI's rules: lines of ncols, nrows, xllcorner or xllcenter,
/// yllcorner or yllcenter, cellsize (or dx and dy) and perhaps NODATA_value, then a row of numbers
/// for each row of cells, from north to south. Cells are in degrees.
/// \return nothing if the file does not begin so
/// \throws InputError for a bad line, a projected grid, or one of more than 2.5e7 cells, which
/// would fill the memory (netCDF is opened, not loaded)
[[nodiscard]] std::optional<DataGrid> read_ascii_grid(const std::filesystem::path& path);

}  // namespace asdic::detail
