#pragma once
#include <string>

namespace asdic::detail::app {

/// Whether a file is a result of the propagation model: HDF5 of `asdic field`, `arrivals` or
/// `rays`, or BELLHOP's .shd, .arr or .ray.
[[nodiscard]] bool is_propagation_file(const std::string& path);

/// What it holds, on standard output. \return the exit status
int propagation_info(const std::string& path);

/// The same of a WAV file of `asdic export`.
int wav_info(const std::string& path);

}  // namespace asdic::detail::app
