#include <cctype>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <string>
#include <string_view>

#include "core/error.h"
#include "io/hdf5/hdf5_file.h"
#include "io/hdf5/own_files.h"

// Files of ours that are text, and BELLHOP's: nothing here needs a library of files.
namespace asdic::detail::own {

namespace {

namespace fs = std::filesystem;

/// The first bytes of a file; "" of what cannot be read.
std::string head(const fs::path& path, std::size_t most = 4096) {
  std::error_code ignored;
  std::ifstream file;
  if (fs::is_regular_file(path, ignored)) file.open(path, std::ios::binary);
  std::string bytes(most, '\0');
  file.read(bytes.data(), static_cast<std::streamsize>(most));
  bytes.resize(static_cast<std::size_t>(std::max<std::streamsize>(file.gcount(), 0)));
  return bytes;
}

std::string tail(const fs::path& path, std::size_t most) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  const auto size = static_cast<std::size_t>(std::max<std::streamoff>(file.tellg(), 0));
  const std::size_t length = std::min(size, most);
  std::string bytes(length, '\0');
  file.seekg(static_cast<std::streamoff>(size - length));
  file.read(bytes.data(), static_cast<std::streamsize>(length));
  return bytes;
}

/// The next line, which is taken off the text, without the blanks and quotes around it.
std::string_view take_line(std::string_view& text) {
  std::string_view line = text.substr(0, text.find('\n'));
  text.remove_prefix(std::min(text.size(), line.size() + 1));
  constexpr std::string_view around = " \t\r'\"";
  while (!line.empty() && around.find(line.front()) != around.npos) line.remove_prefix(1);
  while (!line.empty() && around.find(line.back()) != around.npos) line.remove_suffix(1);
  return line;
}

bool has(std::string_view text, std::string_view word) { return text.find(word) != text.npos; }

}  // namespace

bool scenario(const fs::path& path) {
  const std::string bytes = head(path);
  for (std::string_view text = bytes; text.starts_with('#');)
    if (has(take_line(text), remark)) return true;
  return false;
}

bool table(const fs::path& path) {
  const std::string bytes = head(path);
  std::string_view text = bytes;
  const std::string_view names = take_line(text);
  return names.starts_with("ping,array,") || names.starts_with("track,");
}

bool sound_scale(const fs::path& path) { return has(head(path), "\"pascal_per_unit\""); }

bool picture(const fs::path& path) {
  const std::string bytes = head(path);
  constexpr std::string_view signature = "\x89PNG\r\n\x1a\n", software("Software\0asdic", 14);
  return bytes.starts_with(signature) && has(bytes, software);
}

bool shade_file(const fs::path& path) {
  const std::string bytes = head(path, 4);
  std::int32_t words = 0;  // of a record
  if (bytes.size() == sizeof words) std::memcpy(&words, bytes.data(), sizeof words);
  constexpr std::int32_t fewest = 21, most = 1 << 24;
  if (words < fewest || words > most) return false;
  const std::size_t record = 4 * static_cast<std::size_t>(words);
  const std::string more = head(path, record + 10);
  if (more.size() < record + 10) return false;
  const std::string_view type = std::string_view(more).substr(record);
  return type.starts_with("rectilin") || type.starts_with("irregular");
}

bool arrivals_file(const fs::path& path) {
  const std::string bytes = head(path, 64);
  std::string_view text = bytes;
  if (text.starts_with(std::string_view("\4\0\0\0", 4)))
    return has(text, "'2D'") || has(text, "'3D'");
  const std::string_view dimension = take_line(text);
  return dimension == "2D" || dimension == "3D";
}

bool ray_file(const fs::path& path) {
  const std::string bytes = head(path);
  std::string_view text = bytes;
  constexpr int lines = 7;  // title, frequency, sources, angles, surface, bottom, coordinates
  std::string_view last;
  for (int i = 0; i < lines; ++i) last = take_line(text);
  return last == "rz";
}

bool print_file(const fs::path& path) {
  const std::string bytes = head(path);
  return bytes.starts_with("asdic ") || has(bytes, "BELLHOP");
}

bool case_file(const fs::path& path) { return has(tail(path, 200), std::string("! ") + remark); }

bool case_companion(const fs::path& path) {
  fs::path root = path;
  return case_file(root.replace_extension(".env"));
}

bool hdf5(const std::filesystem::path& path) {
  try {
    const Hdf5File file = Hdf5File::peek(path);
    return file.has_attribute("", "filetype") &&
           file.attribute_text("", "filetype").starts_with("asdic ");
  } catch (const std::exception&) {
    return false;
  }
}

bool pings(const std::filesystem::path& path) {
  try {
    const Hdf5File file = Hdf5File::peek(path);
    return file.attribute_or("", "filetype", "") == "asdic ping" &&
           file.attribute_number("", "complete") == 0.0 && file.info("ping").shape.front() > 0;
  } catch (const InputError&) {
    return false;  // damaged beyond use
  } catch (const RunError&) {
    return true;  // not known, so it is kept
  }
}

}  // namespace asdic::detail::own
