#pragma once
#include <concepts>
#include <filesystem>
#include <optional>
#include <string_view>

#include "io/ping/ping_file.h"

// What a format that `asdic export` writes is: a struct in a file of its own, and its name in
// file_exports.h.
namespace asdic::detail::app {

/// What is to be written, and where.
struct ExportChoice {
  std::filesystem::path file;      ///< the ping file
  std::filesystem::path folder;    ///< is there
  std::size_t first = 0, end = 0;  ///< pings, counted from 0
  bool force = false;              ///< write over files that asdic did not write
};

/// `name` is its option, "wav" of --wav; `help` says what is written. check() refuses files that
/// the format has no place for, before there is a folder; write() prints what it wrote.
template <class E>
concept FileExport = requires(const PingFile& file, const ExportChoice& choice) {
  { E::name } -> std::convertible_to<std::string_view>;
  { E::help } -> std::convertible_to<std::string_view>;
  E::check(file, choice);
  E::write(file, choice);
};

/// An export whose type is forgotten.
struct AnyFileExport {
  std::string_view name, help;
  void (*check)(const PingFile& file, const ExportChoice& choice);  ///< \throws InputError
  void (*write)(const PingFile& file, const ExportChoice& choice);  ///< \throws RunError
};

template <FileExport E>
constexpr AnyFileExport any_export() {
  return {.name = E::name, .help = E::help, .check = &E::check, .write = &E::write};
}

}  // namespace asdic::detail::app
