#include "processing/truth.h"

#include <algorithm>

namespace asdic::detail {

std::vector<TrueEcho> true_echoes(const PingRecord& record, int array) {
  std::vector<TrueEcho> echoes;
  int phones = 0;
  for (const EchoPath& echo : record.echoes)
    if (echo.array == array) phones = std::max(phones, echo.received.channel + 1);
  // Where every phone has its own paths, the middle one's stand for all.
  for (const EchoPath& echo : record.echoes)
    if (echo.array == array && (echo.received.channel < 0 || echo.received.channel == phones / 2))
      echoes.push_back({.target = echo.target,
                        .time = echo.received.delay,
                        .struck = echo.struck,
                        .doppler = echo.received.doppler,
                        .level_db = echo.level_db,
                        .travel = echo.received.slowness.normalized()});
  return echoes;
}

std::vector<TrueTarget> true_targets(const Scenario& scenario, int ping, double start_time,
                                     std::span<const TrueEcho> echoes) {
  std::vector<TrueTarget> targets;
  for (std::size_t i = 0; i < scenario.targets.size(); ++i) {
    const Target& target = scenario.targets[i];
    double loudest = -infinity, struck = 0.0;
    for (const TrueEcho& echo : echoes)
      if (echo.target == static_cast<int>(i) && echo.level_db > loudest) {
        loudest = echo.level_db;
        struck = echo.struck;
      }
    targets.push_back({.target = static_cast<int>(i),
                       .name = target.name,
                       .present = ping >= target.first_ping && ping <= target.last_ping,
                       .position = target.track.at(start_time + struck).position});
  }
  return targets;
}

}  // namespace asdic::detail
