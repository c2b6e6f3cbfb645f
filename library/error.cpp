#include "asdic/error.h"

#include <algorithm>
#include <cctype>
#include <optional>
#include <string_view>
#include <utility>

#include "core/error.h"
#include "library/access.h"

namespace asdic {
namespace {

/// Between a file and what is at fault in it.
constexpr std::string_view separator = ": ";

/// "FILE:LINE", perhaps ":COLUMN", and "KEY" of "FILE:LINE: KEY".
struct OriginAndKey {
  std::string origin, key;
};
OriginAndKey place_of(const std::string& where) {
  const auto colon = where.find(separator);
  if (colon != std::string::npos)
    return {where.substr(0, colon), where.substr(colon + separator.size())};
  for (const std::string_view option : {"--set ", "--"})  // a change, or an option of the program
    if (where.starts_with(option)) return {"", where.substr(option.size())};
  const bool is_file = !where.empty() && std::isdigit(static_cast<unsigned char>(where.back())) &&
                       where.find(':') != std::string::npos;
  return is_file ? OriginAndKey{where, ""} : OriginAndKey{"", where};
}

/// Takes ":12" off the end of a text. \return 12
std::optional<int> take_number(std::string& text) {
  const auto colon = text.rfind(':');
  if (colon == std::string::npos || colon + 1 == text.size() || text.size() - colon > 10) return {};
  if (!std::all_of(text.begin() + static_cast<std::ptrdiff_t>(colon) + 1, text.end(),
                   [](unsigned char c) { return std::isdigit(c) != 0; }))
    return {};
  const int number = std::stoi(text.substr(colon + 1));
  text.resize(colon);
  return number;
}

/// File and line of an origin; "" and 0 where it is none.
std::pair<std::string, int> file_and_line(const std::string& where) {
  std::string file = place_of(where).origin;
  const std::optional<int> last = take_number(file);
  if (!last) return {"", 0};
  const std::optional<int> before = take_number(file);  // then `last` was the column
  return {file, before.value_or(*last)};
}

}  // namespace

InputError::InputError(std::string where, std::string found, std::string expected, std::string file)
    : std::runtime_error(
          detail::InputError({.where = where, .got = found, .expected = expected}).what()),
      where_(std::move(where)),
      found_(std::move(found)),
      expected_(std::move(expected)),
      file_(std::move(file)) {}
InputError::~InputError() = default;

std::string InputError::file() const { return file_.empty() ? file_and_line(where_).first : file_; }
int InputError::line() const { return file_.empty() ? file_and_line(where_).second : 0; }
std::string InputError::key() const {
  if (file_.empty()) return place_of(where_).key;
  const std::string before = file_ + std::string(separator);
  return where_.starts_with(before) ? where_.substr(before.size()) : "";
}

InputError shown(const detail::InputError& error, const std::vector<std::filesystem::path>& files) {
  const detail::InputFault& fault = error.fault();
  for (const std::filesystem::path& path : files) {
    const std::string file = path.string();
    if (fault.where == file || fault.where.starts_with(file + std::string(separator)))
      return InputError(fault.where, fault.got, fault.expected, file);
  }
  return InputError(fault.where, fault.got, fault.expected);
}

Stopped::Stopped() : std::runtime_error("called off") {}
Stopped::~Stopped() = default;

RunError::RunError(const std::string& what) : std::runtime_error(what) {}
RunError::~RunError() = default;

}  // namespace asdic
