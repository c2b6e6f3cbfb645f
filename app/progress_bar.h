#pragma once
#include <atomic>
#include <mutex>
#include <string>
#include <string_view>

#include "app/progress_painter.h"

namespace asdic::detail::app {

/// What a bar shows.
struct BarState {
  std::string thing;        ///< what is counted: "ping", or "%" for a share
  int total = 0;            ///< 0: not known yet; `doing` says what is done
  double done = 0.0;        ///< of `total`
  double in_hand = 0.0;     ///< parts of those that are not done: they move the bar alone
  std::string doing;        ///< "paths to targets"; "": nothing to tell
  double counted_from = 0;  ///< when the count began [s]
};

/// A line on standard error that says how far a run is (ProgressPainter).
class ProgressBar {
 public:
  /// \param show  false: never
  ProgressBar(std::string thing, int total, bool show);
  /// Of work that is prepared before anything is counted: count() comes later.
  ProgressBar(std::string doing, bool show);

  void count(std::string thing, int total);
  /// \param in_hand  parts of those that are not done, added up: they move the bar alone
  void done(double count, double in_hand = 0.0);
  void doing(std::string_view what);

 private:
  std::mutex mutex_;
  BarState state_;
  double elapsed_ = 0.0;  // when the line was drawn last [s]
  ProgressPainter painter_;
};

/// The line itself. \param elapsed  [s] \param width  columns it may take
[[nodiscard]] std::string progress_line(const BarState& state, double elapsed, std::size_t width);

}  // namespace asdic::detail::app
