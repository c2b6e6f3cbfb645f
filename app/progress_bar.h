#pragma once
#include <atomic>
#include <string>
#include <thread>

namespace asdic::app {

/// A line on standard error that says how far a run is: on a terminal, and once a second has
/// passed. Gone again when it ends.
class ProgressBar {
 public:
  /// \param thing  what is counted: "ping", or "%" for a share   \param show  false: never
  ProgressBar(std::string thing, int total, bool show);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  void done(int count) noexcept { done_ = count; }

 private:
  void draw(double elapsed) const;

  std::string thing_;
  int total_;
  std::atomic<int> done_ = 0;
  std::jthread painter_;
};

/// The line itself. \param elapsed  [s]
[[nodiscard]] std::string progress_line(const std::string& thing, int done, int total,
                                        double elapsed);

}  // namespace asdic::app
