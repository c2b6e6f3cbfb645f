#include "study/journal/rows_in_hand.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <sstream>

#include "core/error.h"
#include "io/files/input_file.h"
#include "study/journal/journal.h"

namespace asdic::detail::study {
namespace {

// Lines of one length, each written by one call.
constexpr std::size_t line_length = 64;
constexpr const char* first_line = "asdic rows in hand 1";

/// Another one after every start of the machine.
std::string boot_id() {
  std::ifstream in("/proc/sys/kernel/random/boot_id");
  std::string id;
  in >> id;
  return id.empty() ? "unknown" : id;
}

/// Filled up with spaces, with its end of line.
std::array<char, line_length> line_of(const std::string& text) {
  std::array<char, line_length> line{};
  line.fill(' ');
  std::copy_n(text.begin(), std::min(text.size(), line_length - 1), line.begin());
  line.back() = '\n';
  return line;
}

}  // namespace

std::filesystem::path hand_of(const std::filesystem::path& journal) {
  return journal.string() + "-hand";
}

RowsInHand::RowsInHand(const std::filesystem::path& journal, Deaths suspects)
    : path_(hand_of(journal)) {
  for (const auto& [index, deaths] : suspects) slots_.push_back({index, deaths, State::suspect});
  // As a whole under another name first: what stood there must not be lost half way.
  const std::string fresh = path_.string() + ".new";
  file_ = ::open(fresh.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC | O_NOFOLLOW, 0644);
  const auto check = [&](bool good) {
    if (!good) throw RunError(path_.string() + ": cannot be written: " + std::strerror(errno));
  };
  check(file_ >= 0);
  const std::string boot = boot_id();
  for (const std::string& text : {std::string(first_line), boot}) {
    const auto line = line_of(text);
    check(::write(file_, line.data(), line.size()) == static_cast<ssize_t>(line.size()));
  }
  for (std::size_t i = 0; i < slots_.size(); ++i) write(i);
  check(std::rename(fresh.c_str(), path_.c_str()) == 0);
}

RowsInHand::~RowsInHand() {
  ::close(file_);
  const bool none =
      std::all_of(slots_.begin(), slots_.end(), [](const Slot& slot) { return slot.deaths == 0; });
  std::error_code ignored;
  if (none) std::filesystem::remove(path_, ignored);
}

void RowsInHand::write(std::size_t slot) const {
  const Slot& s = slots_[slot];
  std::array<char, line_length> text{};
  std::snprintf(text.data(), text.size(), "%c %llu %d", static_cast<char>(s.state),
                static_cast<unsigned long long>(s.index), s.deaths);
  const auto line = line_of(text.data());
  // A disk that is full is told of by the journal: this is no reason to stop.
  static_cast<void>(
      !::pwrite(file_, line.data(), line.size(), static_cast<off_t>((slot + 2) * line_length)));
}

std::size_t RowsInHand::begin(std::uint64_t index) {
  const std::lock_guard lock(mutex_);
  auto slot = std::find_if(slots_.begin(), slots_.end(), [&](const Slot& s) {
    return s.state == State::suspect && s.index == index;
  });
  if (slot == slots_.end())
    slot = std::find_if(slots_.begin(), slots_.end(),
                        [](const Slot& s) { return s.state == State::empty; });
  if (slot == slots_.end()) slot = slots_.insert(slots_.end(), Slot{});
  if (slot->state == State::empty) *slot = {.index = index};
  const auto at = static_cast<std::size_t>(slot - slots_.begin());
  if (!called_off_) {
    slot->state = State::making;
    write(at);
  } else if (slot->deaths == 0) {
    slot->state = State::making;  // taken, though nobody is told
  }
  return at;
}

void RowsInHand::end(std::size_t at) {
  const std::lock_guard lock(mutex_);
  Slot& slot = slots_[at];
  slot.state = slot.deaths > 0 ? State::suspect : State::empty;
  if (!called_off_) write(at);
}

Deaths RowsInHand::suspects() const {
  const std::lock_guard lock(mutex_);
  Deaths all;
  for (const Slot& slot : slots_)
    if (slot.deaths > 0) all[slot.index] = slot.deaths;
  return all;
}

void RowsInHand::clear(std::uint64_t index) {
  const std::lock_guard lock(mutex_);
  for (std::size_t i = 0; i < slots_.size(); ++i)
    if (slots_[i].index == index && slots_[i].state != State::empty) {
      slots_[i] = {};
      write(i);
    }
}

void RowsInHand::call_off() {
  const std::lock_guard lock(mutex_);
  called_off_ = true;
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    if (slots_[i].state != State::making) continue;
    slots_[i].state = slots_[i].deaths > 0 ? State::suspect : State::empty;
    write(i);
    slots_[i].state = State::making;
  }
}

Deaths deaths_of(const std::filesystem::path& output) {
  Deaths all;
  for (const std::filesystem::path& journal : journals_of(output))
    for (const auto& [index, deaths] : deaths_beside(journal, false))
      all[index] = std::max(all[index], deaths);
  return all;
}

Deaths deaths_beside(const std::filesystem::path& journal, bool anywhere) {
  using State = RowsInHand::State;
  Deaths all;
  const std::filesystem::path hand = hand_of(journal);
  std::error_code error;
  if (!std::filesystem::exists(hand, error)) return all;
  constexpr std::size_t most = 1 << 20;
  std::istringstream in(InputFile(hand, "what asdic study left there").read(most));
  std::string line, boot;
  if (!std::getline(in, line) || !line.starts_with(first_line) || !(in >> boot)) return all;
  const bool counts = anywhere || boot == boot_id();
  char state = 0;
  std::uint64_t index = 0;
  int deaths = 0;
  while (in >> state >> index >> deaths) {
    if (state == static_cast<char>(State::empty)) continue;
    const bool died = state == static_cast<char>(State::making) && counts;
    const int now = std::clamp(deaths, 0, 1000) + (died ? 1 : 0);
    if (now > 0) all[index] = std::max(all[index], now);
  }
  return all;
}

void forget_deaths(const std::filesystem::path& output, const std::filesystem::path& but) {
  std::error_code ignored;
  for (const std::filesystem::path& journal : journals_of(output))
    if (journal != but) std::filesystem::remove(hand_of(journal), ignored);
}

}  // namespace asdic::detail::study
