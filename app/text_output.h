#pragma once
#include <filesystem>
#include <string_view>

namespace asdic::app {

/// Before hours of work: that a result could have this name. \param input  what it is made from
/// \throws InputError for a folder, the input itself, or a folder that is not there
void check_output(const std::filesystem::path& path, const std::filesystem::path& input);

/// A whole text file at once: under its name it is complete. \throws RunError
void write_text_file(const std::filesystem::path& path, std::string_view text);

/// The name of a file while it is being written.
[[nodiscard]] std::filesystem::path part_of(const std::filesystem::path& path);
/// What is whole gets its name. \throws RunError
void give_name(const std::filesystem::path& part, const std::filesystem::path& path);
void remove_quietly(const std::filesystem::path& path);

}  // namespace asdic::app
