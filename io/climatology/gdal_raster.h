#pragma once
#include <filesystem>
#include <string>

#include "io/climatology/raster_source.h"
#include "io/isolated/child.h"

// GDAL's side of a raster: for the child process that handles it. Without GDAL there is none.
namespace asdic::detail::gdal {

[[nodiscard]] bool is_built() noexcept;

/// What is asked of the child: nothing (what the variable is), a part of it, or a place.
enum class Question { part, place };

/// Loads GDAL and opens a band. \param kind  of raster, for messages
[[nodiscard]] isolated::Child::Answer open(const std::filesystem::path& path,
                                           const std::string& kind, const RasterBand& band);

}  // namespace asdic::detail::gdal
