#include "core/propagation_memory.h"

#include <algorithm>

namespace asdic::detail {

std::size_t ExactKey::hash() const noexcept {
  std::uint64_t h = 0;
  for (const std::uint64_t word : words_)  // one to one in every word
    h = (std::rotl(h, 29) ^ word) * 0x9E3779B97F4A7C15U;
  h = (h ^ (h >> 30)) * 0xBF58476D1CE4E5B9U;  // splitmix64's mixing
  h = (h ^ (h >> 27)) * 0x94D049BB133111EBU;
  return h ^ (h >> 31);
}

PropagationMemory::Value PropagationMemory::recall(const ExactKey& key) {
  const std::scoped_lock lock(lock_);
  const auto place = places_.find(key);
  if (place == places_.end()) return nullptr;
  std::list<Entry>& used = shelf_of(key).used;
  used.splice(used.begin(), used, place->second);
  place->second->ping = ping_;
  return place->second->value;
}

PropagationMemory::Value PropagationMemory::store(const ExactKey& key, Value value,
                                                  std::size_t bytes) {
  // Two copies of the key, a node of the list and one of the map.
  const std::size_t all = bytes + 2 * key.bytes() + sizeof(Entry) + 64;
  const std::scoped_lock lock(lock_);
  if (const auto place = places_.find(key); place != places_.end()) return place->second->value;
  Shelf& shelf = shelf_of(key);
  shelf.used.push_front({key, value, all, ping_});
  places_.emplace(key, shelf.used.begin());
  shelf.bytes += all;
  forget();
  return value;
}

void PropagationMemory::charge(const ExactKey& key, std::size_t bytes) {
  const std::scoped_lock lock(lock_);
  const auto place = places_.find(key);
  if (place == places_.end()) return;
  place->second->bytes += bytes;
  shelf_of(key).bytes += bytes;
  forget();
}

std::size_t PropagationMemory::bytes() const {
  const std::scoped_lock lock(lock_);
  return legs_.bytes + others_.bytes;
}

void PropagationMemory::next_ping() {
  const std::scoped_lock lock(lock_);
  ++ping_;
  forget();
}

/// Those in use stay alive with those who use them.
void PropagationMemory::forget() {
  const std::size_t of_legs = most_bytes_ / 3;
  forget(legs_, of_legs);
  forget(others_, most_bytes_ - std::min(of_legs, legs_.bytes));
}

void PropagationMemory::forget(Shelf& shelf, std::size_t most_bytes) {
  while (!shelf.used.empty() &&
         (shelf.bytes > most_bytes || ping_ - shelf.used.back().ping > most_pings_)) {
    shelf.bytes -= shelf.used.back().bytes;
    places_.erase(shelf.used.back().key);
    shelf.used.pop_back();
  }
}

}  // namespace asdic::detail
