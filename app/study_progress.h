#pragma once
#include <mutex>
#include <string>
#include <thread>

#include "study/run_study.h"

namespace asdic::app {

/// How far a study is, on standard error: on a terminal a line that is drawn anew four times a
/// second, elsewhere (a batch job's log) a line a minute.
class StudyProgress {
 public:
  explicit StudyProgress(bool show);
  ~StudyProgress();
  StudyProgress(const StudyProgress&) = delete;
  StudyProgress& operator=(const StudyProgress&) = delete;

  void update(const study::Progress& progress);

 private:
  void draw(double elapsed, bool terminal);

  std::mutex mutex_;
  study::Progress progress_;
  std::jthread painter_;
};

/// Bar, count, rate, remaining time, running estimate. \param elapsed  since the run began [s]
[[nodiscard]] std::string progress_line(const study::Progress& progress, double elapsed);

/// "pd 0.83 (0.80 to 0.86 at 95 %)", with the digits that mean something.
[[nodiscard]] std::string estimate_text(const study::Estimate& estimate);

}  // namespace asdic::app
