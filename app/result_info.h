#pragma once
#include <string>
#include <string_view>

#include "io/hdf5/hdf5_file.h"

namespace asdic::detail::app {

/// Whether a file is a result of the propagation model: HDF5 of `asdic field`, `arrivals` or
/// `rays`, or BELLHOP's .shd, .arr or .ray.
[[nodiscard]] bool is_propagation_file(const std::string& path);

/// Where on the Earth the map of a result is, and the files that its ocean was made of: lines whose
/// first word fills `width` columns. Nothing of a result that does not say so.
[[nodiscard]] std::string place_text(const Hdf5File& file, int width);

/// What it holds, on standard output. \return the exit status
int propagation_info(const std::string& path);

/// A line that tells a file's name, size and kind.
[[nodiscard]] std::string result_file_line(const std::string& path, std::string_view kind);
/// Who made an HDF5 file of results, of what scenario.
[[nodiscard]] std::string result_origin(const std::string& path);

/// The same of a WAV file of `asdic export`.
int wav_info(const std::string& path);

}  // namespace asdic::detail::app
