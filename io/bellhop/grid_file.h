#pragma once
#include <string>

#include "io/bellhop/case_reader.h"

namespace asdic::detail::bellhop {

/// A .bty, .ati or .ssp of BELLHOP3D that reads back as the same numbers.
[[nodiscard]] std::string grid_file_text(const GridFile& grid);

}  // namespace asdic::detail::bellhop
