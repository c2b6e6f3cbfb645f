#pragma once
#include <chrono>
#include <functional>
#include <string>
#include <thread>
#include <vector>

namespace asdic::detail::app {

/// When a line of progress is shown first, and how often from then on.
struct PaintTimes {
  std::chrono::milliseconds first, every;
};

/// Shows a line on standard error that says how far a run is. On a terminal it is drawn anew four
/// times a second, in a line of the terminal and never more, and is gone when the run ends;
/// elsewhere (a batch job's log) there is a line a minute: no run is silent for longer.
class ProgressPainter {
 public:
  /// The line as it is now, asked for from another thread. \param elapsed  [s] \param width  it
  /// may take so many columns
  using Line = std::function<std::string(double elapsed, std::size_t width)>;

  /// A run that is over sooner shows nothing; one that is not moves within its first second.
  static constexpr PaintTimes on_terminal{std::chrono::milliseconds(300),
                                          std::chrono::milliseconds(250)};
  static constexpr PaintTimes in_log{std::chrono::minutes(1), std::chrono::minutes(1)};
  static constexpr std::size_t width_of_log = 1000;

  /// \param show  false: never
  ProgressPainter(bool show, Line line);
  ProgressPainter(Line line, bool terminal, PaintTimes times);
  ~ProgressPainter();  ///< the last line is drawn by then
  ProgressPainter(const ProgressPainter&) = delete;
  ProgressPainter& operator=(const ProgressPainter&) = delete;

 private:
  std::jthread thread_;
};

/// A part of a line of progress.
struct ProgressPart {
  std::string text;
  int rank = 0;  ///< where there is no room for all parts, those of the highest rank go first
};

/// A bar and what stands behind it, in at most `width` columns: the bar becomes short, then parts
/// are left out, then the bar, then the end of the text. \param share  that is done, 0 to 1
[[nodiscard]] std::string fitted_line(double share, std::vector<ProgressPart> parts,
                                      std::size_t width);

}  // namespace asdic::detail::app
