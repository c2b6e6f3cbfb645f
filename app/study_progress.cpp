#include "app/study_progress.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/console.h"

namespace asdic::detail::app {

std::string estimate_text(const study::Estimate& e) {
  // Two digits of the interval's half-width.
  const double half = 0.5 * (e.high - e.low);
  int decimals = 4;
  if (half > 0.0 && std::isfinite(half))
    decimals = std::clamp(1 - static_cast<int>(std::floor(std::log10(half))), 0, 6);
  const std::string unit = e.unit.empty() || e.unit == "1" ? "" : " " + e.unit;
  return fmt::format("{} {:.{}f}{} ({:.{}f} to {:.{}f} at {:g} %)", e.name, e.value, decimals, unit,
                     e.low, decimals, e.high, decimals, 100.0 * e.level);
}

std::string progress_line(const study::Progress& p, double elapsed) {
  constexpr std::uint64_t width = 30;
  const std::uint64_t made = p.done - std::min(p.before, p.done);
  const auto filled =
      static_cast<std::size_t>(p.total > 0 ? width * std::min(p.done, p.total) / p.total : 0);
  const double rate = static_cast<double>(made) / std::max(elapsed, 1e-3);
  std::string line = fmt::format("[{:<30}] {} of {}, {}", std::string(filled, '#'), p.done,
                                 count_of(p.total, "realisation"), duration(elapsed));
  if (made > 0) line += fmt::format(", {:.3g}/s", rate);
  if (made > 0 && p.done < p.total)
    line +=
        fmt::format(", about {} left", duration(std::max(double(p.total - p.done) / rate, 0.1)));
  if (p.estimate) line += "; " + estimate_text(*p.estimate);
  return line;
}

StudyProgress::StudyProgress(bool show)
    : painter_(show, [this](double elapsed) {
        const std::lock_guard lock(mutex_);
        return progress_line(progress_, elapsed);
      }) {}

void StudyProgress::update(const study::Progress& progress) {
  const std::lock_guard lock(mutex_);
  progress_ = progress;
}

}  // namespace asdic::detail::app
