#pragma once
#include "app/file_export.h"

namespace asdic::detail::app {

/// A sound file a ping, and its scale in pascal.
struct WavExport {
  static constexpr std::string_view name = "wav";
  static constexpr std::string_view help =
      "NAME_pingNNN.wav, 32-bit float, a channel a phone (of complex baseband two, I and Q: one "
      "phone is stereo), and NAME_pingNNN.wav.json with the scale in pascal";
  static void check(const PingFile& file, const ExportChoice& choice);
  static void write(const PingFile& file, const ExportChoice& choice);
};

}  // namespace asdic::detail::app
