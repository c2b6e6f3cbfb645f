#include "app/text_output.h"

#include <cerrno>
#include <cstring>
#include <fstream>

#include "core/error.h"

namespace asdic::app {

std::filesystem::path part_of(const std::filesystem::path& path) { return path.string() + ".part"; }

void give_name(const std::filesystem::path& part, const std::filesystem::path& path) {
  std::error_code error;
  std::filesystem::rename(part, path, error);
  if (error) throw RunError(path.string() + ": " + error.message());
}

void remove_quietly(const std::filesystem::path& path) {
  std::error_code ignored;
  std::filesystem::remove(path, ignored);
}

void check_output(const std::filesystem::path& path, const std::filesystem::path& input) {
  std::error_code ignored;
  const auto wrong = [&](const std::string& got) {
    return InputError({.where = "--output", .got = got, .expected = "the name of a file to write"});
  };
  if (path.empty() || path.filename().empty() || std::filesystem::is_directory(path, ignored))
    throw wrong("the folder \"" + path.string() + '"');
  if (!input.empty() && std::filesystem::equivalent(path, input, ignored))
    throw wrong("the input itself, \"" + path.string() + '"');
  if (path.has_parent_path() && !std::filesystem::is_directory(path.parent_path(), ignored))
    throw InputError({.where = "--output",
                      .got = "no folder \"" + path.parent_path().string() + '"',
                      .expected = "a file in a folder that is there"});
}

void write_text_file(const std::filesystem::path& path, std::string_view text) {
  const std::filesystem::path part = part_of(path);
  errno = 0;
  std::ofstream file(part, std::ios::binary);
  file << text;
  file.close();
  if (!file) {
    const std::string reason = errno != 0 ? std::strerror(errno) : "it cannot be written";
    remove_quietly(part);
    throw RunError(path.string() + ": " + reason);
  }
  give_name(part, path);
}

}  // namespace asdic::app
