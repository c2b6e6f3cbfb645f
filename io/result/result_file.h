#pragma once
#include <filesystem>
#include <string>
#include <variant>

#include "io/bellhop/bellhop_files.h"
#include "io/hdf5/hdf5_file.h"
#include "raytrace/cases/earth_line.h"

namespace asdic::detail {

/// A result of the propagation model, of either program.
using PropagationFile = std::variant<bellhop::ShadeFile, bellhop::ArrivalsFile, bellhop::RayFile>;

/// Of docs/formats/field.md, arrivals.md and rays.md, in HDF5.
inline constexpr const char* result_version = "1.5";

/// "field", "arrivals" or "rays".
[[nodiscard]] std::string_view kind_of(const PropagationFile& file) noexcept;

/// Reads BELLHOP's .shd, .arr and .ray (by the name's ending) and HDF5 files of `asdic field`,
/// `asdic arrivals` and `asdic rays` (by their first bytes).
/// \throws InputError that says what was found and expected
[[nodiscard]] PropagationFile read_result(const std::filesystem::path& path);

/// The filetype that an HDF5 file of ours tells at its root; "" of any other file.
[[nodiscard]] std::string filetype_of(const std::filesystem::path& path);

/// Whether a file begins as HDF5 does. \throws InputError if it cannot be read
[[nodiscard]] bool is_hdf5(const std::filesystem::path& path);

/// The same from and to an open HDF5 file: filetypes "asdic field", "asdic arrivals" (the table
/// /arrivals with the receivers' axes), "asdic rays" (docs/formats). Nothing of a BELLHOP file, its
/// dialect included, is lost on the way there and back but float32's last bit in angles; elevations
/// are positive up there.
[[nodiscard]] PropagationFile read_hdf5_result(const Hdf5File& file);
void write_hdf5_result(Hdf5File& file, const PropagationFile& result, const EarthLine& earth = {});

}  // namespace asdic::detail
