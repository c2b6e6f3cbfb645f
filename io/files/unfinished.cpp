#include "io/files/unfinished.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <climits>
#include <utility>

namespace asdic::detail {
namespace {

enum class State : int { free, taken, named };
static_assert(std::atomic<State>::is_always_lock_free, "a signal handler may only use such");

struct Slot {
  std::atomic<State> state = State::free;
  std::array<char, PATH_MAX> name;
};

/// Table of the names. A command needs few of them; a name that finds no free slot is not removed.
std::array<Slot, 32> slots;

}  // namespace

Unfinished::Unfinished(const std::filesystem::path& path) noexcept : slot_(-1) {
  const std::string& name = path.native();
  if (name.size() >= PATH_MAX) return;
  for (Slot& slot : slots) {
    State expected = State::free;
    if (!slot.state.compare_exchange_strong(expected, State::taken)) continue;
    *std::copy(name.begin(), name.end(), slot.name.begin()) = '\0';
    slot.state = State::named;
    slot_ = static_cast<int>(&slot - slots.data());
    return;
  }
}

Unfinished::Unfinished(Unfinished&& other) noexcept : slot_(std::exchange(other.slot_, -1)) {}

Unfinished::~Unfinished() {
  if (slot_ >= 0) slots[static_cast<std::size_t>(slot_)].state = State::free;
}

void remove_unfinished() noexcept {
  for (const Slot& slot : slots)
    if (slot.state == State::named) unlink(slot.name.data());
}

}  // namespace asdic::detail
