// Where journals lie beside a study's file.
#include <algorithm>

#include "study/journal/journal.h"

namespace asdic::study {

std::filesystem::path journal_of(const std::filesystem::path& output) {
  return output.string() + ".journal";
}

std::filesystem::path journal_of(const std::filesystem::path& output, int rank) {
  return output.string() + ".rank" + std::to_string(rank) + ".journal";
}

std::vector<std::filesystem::path> journals_of(const std::filesystem::path& output) {
  std::vector<std::filesystem::path> found;
  const std::string stem = output.filename().string() + ".";
  const auto folder = output.has_parent_path() ? output.parent_path() : std::filesystem::path(".");
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with(stem) || !name.ends_with(".journal")) continue;
    const std::string middle = name.substr(stem.size() - 1, name.size() - stem.size() - 7);
    if (middle.empty() || middle.starts_with(".rank")) found.push_back(output.parent_path() / name);
  }
  std::sort(found.begin(), found.end());
  return found;
}

void remove_journal(const std::filesystem::path& path) {
  std::error_code ignored;
  for (const char* suffix : {"-wal", "-shm", "-hand", ""})
    std::filesystem::remove(path.string() + suffix, ignored);
}

}  // namespace asdic::study
