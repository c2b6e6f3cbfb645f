#include "serve/session_state.h"

#include <algorithm>
#include <utility>

#include "io/scenario/document.h"
#include "io/scenario/propagation.h"
#include "raytrace/parallel/stop.h"

namespace asdic::detail::serve {
namespace {

constexpr std::size_t most_simulators = 4;  // of waveforms that take turns

std::string padded(int number, int width) {
  std::string digits = std::to_string(number);
  return std::string(static_cast<std::size_t>(std::max(0, width - int(digits.size()))), '0') +
         digits;
}

}  // namespace

SessionState::SessionState(const SessionSettings& common, std::function<double()> seconds)
    : settings(common),
      clock(std::move(seconds)),
      start(clock()),
      number(settings.log ? settings.log->new_session() : 0),
      live(settings.scenario, settings.data, settings.limits),
      schedule(live.state().scenario),
      budget_(budget_of(scenario::read_document(settings.scenario.text, settings.scenario.path,
                                                settings.scenario.overrides))
                  .share(static_cast<double>(settings.limits.memory_bytes), "memory_bytes")),
      propagation_(std::make_shared<SharedPropagation>(settings.limits.kept_bytes)) {}

double SessionState::at(double seconds) const {
  return (seconds - start) * settings.pace.factor.value_or(1.0);
}

double SessionState::clock_at(double time) const {
  return start + time / settings.pace.factor.value_or(1.0);
}

double SessionState::now() const {
  if (acts) return *acts;
  if (settings.pace.by_the_clock()) return at(clock());
  if (listening) return listening->time();
  return schedule.next(live.state().scenario).time;
}

void SessionState::end_listening() {
  if (!listening || !listening->blocks()) return;
  const std::int64_t position = listening->end();
  if (!settings.log) return;
  try {
    settings.log->ended(number, position);
  } catch (const RunError& error) {
    settings.report(error.what());
  }
}

std::shared_ptr<const PingSimulator> SessionState::simulator_of(LiveScenario::State state) {
  const auto found = std::find_if(simulators_.begin(), simulators_.end(),
                                  [&](const Simulator& one) { return one.key == state.key; });
  if (found != simulators_.end()) {
    simulators_.splice(simulators_.begin(), simulators_, found);
  } else {
    auto made = std::make_shared<PingSimulator>(std::move(state.scenario), propagation_, budget_);
    if (!judged_) made->judge_paths();
    stop_point();
    judged_ = true;  // unless it was called off
    simulators_.push_front({.key = std::move(state.key), .simulator = std::move(made)});
    if (simulators_.size() > most_simulators) simulators_.pop_back();
  }
  return simulators_.front().simulator;
}

const std::filesystem::path& SessionState::folder() {
  for (int n = 1; folder_.empty(); ++n) {
    const auto folder = settings.output / ("session-" + padded(n, 4));
    std::error_code error;
    if (std::filesystem::create_directory(folder, error)) folder_ = folder;
    if (error) throw RunError(folder.string() + ": " + error.message());
  }
  return folder_;
}

std::filesystem::path SessionState::next_file() {
  return folder() / ("ping-" + padded(pings + 1, 6) + ".h5");
}

std::filesystem::path SessionState::next_save() {
  return folder() / ("scenario-" + padded(++saves_, 6) + ".toml");
}

}  // namespace asdic::detail::serve
