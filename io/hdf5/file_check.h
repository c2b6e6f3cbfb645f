#pragma once
#include <cstddef>

#include "io/hdf5/hdf5_file.h"

namespace asdic::detail {

/// What was read of a file to find damage.
struct FileCheck {
  std::size_t checked = 0,
              values = 0;     ///< datasets whose chunks carry checksums, and their numbers
  std::size_t unchecked = 0;  ///< datasets without
};

/// Reads every dataset that carries checksums, block by block.
/// \throws InputError naming the first dataset and place whose data are not what was written
[[nodiscard]] FileCheck check_file(const Hdf5File& file);

}  // namespace asdic::detail
