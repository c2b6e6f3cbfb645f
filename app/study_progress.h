#pragma once
#include <chrono>
#include <mutex>
#include <string>

#include "app/progress_painter.h"
#include "study/runs/run_study.h"

namespace asdic::detail::app {

/// How far a study is, on standard error (ProgressPainter).
class StudyProgress {
 public:
  explicit StudyProgress(bool show);

  void update(const study::Progress& progress);

 private:
  std::mutex mutex_;
  study::Progress progress_;
  std::chrono::steady_clock::time_point made_ = std::chrono::steady_clock::now();
  double begun_ = 0.0;  // when realisations were first counted [s]
  ProgressPainter painter_;
};

/// Bar, count, rate, remaining time, running estimate. \param elapsed  since the run began [s]
/// \param width  columns it may take
[[nodiscard]] std::string progress_line(const study::Progress& progress, double elapsed,
                                        std::size_t width);

/// "pd 0.83 (0.80 to 0.86 at 95 %)", with the digits that mean something.
[[nodiscard]] std::string estimate_text(const study::Estimate& estimate);

}  // namespace asdic::detail::app
