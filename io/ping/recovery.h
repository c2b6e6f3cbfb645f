#pragma once
#include <cstddef>
#include <filesystem>

#include "io/files/output_file.h"

namespace asdic::detail {

/// What was found in the part of a run that did not end.
struct Recovery {
  std::size_t pings = 0;
  std::size_t requested = 0;  ///< that the run was to make
};

/// Makes a ping file of a part that `asdic ping` left (killed, out of power, out of disk): the
/// pings that /ping counts, without the rows of one that was being written. The part stays as it
/// is. It is complete if it holds all pings; its root attribute `recovered` is 1. \throws
/// InputError for a file that is no ping file, holds no whole ping, or is damaged; RunError
Recovery recover_ping_file(const std::filesystem::path& part, OutputFile&& output);

}  // namespace asdic::detail
