#include "app/process_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "app/console.h"

namespace asdic::detail::app {
namespace {

struct Totals {
  int detections = 0, hits = 0, misses = 0, not_detectable = 0, false_alarms = 0;
  int of_targets = 0, direct = 0, of_other_pings = 0;  ///< the detections that are no false alarms
};

Totals totals(const ProcessedRun& run) {
  Totals sum;
  for (const ProcessedPing& ping : run.pings) {
    sum.detections += static_cast<int>(ping.array.result.detections.size());
    sum.hits += ping.score.hits;
    sum.misses += ping.score.misses;
    for (const TargetScore& one : ping.score.targets)
      sum.not_detectable += one.present && !one.detectable ? 1 : 0;
    sum.false_alarms += ping.score.false_alarms;
    for (const int owner : ping.score.owner) {
      sum.of_targets += owner >= 0 ? 1 : 0;
      sum.direct += owner == direct_sound ? 1 : 0;
      sum.of_other_pings += owner == another_ping ? 1 : 0;
    }
  }
  return sum;
}

const Detection* loudest_of(const ProcessedPing& ping, const TargetScore& score) {
  return score.detection < 0
             ? nullptr
             : &ping.array.result.detections[static_cast<std::size_t>(score.detection)];
}

/// Whether it was found; and if it has no place, why not.
std::string found_text(const TargetScore& score, const Detection* d) {
  if (!score.hit) return score.detectable ? "no" : "not detectable";
  if (d == nullptr || d->unplaced == Unplaced::no) return "yes";
  return fmt::format("yes, no place: {}", words_for(d->unplaced));
}

std::string targets_text(const ProcessedRun& run, const Scenario& scenario) {
  Table table({{"ping"},
               {"array", "", true},
               {"target", "", true},
               {"found", "", true},
               {"time", "s"},
               {"SNR", "dB"},
               {"range", "m"},
               {"off by", "m"},
               {"bearing off", "deg"},
               {"range rate", "m/s"},
               {"+-", "m/s"}});  // wide where a sweep tells little of it
  bool any = false;
  for (const ProcessedPing& ping : run.pings)
    for (const TargetScore& score : ping.score.targets) {
      if (!score.present) continue;
      any = true;
      const Detection* d = loudest_of(ping, score);
      const double none = std::nan("");
      const Location* place = d != nullptr && !d->locations.empty() ? &d->locations[0] : nullptr;
      table.row({std::to_string(ping.array.ping),
                 scenario.arrays[static_cast<std::size_t>(ping.array.array)].name,
                 scenario.targets[static_cast<std::size_t>(score.target)].name,
                 found_text(score, d), number(d != nullptr ? d->time : none, 3),
                 number(d != nullptr ? d->snr_db : none, 1),
                 number(place != nullptr ? place->range : none, 0),
                 number(std::isnan(score.position_error) ? std::abs(score.range_error)
                                                         : score.position_error,
                        0),
                 number(degrees(score.bearing_error), 2),
                 number(place != nullptr ? place->range_rate : none, 2),
                 number(place != nullptr ? d->doppler_sigma * place->rate_slope : none, 2)});
    }
  return any ? table.text() : "";
}

std::string tracks_text(const ProcessedRun& run, const Scenario& scenario) {
  if (run.tracks.empty()) return "";
  Table table({{"track"},
               {"pings", "", true},
               {"target", "", true},
               {"hits"},
               {"east", "km"},
               {"north", "km"},
               {"speed", "m/s"},
               {"off by", "m"}});
  for (std::size_t k = 0; k < run.tracks.size(); ++k) {
    const ProcessedTrack& t = run.tracks[k];
    const TrackPoint& last = t.track.points.back();
    const auto hits = std::count_if(t.rows.begin(), t.rows.end(), [](int row) { return row >= 0; });
    const std::string side = t.ambiguous ? (t.side == 0 ? " (right)" : " (left)") : "";
    const double none = std::nan("");
    table.row({std::to_string(k + 1) + side,
               fmt::format("{}-{}", t.track.points.front().ping, last.ping),
               t.target < 0 ? "-" : scenario.targets[static_cast<std::size_t>(t.target)].name,
               std::to_string(hits), number(t.has_bearing ? last.position.x() / 1000.0 : none, 3),
               number(last.position.y() / 1000.0, 3), number(last.velocity.norm(), 2),
               number(t.error.back(), 0)});
  }
  return "\n" + table.text();
}

ExpectedAlarms alarms_of_even_noise(const ProcessedRun& run) {
  ExpectedAlarms all;
  for (const ProcessedPing& ping : run.pings) {
    const ExpectedAlarms one = expected_alarms(ping.array.result);
    all.least += one.least;
    all.most += one.most;
  }
  return all;
}

/// How many false alarms even noise would give, and why that is not cells times the probability.
std::string alarms_text(const ProcessedRun& run, const Totals& sum) {
  if (run.pings.empty()) return "";
  const ExpectedAlarms all = alarms_of_even_noise(run);
  double cells = 0.0;
  for (const ProcessedPing& ping : run.pings) cells += ping.array.result.cells;
  const auto number = [](double x) {
    return x < 10.0 ? fmt::format("{:.2g}", x) : fmt::format("{:.0f}", x);
  };
  return fmt::format(
      "false alarms: {} found; even noise gives {} to {}: {:g} a cell is set, of {:.0f} cells of "
      "beams, Doppler filters and time, and in each the largest of overlapping samples counts\n",
      sum.false_alarms, number(all.least), number(all.most),
      run.pings.front().array.result.false_alarm_probability, cells);
}

/// Pings of which more was over the threshold than is kept.
std::string limit_text(const ProcessedRun& run, const Scenario& scenario) {
  constexpr std::size_t most = DetectorSettings{}.most_detections;
  std::string text;
  for (const ProcessedPing& ping : run.pings)
    if (ping.array.result.detections.size() >= most)
      text += fmt::format(
          "ping {}, array {}: {} peaks over the threshold; only the {} loudest detections among "
          "them are kept\n",
          ping.array.ping, scenario.arrays[static_cast<std::size_t>(ping.array.array)].name,
          ping.array.result.peaks, most);
  return text;
}

/// What the receiver did to the records, a line each.
std::string notes_text(const ProcessedRun& run) {
  std::string text;
  for (const std::string& note : run.notes) text += note + '\n';
  return text;
}

/// JSON has no NaN: null.
nlohmann::ordered_json value(double x) {
  return std::isfinite(x) ? nlohmann::ordered_json(x) : nlohmann::ordered_json(nullptr);
}

}  // namespace

std::string process_report(const ProcessedRun& run, const Scenario& scenario, double seconds) {
  const Totals sum = totals(run);
  std::string text = targets_text(run, scenario) + tracks_text(run, scenario);
  if (!text.empty()) text += '\n';
  std::size_t pings = 0;
  for (std::size_t k = 0; k < run.pings.size(); ++k)
    pings += k == 0 || run.pings[k].array.ping != run.pings[k - 1].array.ping ? 1 : 0;
  std::string whose = fmt::format("{} of targets", sum.of_targets);
  if (sum.direct > 0) whose += fmt::format(", {} of the direct sound", sum.direct);
  if (sum.of_other_pings > 0) whose += fmt::format(", {} of other pings", sum.of_other_pings);
  text += fmt::format(
      "{}: {} ({}, {}); targets: {} found, {} missed, {} not detectable (no echo over the "
      "threshold "
      "in the time searched); {}; {}\n",
      count_of(pings, "ping"), count_of(static_cast<std::size_t>(sum.detections), "detection"),
      whose, count_of(static_cast<std::size_t>(sum.false_alarms), "false alarm"), sum.hits,
      sum.misses, sum.not_detectable, count_of(run.tracks.size(), "track"), duration(seconds));
  return text + alarms_text(run, sum) + notes_text(run) + limit_text(run, scenario);
}

std::string process_json(const ProcessedRun& run, const Scenario& scenario,
                         const std::string& file) {
  using nlohmann::ordered_json;
  const Totals sum = totals(run);
  ordered_json pings = ordered_json::array(), tracks = ordered_json::array();
  for (const ProcessedPing& ping : run.pings) {
    ordered_json targets = ordered_json::array();
    for (const TargetScore& s : ping.score.targets) {
      const Detection* d = loudest_of(ping, s);
      const Location* place = d != nullptr && !d->locations.empty() ? &d->locations[0] : nullptr;
      targets.push_back({{"target", scenario.targets[static_cast<std::size_t>(s.target)].name},
                         {"present", s.present},
                         {"detectable", s.detectable},
                         {"hit", s.hit},
                         {"time_s", value(d != nullptr ? d->time : std::nan(""))},
                         {"snr_db", value(d != nullptr ? d->snr_db : std::nan(""))},
                         {"range_m", value(place != nullptr ? place->range : std::nan(""))},
                         {"position_error_m", value(s.position_error)},
                         {"range_error_m", value(s.range_error)},
                         {"bearing_error_deg", value(degrees(s.bearing_error))}});
    }
    pings.push_back({{"ping", ping.array.ping},
                     {"array", scenario.arrays[static_cast<std::size_t>(ping.array.array)].name},
                     {"detections", ping.array.result.detections.size()},
                     {"hits", ping.score.hits},
                     {"misses", ping.score.misses},
                     {"false_alarms", ping.score.false_alarms},
                     {"targets", targets}});
  }
  for (std::size_t k = 0; k < run.tracks.size(); ++k) {
    const ProcessedTrack& t = run.tracks[k];
    const TrackPoint& last = t.track.points.back();
    const GeographicPlace there = t.has_bearing ? run.earth.at(last.position.x(), last.position.y())
                                                : EarthPlaces().at(0.0, 0.0);
    tracks.push_back(
        {{"track", k + 1},
         {"side", t.ambiguous ? (t.side == 0 ? "right" : "left") : "only"},
         {"first_ping", t.track.points.front().ping},
         {"last_ping", last.ping},
         {"hits", std::count_if(t.rows.begin(), t.rows.end(), [](int row) { return row >= 0; })},
         {"x_m", value(t.has_bearing ? last.position.x() : std::nan(""))},
         {"y_m", value(t.has_bearing ? last.position.y() : std::nan(""))},
         {"range_m", value(t.has_bearing ? std::nan("") : last.position.y())},
         {"latitude_deg", value(there.latitude)},
         {"longitude_deg", value(there.longitude)},
         {"target", t.target < 0
                        ? ordered_json(nullptr)
                        : ordered_json(scenario.targets[static_cast<std::size_t>(t.target)].name)},
         {"error_m", value(t.error.back())}});
  }
  const ExpectedAlarms even = alarms_of_even_noise(run);
  const ordered_json json = {{"file", file},
                             {"detections", sum.detections},
                             {"of_targets", sum.of_targets},
                             {"direct", sum.direct},
                             {"of_other_pings", sum.of_other_pings},
                             {"hits", sum.hits},
                             {"misses", sum.misses},
                             {"not_detectable", sum.not_detectable},
                             {"false_alarms", sum.false_alarms},
                             {"expected_false_alarms", {even.least, even.most}},
                             {"notes", run.notes},
                             {"pings", pings},
                             {"tracks", tracks}};
  return json.dump(2, ' ', false, ordered_json::error_handler_t::replace) + '\n';
}

}  // namespace asdic::detail::app
