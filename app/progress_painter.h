#pragma once
#include <chrono>
#include <functional>
#include <string>
#include <thread>

namespace asdic::detail::app {

/// When a line of progress is shown first, and how often from then on.
struct PaintTimes {
  std::chrono::milliseconds first, every;
};

/// Shows a line on standard error that says how far a run is. On a terminal it is drawn anew four
/// times a second once a second has passed, and is gone when the run ends; elsewhere (a batch job's
/// log) there is a line a minute: no run is silent for longer.
class ProgressPainter {
 public:
  /// The line as it is now, asked for from another thread. \param elapsed  [s]
  using Line = std::function<std::string(double elapsed)>;

  static constexpr PaintTimes on_terminal{std::chrono::seconds(1), std::chrono::milliseconds(250)};
  static constexpr PaintTimes in_log{std::chrono::minutes(1), std::chrono::minutes(1)};

  /// \param show  false: never
  ProgressPainter(bool show, Line line);
  ProgressPainter(Line line, bool terminal, PaintTimes times);
  ~ProgressPainter();  ///< the last line is drawn by then
  ProgressPainter(const ProgressPainter&) = delete;
  ProgressPainter& operator=(const ProgressPainter&) = delete;

 private:
  std::jthread thread_;
};

}  // namespace asdic::detail::app
