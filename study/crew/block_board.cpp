#include "study/crew/block_board.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <random>
#include <system_error>
#include <utility>

#include "core/error.h"

namespace asdic::detail::study {
namespace {

namespace fs = std::filesystem;

RunError cannot(const fs::path& path, int error) {
  return RunError(path.string() + ": " + std::strerror(error));
}

/// Makes a file that must not be there. \return whether it was this that made it
bool make(const fs::path& path, const std::string& text) {
  // Written beside it first, so that whoever sees it sees all of it; a link is made or not.
  static thread_local std::mt19937_64 chance(std::random_device{}());
  const fs::path part = path.string() + "." + std::to_string(chance()) + ".part";
  const int file = ::open(part.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0666);
  if (file < 0) throw cannot(part, errno);
  const bool written = ::write(file, text.data(), text.size()) == static_cast<ssize_t>(text.size());
  const int fault = errno;
  ::close(file);
  if (!written) {
    ::unlink(part.c_str());
    throw cannot(part, fault);
  }
  // Over NFS an answer may be lost and the call repeated: the count of links tells.
  const int linked = ::link(part.c_str(), path.c_str());
  const int why = errno;
  struct stat told {};
  const bool made = ::stat(part.c_str(), &told) == 0 && told.st_nlink == 2;
  ::unlink(part.c_str());
  if (!made && linked != 0 && why != EEXIST) throw cannot(path, why);
  return made || linked == 0;
}

std::string text_of(const fs::path& path) {
  std::ifstream in(path);
  std::string text;
  std::getline(in, text);
  return text;
}

std::optional<std::uint64_t> number_of(std::string_view text) {
  std::uint64_t number = 0;
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), number);
  return fault == std::errc() && end == text.data() + text.size() ? std::optional(number)
                                                                  : std::nullopt;
}

std::string worker_name(int worker) { return "worker-" + std::to_string(worker); }

}  // namespace

fs::path crew_of(const fs::path& output) { return output.string() + ".crew"; }

std::uint64_t BlockBoard::block_size(std::uint64_t rows) noexcept {
  constexpr std::uint64_t few = 4096, most = 65536, usual = 64;  // blocks; rows of one
  const std::uint64_t blocks = std::clamp(rows / usual, few, most);
  return std::max<std::uint64_t>(1, (rows + blocks - 1) / blocks);
}

BlockBoard::BlockBoard(fs::path folder, const std::string& identity, IndexRange range,
                       Seconds silence)
    : folder_(std::move(folder)),
      range_(range),
      silence_(silence),
      size_(block_size(range.size())) {
  std::error_code error;
  fs::create_directories(folder_, error);
  if (error) throw RunError(folder_.string() + ": " + error.message());
  const std::string study = identity + " " + index_text(range_) + " " + std::to_string(size_);
  if (!make(path("study"), study + "\n"))
    if (const std::string there = text_of(path("study")); there != study)
      throw InputError({.where = folder_.string(),
                        .got = "workers of another study, or of other realisations (" + there + ")",
                        .expected = "those of this one (" + study +
                                    "); another -o, or remove the folder once nobody works there"});
  blocks_ = (range_.size() + size_ - 1) / size_;
  // The next number; where many come at once, a step at random that grows: no row of tries that is
  // as long as they are many.
  worker_ = 1 + workers_there();
  std::minstd_rand random(static_cast<unsigned>(::getpid()) ^
                          static_cast<unsigned>(Clock::now().time_since_epoch().count()));
  for (unsigned step = 1; !make(path(worker_name(worker_)), ""); step = std::min(2 * step, 4096U))
    worker_ += static_cast<int>(1 + random() % step);
  // Evenly spread, however many come: multiples of the golden ratio.
  next_ = static_cast<std::uint64_t>(static_cast<double>(blocks_) *
                                     std::fmod(0.6180339887 * (worker_ - 1), 1.0));
  look();
}

int BlockBoard::workers_there() const {
  int greatest = 0;
  std::error_code error;
  for (fs::directory_iterator entry(folder_, error), end; !error && entry != end;
       entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (!name.starts_with("worker-")) continue;
    if (const auto number = number_of(std::string_view(name).substr(7)))
      greatest = std::max(greatest, static_cast<int>(*number));
  }
  return greatest;
}

BlockBoard::~BlockBoard() {
  for (const std::uint64_t block : own_) free(block);
}

void BlockBoard::free(std::uint64_t block) const {
  const fs::path taken = path(name_of(block, "taken"));
  if (text_of(taken) == std::to_string(worker_)) ::unlink(taken.c_str());
}

std::string BlockBoard::name_of(std::uint64_t block, const char* what) const {
  return std::to_string(block) + "." + what;
}

IndexRange BlockBoard::range_of(std::uint64_t block) const noexcept {
  const std::uint64_t first = range_.first + block * size_;
  return {first, std::min(range_.end, first + size_)};
}

void BlockBoard::live() const {
  // Times of the file system's own clock.
  ::utimensat(AT_FDCWD, path(worker_name(worker_)).c_str(), nullptr, 0);
}

