#include "app/study_progress.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "app/console.h"

namespace asdic::detail::app {

std::string estimate_text(const study::Estimate& e) {
  // Two digits of the interval's half-width.
  const double half = 0.5 * (e.high - e.low);
  int decimals = 4;
  if (half > 0.0 && std::isfinite(half))
    decimals = std::clamp(1 - static_cast<int>(std::floor(std::log10(half))), 0, 6);
  if (e.name == study::rare_event_probability || (half > 0.0 && half < 2e-6))
    return fmt::format("{} {:.3g} ({:.3g} to {:.3g} at {:g} %)", e.name, e.value, e.low, e.high,
                       100.0 * e.level);
  const std::string unit = e.unit.empty() || e.unit == "1" ? "" : " " + e.unit;
  return fmt::format("{} {:.{}f}{} ({:.{}f} to {:.{}f} at {:g} %)", e.name, e.value, decimals, unit,
                     e.low, decimals, e.high, decimals, 100.0 * e.level);
}

std::string progress_line(const study::Progress& p, double elapsed, std::size_t width) {
  const std::uint64_t made = p.done - std::min(p.before, p.done);
  const double rate = static_cast<double>(made) / std::max(elapsed, 1e-3);
  std::vector<ProgressPart> parts{
      {fmt::format("{} of {}", p.done, count_of(p.total, "realisation")), 0},
      {duration(elapsed), 3}};
  if (made > 0) parts.push_back({fmt::format("{:.3g}/s", rate), 4});
  if (made > 0 && p.done < p.total)
    parts.push_back(
        {fmt::format("about {} left", duration(std::max(double(p.total - p.done) / rate, 0.1))),
         1});
  if (p.estimate) parts.push_back({estimate_text(*p.estimate), 2});
  const double share = p.total > 0 ? double(std::min(p.done, p.total)) / double(p.total) : 0.0;
  return fitted_line(share, std::move(parts), width);
}

StudyProgress::StudyProgress(bool show)
    : painter_(show, [this](double elapsed, std::size_t width) {
        const std::lock_guard lock(mutex_);
        if (progress_.total == 0) return cut_to("preparing, " + duration(elapsed), width);
        return progress_line(progress_, elapsed - begun_, width);
      }) {}

void StudyProgress::update(const study::Progress& progress) {
  const std::lock_guard lock(mutex_);
  if (progress_.total == 0)
    begun_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - made_).count();
  progress_ = progress;
}

}  // namespace asdic::detail::app
