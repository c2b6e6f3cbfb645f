#include "io/scenario/embedded.h"

#include <algorithm>
#include <array>

#include "core/error.h"
#include "core/text.h"

namespace asdic::detail::scenario {
namespace {

namespace fs = std::filesystem;

bool names_files(std::string_view key) {
  constexpr std::array<std::string_view, 4> keys{"file", "include", "casts", "scenario"};
  return std::find(keys.begin(), keys.end(), key) != keys.end();
}

bool is_inside(const fs::path& folder, const fs::path& file) {
  std::error_code error;
  const fs::path home = fs::weakly_canonical(folder.empty() ? "." : folder, error);
  if (error) return false;
  const fs::path place = fs::weakly_canonical(home / file, error);
  return !error &&
         std::mismatch(home.begin(), home.end(), place.begin(), place.end()).first == home.end();
}

/// \param key  under which the value stands, of an array's items too
void check(const TomlValue& value, const std::string& key, const fs::path& folder,
           const std::string& remedy) {
  if (const auto* items = std::get_if<TomlValue::Array>(&value.data))
    for (const TomlValue& item : *items) check(item, key, folder, remedy);
  if (const auto* table = value.table())
    for (const TomlEntry& entry : *table) check(entry.value, entry.key, folder, remedy);
  const auto* name = std::get_if<std::string>(&value.data);
  if (name == nullptr || !names_files(key) || is_inside(folder, *name)) return;
  throw InputError({.where = value.origin + ": " + key,
                    .got = in_quotes(*name) + ", named in a file of results",
                    .expected = "a file in its folder or below; " + remedy});
}

}  // namespace

void check_names(const TomlValue& tree, const fs::path& folder, const std::string& remedy) {
  check(tree, "", folder, remedy);
}

void check_names(std::span<const std::string> overrides, const fs::path& folder,
                 const std::string& remedy) {
  for (const std::string& assignment : overrides) {
    const std::string path = assignment.substr(0, assignment.find('='));
    // "vary.cast.casts.0" and "environment.bottom.'file'" as "casts" and "file"
    std::string key;
    for (std::size_t start = 0; start <= path.size() && !names_files(key);) {
      const auto end = std::min(path.find('.', start), path.size());
      key = path.substr(start, end - start);
      std::erase_if(key, [](char c) { return c == '"' || c == '\'' || c == ' '; });
      start = end + 1;
    }
    if (key.empty() || path.size() == assignment.size()) continue;  // the reader tells of it
    TomlValue tree{.data = TomlValue::Table{}, .origin = "--set"};
    apply_override(tree, key + assignment.substr(path.size()));
    check(tree, "", folder, remedy);
  }
}

}  // namespace asdic::detail::scenario
