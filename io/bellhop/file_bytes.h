#pragma once
#include <filesystem>
#include <string>
#include <string_view>

namespace asdic::bellhop {

/// A whole file. \throws InputError if it is not there or cannot be read
[[nodiscard]] std::string read_bytes(const std::filesystem::path& path,
                                     const std::string& expected);

/// A whole file at once: under its name it is complete. \throws RunError
void write_bytes(const std::filesystem::path& path, std::string_view bytes);

}  // namespace asdic::bellhop
