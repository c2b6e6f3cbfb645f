#include "study/measures/row_memory.h"

#include <tbb/task_group.h>

#include <algorithm>
#include <chrono>

#include "core/memory_budget.h"
#include "raytrace/propagation.h"

namespace asdic::detail::study {

/// Some of the memory, while it lives.
class RowMemory::Hold {
 public:
  Hold(RowMemory& memory, double bytes) : memory_(memory), bytes_(bytes) {
    std::unique_lock lock(memory_.mutex_);
    while (memory_.free_ < bytes_) {
      memory_.freed_.wait_for(lock, std::chrono::milliseconds(50));
      if (tbb::is_current_task_group_canceling()) throw Interrupted();
    }
    memory_.free_ -= bytes_;
  }
  ~Hold() {
    {
      const std::lock_guard lock(memory_.mutex_);
      memory_.free_ += bytes_;
    }
    memory_.freed_.notify_all();
  }
  Hold(const Hold&) = delete;
  Hold& operator=(const Hold&) = delete;

 private:
  RowMemory& memory_;
  double bytes_;
};

RowMemory::RowMemory(double total, std::size_t rows)
    : total_(total),
      share_(total / static_cast<double>(std::max<std::size_t>(1, rows))),
      free_(total),
      usual_(share_) {}

void RowMemory::within(const std::function<void(double bytes)>& make) {
  constexpr double forgotten = 0.9;  // of what large rows asked for, with each that is not
  double bytes = 0.0;
  {
    const std::lock_guard lock(mutex_);
    bytes = usual_;
  }
  const double first = bytes;
  while (true) {
    try {
      const Hold hold(*this, bytes);
      make(bytes);
      break;
    } catch (const MemoryError& error) {
      if (bytes >= total_) throw;
      bytes = std::min(total_, std::max(error.needed(), 1.01 * bytes));
    }
  }
  const std::lock_guard lock(mutex_);
  usual_ = bytes > first ? bytes : std::max(share_, forgotten * usual_);
}

}  // namespace asdic::detail::study
