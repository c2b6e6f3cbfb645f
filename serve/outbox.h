#pragma once
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstring>
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
  /// An answer will be added: it counts from now on.
  void expect(const Answer& answer) noexcept { bytes_ += size_of(answer); }

  void add(Answer&& answer) {
    std::string all = std::move(answer.line);
    all += '\n';
    const std::size_t line = all.size(), samples = answer.samples.size() * sizeof(float);
    all.resize(line + samples);
    if (samples > 0) std::memcpy(all.data() + line, answer.samples.data(), samples);
    waiting_.push_back(std::move(all));
  }

  [[nodiscard]] bool empty() const noexcept { return waiting_.empty(); }
  [[nodiscard]] std::size_t answers() const noexcept { return waiting_.size(); }
  [[nodiscard]] std::size_t bytes() const noexcept { return bytes_; }

  /// Bytes of the first answer that are not yet written.
  [[nodiscard]] std::string_view front() const {
    return std::string_view(waiting_.front()).substr(written_);
  }
  /// \return whether an answer is complete by it
  bool wrote(std::size_t bytes) {
    written_ += bytes;
    if (written_ < waiting_.front().size()) return false;
    bytes_ -= written_;
    written_ = 0;
    waiting_.pop_front();
    return true;
  }

  /// Throws away what waits.
  void clear() {
    for (const std::string& one : waiting_) bytes_ -= one.size();
    waiting_.clear();
    written_ = 0;
  }

 private:
  static std::size_t size_of(const Answer& answer) noexcept {
    return answer.line.size() + 1 + answer.samples.size() * sizeof(float);
  }

  std::deque<std::string> waiting_;
  std::size_t written_ = 0;             // of the first
  std::atomic<std::size_t> bytes_ = 0;  // with those that are expected
};

}  // namespace asdic::detail::serve
