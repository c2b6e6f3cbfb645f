#pragma once
#include <condition_variable>
#include <cstddef>
#include <functional>
#include <mutex>

namespace asdic::detail::study {

/// What rows that are made at a time take together is no more than the process may.
///
/// A row begins with an equal share. One that asks for more gives it back, waits until there is
/// room for what it asks for, and begins again: so whether a row can be made depends on it alone,
/// not on those beside it. Shared by threads.
class RowMemory {
 public:
  /// \param total  of all rows [bytes]   \param rows  at a time
  RowMemory(double total, std::size_t rows);

  /// Makes a row. \param make  called with the bytes that it may take; where these are total(), it
  /// is the last time
  /// \throws MemoryError of the last time; Interrupted if the row is called off while it waits
  void within(const std::function<void(double bytes)>& make);

  [[nodiscard]] double total() const noexcept { return total_; }

 private:
  class Hold;

  const double total_, share_;
  std::mutex mutex_;  // of what follows
  std::condition_variable freed_;
  double free_, usual_;
};

}  // namespace asdic::detail::study
