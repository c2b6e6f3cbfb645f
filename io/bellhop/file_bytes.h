#pragma once
#include <filesystem>
#include <string>
#include <string_view>

namespace asdic::bellhop {

/// A whole file at once: under its name it is complete. \throws RunError
void write_bytes(const std::filesystem::path& path, std::string_view bytes);

}  // namespace asdic::bellhop
