#pragma once
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <set>
#include <stop_token>
#include <utility>

namespace asdic::detail::serve {

/// How much a client has computed.
class ComputedTime {
 public:
  /// Of the last minute or so [s]: what was, fades.
  [[nodiscard]] double lately(double now) const;
  [[nodiscard]] double in_all() const noexcept { return in_all_; }
  void add(double seconds, double now);

 private:
  double lately_ = 0.0, at_ = 0.0, in_all_ = 0.0;
};

/// Whose command computes: one at a time. First come, first served; but who has computed much of
/// late counts as having come so many seconds later. So nobody waits for ever, and one whose
/// commands are short does not wait for all that have long ones.
class Turns {
 public:
  /// Waits for its turn. \param now  [s] of one clock for all
  /// \return false if `off` was requested before
  bool take(const ComputedTime& computed, double now, const std::stop_token& off);
  void give_back();

 private:
  std::mutex mutex_;
  std::condition_variable_any changed_;
  std::set<std::pair<double, std::uint64_t>> waiting_;  // when it counts as come, number
  std::uint64_t came_ = 0;
  bool taken_ = false;
};

}  // namespace asdic::detail::serve
