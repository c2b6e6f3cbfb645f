#pragma once
#include <filesystem>
#include <string>
#include <string_view>

namespace asdic::bellhop {

/// Why a file could not be opened, in words for "found …". \param error  errno
[[nodiscard]] std::string unreadable(int error);

/// A whole file. \throws InputError if it is not there or cannot be read
[[nodiscard]] std::string read_bytes(const std::filesystem::path& path,
                                     const std::string& expected);

/// A whole file at once: under its name it is complete. \throws RunError
void write_bytes(const std::filesystem::path& path, std::string_view bytes);

}  // namespace asdic::bellhop
