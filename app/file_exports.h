#pragma once
#include <array>

#include "app/export_mat.h"
#include "app/export_wav.h"
#include "app/file_export.h"

namespace asdic::detail::app {

template <FileExport... E>
inline constexpr std::array<AnyFileExport, sizeof...(E)> export_list{any_export<E>()...};

/// Every format. A new one is one file and one name here.
inline constexpr auto file_exports = export_list<WavExport, MatExport>;

}  // namespace asdic::detail::app
