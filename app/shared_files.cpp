#include "app/shared_files.h"

#include <string_view>
#include <system_error>

namespace asdic::detail::app {

namespace fs = std::filesystem;

namespace {

/// A system's program knows no sources: what it was installed with is here.
constexpr std::string_view of_system = "/usr";
constexpr std::string_view sources = ASDIC_SOURCE_DIR;

fs::path below(const fs::path& prefix, const fs::path& name) {
  return prefix / (name.begin()->string() == "docs" ? "share/doc/asdic" : "share/asdic") / name;
}

}  // namespace

fs::path installed_file(const fs::path& name) {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  return below(program.parent_path().parent_path(), name);  // of bin/asdic
}

fs::path shared_file(const fs::path& name) {
  std::error_code error;
  if (fs::path installed = installed_file(name); fs::exists(installed, error)) return installed;
  if (fs::path source = fs::path(sources) / name; !sources.empty() && fs::exists(source, error))
    return source;
  return {};
}

std::string told_place(const std::string& name) {
  const fs::path found = shared_file(name);
  if (!found.empty()) return found.string();
  return sources.empty() ? below(of_system, name).string() : name;
}

}  // namespace asdic::detail::app
