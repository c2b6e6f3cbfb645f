#include "io/files/output_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <ctime>
#include <string>
#include <string_view>
#include <thread>
#include <utility>

#include "core/error.h"

namespace asdic::detail {
namespace {

constexpr std::string_view mark = "asdic at work: ";

/// "process 4711 on host thetis since 2013-06-01T12:00:00Z"
std::string who_am_i() {
  std::array<char, 256> host{}, since{};
  if (gethostname(host.data(), host.size() - 1) != 0) host = {"unknown"};
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  std::strftime(since.data(), since.size(), "%Y-%m-%dT%H:%M:%SZ", &utc);
  return "process " + std::to_string(getpid()) + " on host " + host.data() + " since " +
         since.data();
}

/// What a lock file says; "" while its owner has not written it yet.
std::string content(int file) {
  std::array<char, 512> text{};
  const ssize_t size = pread(file, text.data(), text.size() - 1, 0);
  std::string line(text.data(), size > 0 ? static_cast<std::size_t>(size) : 0);
  return line.substr(0, line.find('\n'));
}

/// Whether a path still leads to an open file: its last owner may have taken it away.
bool is_named(int file, const std::filesystem::path& path) {
  struct stat open_one = {}, named = {};
  return fstat(file, &open_one) == 0 && lstat(path.c_str(), &named) == 0 &&
         open_one.st_dev == named.st_dev && open_one.st_ino == named.st_ino;
}

/// An open file that closes unless it is taken.
struct Descriptor {
  explicit Descriptor(int number) : file(number) {}
  ~Descriptor() {
    if (file >= 0) close(file);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  [[nodiscard]] int release() { return std::exchange(file, -1); }
  int file;
};

RunError at_work(const std::filesystem::path& target, const std::string& said) {
  const std::string who = said.starts_with(mark) ? said.substr(mark.size()) : "another process";
  return RunError(target.string() + ": another asdic is at work on it: " + who);
}

}  // namespace

bool says_no_locks(int error) noexcept {
  return error == ENOLCK || error == ENOSYS || error == EOPNOTSUPP || error == EINVAL;
}

bool refuses_locks(const std::filesystem::path& path) {
  const Descriptor file(open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY));
  if (file.file < 0) return false;
  struct flock whole = {};
  whole.l_type = F_RDLCK;
  whole.l_whence = SEEK_SET;
  const auto refused = [](int result) { return result != 0 && says_no_locks(errno); };
  return refused(flock(file.file, LOCK_SH | LOCK_NB)) || refused(fcntl(file.file, F_SETLK, &whole));
}

OutputLock::OutputLock(const std::filesystem::path& target) : path_(target.string() + ".lock") {
  // another may just be ending
  const auto enough = std::chrono::steady_clock::now() + std::chrono::seconds(1);
  while (true) {
    Descriptor lock(
        open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK, 0666));
    if (lock.file < 0) throw RunError(path_.string() + ": " + std::strerror(errno));
    alone_ = flock(lock.file, LOCK_EX | LOCK_NB) == 0;
    if (!alone_ && !says_no_locks(errno)) {
      if (errno != EWOULDBLOCK && errno != EINTR)
        throw RunError(path_.string() + ": " + std::strerror(errno));
      if (std::chrono::steady_clock::now() > enough) throw at_work(target, content(lock.file));
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
      continue;
    }
    if (!is_named(lock.file, path_)) continue;
    struct stat status = {};
    fstat(lock.file, &status);
    const std::string before = content(lock.file);
    if (!S_ISREG(status.st_mode) || (status.st_size > 0 && !before.starts_with(mark)))
      throw InputError(
          {.where = path_.string(),
           .got = "a file that asdic did not write",
           .expected = "that name to be free while " + target.filename().string() + " is written"});
    unfinished_.emplace(path_);
    const std::string text = std::string(mark) + who_am_i() + '\n';
    if (ftruncate(lock.file, 0) != 0 ||
        pwrite(lock.file, text.data(), text.size(), 0) != static_cast<ssize_t>(text.size())) {
      const int error = errno;
      unlink(path_.c_str());
      throw RunError(path_.string() + ": " + std::strerror(error));
    }
    file_ = lock.release();
    return;
  }
}

OutputLock::OutputLock(OutputLock&& other) noexcept
    : path_(std::move(other.path_)),
      file_(std::exchange(other.file_, -1)),
      alone_(other.alone_),
      unfinished_(std::move(other.unfinished_)) {}

OutputLock::~OutputLock() {
  if (file_ < 0) return;
  unfinished_.reset();
  if (is_named(file_, path_)) unlink(path_.c_str());  // while it is ours
  close(file_);
}

}  // namespace asdic::detail
