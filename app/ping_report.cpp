#include "app/ping_report.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/units.h"
#include "sonar/paths/enough_bounces.h"
#include "sonar/ping/levels.h"
#include "sonar/reverberation/phone_groups.h"
#include "sonar/reverberation/reverberation_band.h"
#include "sonar/scenario/sampling.h"
#include "sonar/signal/pulse.h"

namespace asdic::detail::app {
namespace {
constexpr int most_lines = 200;  // of a long sequence; the file has them all
}

std::vector<Table::Column> summary_columns() {
  return {{"ping"},
          {"elevation", "deg"},
          {"target", "", true},
          {"paths"},
          {"echo at", "s"},
          {"echo", "dB re 1 µPa"},
          {"all paths", "dB re 1 µPa"},
          {"reverberation", "dB re 1 µPa"},
          {"noise in band", "dB re 1 µPa"},
          {"echo to background", "dB"}};
}

std::vector<std::string> summary_row(int ping, double elevation_deg, const TargetSummary& target) {
  std::vector<std::string> row{std::to_string(ping), number(elevation_deg, 1), target.name};
  if (!target.present) {
    row.insert(row.end(), {"absent", "-", "-", "-", "-", "-", "-"});
  } else {
    row.insert(row.end(), {std::to_string(target.paths), number(target.echo_time, 3),
                           number(target.echo_level_db, 1), number(target.echo_peak_db, 1),
                           number(target.reverberation_db, 1), number(target.noise_db, 1),
                           number(target.signal_excess_db, 1)});
  }
  return row;
}

void PingReport::add(const PingRecord& record) {
  ++pings_;
  if (beside_record_.empty())
    beside_record_ = detail::echo_beside_record(record, scenario_,
                                                Pulse(pulse_of(scenario_, record.transmitter)));
  for (const TargetSummary& target : record.summary) {
    if (lines_ == most_lines) {
      ++left_out_;
      continue;
    }
    ++lines_;
    table_.row(summary_row(record.ping, degrees(record.elevation), target));
  }
  band_error_ = std::max(band_error_, record.band.error);
  plane_wave_error_ = std::max(plane_wave_error_, record.plane_waves.error);
  bounces_.include(record.bounces);
  ended_searches_ = std::max(ended_searches_, record.ended_searches);
  sea_drawn_anew_ = sea_drawn_anew_ || record.sea_drawn_anew;
  reuse_.planes_searched += record.reuse.planes_searched;
  reuse_.planes_reused += record.reuse.planes_reused;
  reuse_.legs_searched += record.reuse.legs_searched;
  reuse_.legs_reused += record.reuse.legs_reused;
  const Timings& t = record.timings;
  total_.rays += t.rays;
  total_.eigenrays += t.eigenrays;
  total_.patches += t.patches;
  total_.synthesis += t.synthesis;
  total_.noise += t.noise;
  total_.write += t.write;
}

std::string PingReport::text(double wall) const {
  std::string result =
      fmt::format("{}\n", emphasised(scenario_.title.empty() ? scenario_.path : scenario_.title));
  if (band_error_ > ReverberationBand::error)
    result += fmt::format(
        "note: reverberation across the band is right to {:.1e} of its largest amplitude, not to "
        "{:.0e}: a law has a kink there\n",
        band_error_, ReverberationBand::error);
  if (plane_wave_error_ > reverberation_periods)
    result += fmt::format(
        "note: plane waves of reverberation are up to {:.2g} periods off at the worst phone, where "
        "the nearest scatterers or a turn of the line are received: sectors or a covariance stand "
        "for too many returns; propagation.exact_per_phone = true gives every phone its own "
        "paths\n",
        plane_wave_error_);
  if (sea_drawn_anew_)
    result +=
        "note: a frozen sea is drawn anew for every ping: under way each ping receives other sums "
        "of its scatterers, and they are too many for reverberation.most_returns\n";
  if (ended_searches_ > 0) result += fmt::format("note: {}\n", ended_early(ended_searches_));
  if (bounces_.left_out_db > tolerable_db)
    result += fmt::format(
        "note: paths of more than {} bounces are left out, up to {:.2g} dB of the level\n",
        std::max(bounces_.surface, bounces_.bottom), bounces_.left_out_db);
  const PingSchedule& p = scenario_.pings;
  result += fmt::format("{}, {}, {} s at {} Hz\n", count_of(std::size_t(pings_), "ping"),
                        count_of(channels_of(scenario_), "phone"), p.recording_duration,
                        recorded_rate(scenario_));
  if (scenario_.targets.empty()) {
    result += "no targets\n";
  } else {
    result += table_.text();
    if (left_out_ > 0)
      result += fmt::format("... and {} more lines; the file has them\n", left_out_);
    result +=
        "echo: the strongest path; all paths: the peak of their sum; reverberation: expected at "
        "that time; noise: in the "
        "pulse's -40 dB band; echo to background: all paths over both, before any processing\n";
    // T·B of a CW is some 2 to 6 at −40 dB; a sweep's paths overlap in the record only.
    const Pulse pulse(scenario_.pulse);
    if (pulse.duration() * pulse.bandwidth_40db() > 10.0)
      result +=
          "of a sweep the paths that add up here come apart in a matched filter, each by itself "
          "weaker: asdic process says which of them it detects\n";
  }
  if (varies_with_range(scenario_.environment) || scenario_.area)
    result += fmt::format(
        "after preparing: planes of reverberation searched {}, reused {}; eigenrays of echoes "
        "searched {}, reused {}\n",
        reuse_.planes_searched, reuse_.planes_reused, reuse_.legs_searched, reuse_.legs_reused);
  result += fmt::format(
      "time: {} in all; over the pings: surface paths {}, eigenrays {}, patches {}, synthesis {}, "
      "noise {}, writing {}\n",
      duration(wall), duration(total_.rays), duration(total_.eigenrays), duration(total_.patches),
      duration(total_.synthesis), duration(total_.noise), duration(total_.write));
  return result;
}

}  // namespace asdic::detail::app
