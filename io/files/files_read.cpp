#include "io/files/files_read.h"

#include <sys/stat.h>

#include <map>
#include <mutex>
#include <utility>

namespace asdic::detail {
namespace {

using Identity = std::pair<dev_t, ino_t>;

std::optional<Identity> identity_of(const std::filesystem::path& path) {
  struct stat status = {};
  if (stat(path.c_str(), &status) != 0) return {};
  return Identity{status.st_dev, status.st_ino};
}

/// What a process has read is a fact about the process: the one list of it.
struct List {
  std::mutex mutex;
  bool kept = false;
  std::map<Identity, std::filesystem::path> files;
};

List& list() {
  static List only;
  return only;
}

}  // namespace

FilesRead::FilesRead() {
  const std::lock_guard lock(list().mutex);
  list().kept = true;
}

FilesRead::~FilesRead() {
  const std::lock_guard lock(list().mutex);
  list().kept = false;
  list().files.clear();
}

void note_read(const std::filesystem::path& path) {
  List& all = list();
  const std::lock_guard lock(all.mutex);
  if (!all.kept) return;
  if (const auto identity = identity_of(path)) all.files.emplace(*identity, path);
}

void forget_read(const std::filesystem::path& path) {
  List& all = list();
  const std::lock_guard lock(all.mutex);
  if (const auto identity = identity_of(path)) all.files.erase(*identity);
}

std::optional<std::filesystem::path> read_before(const std::filesystem::path& path) {
  List& all = list();
  const std::lock_guard lock(all.mutex);
  const auto identity = identity_of(path);
  if (!identity) return {};
  const auto found = all.files.find(*identity);
  if (found == all.files.end()) return {};
  return found->second;
}

}  // namespace asdic::detail
