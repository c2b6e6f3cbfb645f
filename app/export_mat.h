#pragma once
#include "app/file_export.h"

namespace asdic::detail::app {

/// A MAT-file a ping, for Octave and MATLAB: docs/formats/mat.md.
struct MatExport {
  static constexpr std::string_view name = "mat";
  static constexpr std::string_view help =
      "NAME_pingNNN.mat for Octave and MATLAB: pressure (a column a phone), times, places of the "
      "phones, pulses, the truth, units";
  static void check(const PingFile& file, const ExportChoice& choice);
  static void write(const PingFile& file, const ExportChoice& choice);
};

}  // namespace asdic::detail::app
