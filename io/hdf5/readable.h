#pragma once
#include "io/hdf5/hdf5_file.h"

namespace asdic::detail {

/// Reads every attribute of datasets and their groups and, of every dataset, the first and the last
/// values: before another program is given the file, which HDF5 may crash as it would have crashed
/// this one. \throws InputError, RunError as the methods of Hdf5File do
void check_readable(const Hdf5File& file);

}  // namespace asdic::detail
