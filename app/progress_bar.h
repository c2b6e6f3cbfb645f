#pragma once
#include <atomic>
#include <string>

#include "app/progress_painter.h"

namespace asdic::detail::app {

/// A line on standard error that says how far a run is (ProgressPainter).
class ProgressBar {
 public:
  /// \param thing  what is counted: "ping", or "%" for a share   \param show  false: never
  ProgressBar(std::string thing, int total, bool show);

  void done(int count) noexcept { done_ = count; }

 private:
  std::atomic<int> done_ = 0;
  ProgressPainter painter_;
};

/// The line itself. \param elapsed  [s]
[[nodiscard]] std::string progress_line(const std::string& thing, int done, int total,
                                        double elapsed);

}  // namespace asdic::detail::app