/// What others have done and taken since.
void BlockBoard::look() {
  done_.clear();
  taken_.clear();
  rows_done_ = 0;
  std::error_code error;
  for (fs::directory_iterator entry(folder_, error), end; !error && entry != end;
       entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    const auto dot = name.find('.');
    const auto block = number_of(std::string_view(name).substr(0, dot));
    if (dot == std::string::npos || !block || *block >= blocks_) continue;
    if (name.substr(dot) == ".done") {
      if (done_.insert(*block).second) rows_done_ += range_of(*block).size();
    } else if (name.substr(dot) == ".taken") {
      taken_.insert(*block);
    }
  }
}

bool BlockBoard::is_gone(int worker) {
  std::error_code error;
  const auto touched = fs::last_write_time(path(worker_name(worker)), error);
  if (error) return true;
  const auto now = Clock::now();
  const auto [known, is_new] = seen_.try_emplace(worker, Seen{touched, now});
  if (!is_new && known->second.touched != touched) known->second = {touched, now};
  return now - known->second.since > silence_;
}

std::optional<int> BlockBoard::take_over(const std::string& name) {
  const auto before = number_of(text_of(path(name)));
  if (!before || static_cast<int>(*before) == worker_ || !is_gone(static_cast<int>(*before)))
    return std::nullopt;
  // One of those that see it renames it.
  const fs::path old = path(name + ".of-" + std::to_string(*before));
  if (::rename(path(name).c_str(), old.c_str()) != 0) return std::nullopt;
  ::unlink(old.c_str());
  if (!make(path(name), std::to_string(worker_))) return std::nullopt;
  return static_cast<int>(*before);
}

std::optional<BlockBoard::Block> BlockBoard::take() {
  const auto open = [&](std::uint64_t block) {
    return !done_.contains(block) && !taken_.contains(block);
  };
  const auto taken = [&](std::uint64_t block, std::optional<int> before) {
    own_.insert(block);
    taken_.insert(block);
    next_ = (block + 1) % blocks_;
    return Block{.number = block, .range = range_of(block), .before = before};
  };
  const auto next_open = [&]() -> std::optional<std::uint64_t> {
    for (std::uint64_t k = 0; k < blocks_; ++k)
      if (const std::uint64_t block = (next_ + k) % blocks_; open(block)) return block;
    return std::nullopt;
  };
  // Workers begin at places of their own. Where one meets what others have taken, what it has last
  // seen is old: it looks anew, and goes on somewhere else. So few tries are in vain, however many
  // workers and blocks there are.
  static thread_local std::minstd_rand chance(std::random_device{}());
  bool looked = false;
  while (true) {
    const std::optional<std::uint64_t> block = next_open();
    if (!block && std::exchange(looked, true)) break;
    if (!block) {
      look();
      continue;
    }
    std::error_code error;
    const auto exists = [&](const char* what) {
      return fs::exists(path(name_of(*block, what)), error);
    };
    if (!exists("taken") && make(path(name_of(*block, "taken")), std::to_string(worker_))) {
      if (!exists("done")) return taken(*block, std::nullopt);
      ::unlink(path(name_of(*block, "taken")).c_str());  // it was done meanwhile
    }
    look();
    taken_.insert(*block);
    next_ = chance() % blocks_;
  }
  for (const std::uint64_t block : std::set<std::uint64_t>(taken_))
    if (!own_.contains(block) && !done_.contains(block))
      if (const auto before = take_over(name_of(block, "taken"))) return taken(block, before);
  return std::nullopt;
}

void BlockBoard::done(const Block& block) {
  // Whoever holds it by now: its rows are there.
  if (::rename(path(name_of(block.number, "taken")).c_str(),
               path(name_of(block.number, "done")).c_str()) != 0) {
    if (errno != ENOENT) throw cannot(path(name_of(block.number, "done")), errno);
    static_cast<void>(make(path(name_of(block.number, "done")), std::to_string(worker_)));
  }
  own_.erase(block.number);
  if (done_.insert(block.number).second) rows_done_ += block.range.size();
}

void BlockBoard::give_back(const Block& block) {
  free(block.number);
  own_.erase(block.number);
}

bool BlockBoard::assembles() {
  return make(path("assembly"), std::to_string(worker_)) || take_over("assembly").has_value();
}

bool BlockBoard::is_over() const {
  std::error_code error;
  return !fs::exists(path("study"), error) && !error;
}

void BlockBoard::remove() {
  std::error_code ignored;
  own_.clear();
  for (std::uint64_t block = 0; block < blocks_; ++block)
    for (const char* what : {"done", "taken"}) fs::remove(path(name_of(block, what)), ignored);
  std::vector<fs::path> workers;
  for (fs::directory_iterator entry(folder_, ignored), end; !ignored && entry != end;
       entry.increment(ignored))
    if (entry->path().filename().string().starts_with("worker-")) workers.push_back(entry->path());
  for (const fs::path& worker : workers) fs::remove(worker, ignored);
  fs::remove(path("assembly"), ignored);
  fs::remove(path("study"), ignored);  // last: then others see that it is over
  fs::remove(folder_, ignored);        // unless somebody else keeps something there
}

}  // namespace asdic::detail::study
