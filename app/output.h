#pragma once
#include <filesystem>
#include <string_view>

#include "io/hdf5/hdf5_output.h"
#include "io/result/result_root.h"

namespace asdic::detail::app {

/// That a name does not end like a file of BELLHOP's of another kind (.arr .ray .shd), which would
/// hold HDF5 then. \param own  the one ending a command writes, or "" \throws InputError
void check_kind(const std::filesystem::path& path, std::string_view own);

}  // namespace asdic::detail::app
