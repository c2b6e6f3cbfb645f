#pragma once
#include <atomic>
#include <bit>
#include <cstddef>
#include <deque>
#include <string>
#include <string_view>

#include "serve/session.h"

namespace asdic::detail::serve {

static_assert(std::endian::native == std::endian::little, "samples go out as they lie in memory");

/// Answers on their way to a client, and how many bytes they are. expect() and bytes() may be
/// called in any thread, the rest in one.
class Outbox {
 public:
  /// \param all  bytes of the answers of all connections; outlives this
  explicit Outbox(std::atomic<std::size_t>& all) : all_(all) {}
  ~Outbox() { all_ -= bytes_; }
  Outbox(const Outbox&) = delete;
  Outbox& operator=(const Outbox&) = delete;

  /// An answer will be added: it counts from now on.
  void expect(const Answer& answer) noexcept { count(size_of(answer)); }

  enum class Room { here, not_yet, taken_by_others };
  /// Makes room for bytes of an answer that is not yet made, which count from now on. A lone answer
  /// of an empty outbox may be as long as it is.
  /// \param most, most_of_all  that may wait here, and in all
  Room reserve(std::size_t bytes, std::size_t most, std::size_t most_of_all) {
    const std::size_t mine = bytes_;
    if (mine > 0 && mine + bytes > most) return Room::not_yet;
    std::size_t all = all_;
    do {
      if (all > 0 && all + bytes > most_of_all)
        return mine == all ? Room::not_yet : Room::taken_by_others;
    } while (!all_.compare_exchange_weak(all, all + bytes));
    bytes_ += bytes;
    return Room::here;
  }
  /// What was reserved is not needed any more, or counts as an answer by now.
  void release(std::size_t bytes) noexcept {
    bytes_ -= bytes;
    all_ -= bytes;
  }

  void add(Answer&& answer) {
    answer.line += '\n';
    waiting_.push_back(std::move(answer));
  }

  [[nodiscard]] bool empty() const noexcept { return waiting_.empty(); }
  [[nodiscard]] std::size_t answers() const noexcept { return waiting_.size(); }
  [[nodiscard]] std::size_t bytes() const noexcept { return bytes_; }

  /// Bytes of the first answer that are not yet written: of its line, then of its samples.
  [[nodiscard]] std::string_view front() const {
    const Answer& first = waiting_.front();
    if (written_ < first.line.size()) return std::string_view(first.line).substr(written_);
    const std::string_view samples(reinterpret_cast<const char*>(first.samples.data()),
                                   first.samples.size() * sizeof(float));
    return samples.substr(written_ - first.line.size());
  }
  /// \return whether an answer is complete by it
  bool wrote(std::size_t bytes) {
    written_ += bytes;
    if (written_ < added_size(waiting_.front())) return false;
    release(written_);
    written_ = 0;
    waiting_.pop_front();
    return true;
  }

  /// Throws away what waits.
  void clear() {
    for (const Answer& one : waiting_) release(added_size(one));
    waiting_.clear();
    written_ = 0;
  }

 private:
  void count(std::size_t bytes) noexcept {
    bytes_ += bytes;
    all_ += bytes;
  }
  static std::size_t size_of(const Answer& answer) noexcept {
    return answer.line.size() + 1 + answer.samples.size() * sizeof(float);
  }
  /// Of one that has its line's end.
  static std::size_t added_size(const Answer& answer) noexcept { return size_of(answer) - 1; }

  std::deque<Answer> waiting_;
  std::size_t written_ = 0;             // of the first
  std::atomic<std::size_t> bytes_ = 0;  // with those that are expected
  std::atomic<std::size_t>& all_;
};

}  // namespace asdic::detail::serve
