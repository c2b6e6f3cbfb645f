#include "app/compare_output.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "app/console.h"

namespace asdic::detail::app {
namespace {

using compare::Spread;
using nlohmann::ordered_json;

/// Four digits, however small.
std::string figure(double value) {
  if (value == 0.0) return "0";
  const double magnitude = std::abs(value);
  if (magnitude < 1e-3 || magnitude >= 1e5) return fmt::format("{:.3g}", value);
  return number(value, magnitude < 1.0 ? 4 : magnitude < 10.0 ? 3 : magnitude < 100.0 ? 2 : 1);
}

std::string percent(double value) { return fmt::format("{:.4g} %", value); }

/// A line for every quantity: how far A is from B.
class SpreadTable {
 public:
  void row(const std::string& name, const std::string& unit, const Spread& s) {
    if (s.count == 0) return;
    table_.row({name, unit, figure(s.mean), figure(s.median), figure(s.p90), figure(s.p95),
                figure(s.p99), figure(s.max)});
  }
  [[nodiscard]] std::string text() const { return table_.text(); }

 private:
  Table table_{{{"difference", "A - B", true},
                {"", "", true},
                {"mean"},
                {"median", "|.|"},
                {"90 %", "|.|"},
                {"95 %", "|.|"},
                {"99 %", "|.|"},
                {"max", "|.|"}}};
};

ordered_json json_of(const Spread& s) {
  if (s.count == 0) return nullptr;
  return {{"count", s.count}, {"mean", s.mean}, {"median", s.median}, {"p90", s.p90},
          {"p95", s.p95},     {"p99", s.p99},   {"max", s.max}};
}

std::string table_of(const CompareResult& result, const compare::FieldDifference& d) {
  std::string text =
      fmt::format("cells     {} of {} compared: TL below {:g} dB in both; in one only {}{}\n",
                  d.compared, d.cells, result.floor_db, percent(d.one_sided_pct),
                  d.not_finite > 0 ? fmt::format("; {} not finite", d.not_finite) : "");
  if (d.compared == 0) return text;
  SpreadTable table;
  table.row("TL", "dB", d.tl_db);
  table.row("phase", "deg", d.phase_deg);
  text += '\n' + table.text() + '\n';
  text += "within   ";
  for (std::size_t i = 0; i < d.within_pct.size(); ++i)
    text += fmt::format(" {} {:g} dB{}", percent(d.within_pct[i]), d.within_db[i],
                        i + 1 < d.within_pct.size() ? "," : "\n");
  text += fmt::format("complex   relative error {}, correlation {:.6f}, mean phase {} deg\n",
                      figure(d.relative_error), d.complex_correlation, figure(d.mean_phase_deg));
  text +=
      fmt::format("level     mean intensity of A over B {} dB; correlation of the TL maps {:.5f}\n",
                  figure(d.level_db), d.tl_correlation);
  return text;
}

std::string table_of(const CompareResult& result, const compare::ArrivalDifference& d) {
  std::string text = fmt::format(
      "paths     {} in A ({} rows), {} in B ({} rows), at {}, within {:g} dB of the strongest\n",
      d.paths_a, d.rows_a, d.paths_b, d.rows_b, count_of(d.receivers, "receiver"),
      result.below_strongest_db);
  text += fmt::format("matched   {} of B: {}, with {} of its energy; within 20 dB {} of {}: {}\n",
                      d.matched, percent(d.matched_pct()), percent(d.energy_matched_pct),
                      d.strong_matched, d.strong_b, percent(d.strong_matched_pct()));
  text += fmt::format("energy    of A over B {} dB\n", figure(d.energy_db));
  if (d.not_finite > 0)
    text += fmt::format("left out  {} rows that are not finite\n", d.not_finite);
  if (d.matched > 0) {
    SpreadTable table;
    table.row("amplitude", "dB", d.amplitude_db);
    table.row("delay", "us", d.delay_us);
    table.row("phase", "deg", d.phase_deg);
    table.row("launch angle", "deg", d.launch_deg);
    table.row("arrival angle", "deg", d.arrival_deg);
    table.row("TL of the sum", "dB", d.sum_db);
    text += '\n' + table.text();
  }
  if (!result.missed.empty()) {
    text += fmt::format("\nmissed    {} of B, the strongest of them:\n",
                        count_of(d.missed.size(), "path"));
    for (const std::string& line : result.missed) text += "  " + line + '\n';
  }
  return text;
}

std::string table_of(const CompareResult&, const compare::RayDifference& d) {
  std::string text =
      fmt::format("rays      {} in A ({} points), {} in B ({} points)\npaired    {}: {} of B\n",
                  d.rays_a, d.points_a, d.rays_b, d.points_b, d.paired, percent(d.paired_pct()));
  if (d.not_finite > 0)
    text += fmt::format("left out  {} rays that are not finite\n", d.not_finite);
  if (d.paired == 0) return text;
  SpreadTable table;
  table.row("path", "m", d.path_m);
  table.row("without ends", "m", d.inside_m);
  table.row("last point", "m", d.end_m);
  text += '\n' + table.text();
  return text + fmt::format("\nfurthest  {} m at {} km, {} m, ray of {:g} deg (positive down)\n",
                            figure(d.worst.distance), number(d.worst.range / 1000.0, 3),
                            number(d.worst.depth, 1), d.worst.launch_angle_deg);
}

ordered_json json_of(const compare::FieldDifference& d) {
  ordered_json within;
  for (std::size_t i = 0; i < d.within_pct.size(); ++i)
    within[fmt::format("{:g}", d.within_db[i])] = d.within_pct[i];
  return {{"cells", d.cells},
          {"compared", d.compared},
          {"not_finite", d.not_finite},
          {"one_sided", d.one_sided},
          {"one_sided_pct", d.one_sided_pct},
          {"compared_pct", d.compared_pct()},
          {"tl_db", json_of(d.tl_db)},
          {"within_db_pct", within},
          {"tl_correlation", d.tl_correlation},
          {"relative_error", d.relative_error},
          {"complex_correlation", d.complex_correlation},
          {"mean_phase_deg", d.mean_phase_deg},
          {"phase_deg", json_of(d.phase_deg)},
          {"level_db", d.level_db}};
}

ordered_json json_of(const compare::ArrivalDifference& d) {
  return {{"receivers", d.receivers},
          {"rows_a", d.rows_a},
          {"rows_b", d.rows_b},
          {"not_finite", d.not_finite},
          {"paths_a", d.paths_a},
          {"paths_b", d.paths_b},
          {"matched", d.matched},
          {"matched_pct", d.matched_pct()},
          {"matched_energy_pct", d.energy_matched_pct},
          {"strong_b", d.strong_b},
          {"strong_matched_pct", d.strong_matched_pct()},
          {"energy_db", d.energy_db},
          {"amplitude_db", json_of(d.amplitude_db)},
          {"delay_us", json_of(d.delay_us)},
          {"phase_deg", json_of(d.phase_deg)},
          {"launch_angle_deg", json_of(d.launch_deg)},
          {"arrival_angle_deg", json_of(d.arrival_deg)},
          {"sum_tl_db", json_of(d.sum_db)}};
}

ordered_json json_of(const compare::RayDifference& d) {
  return {{"rays_a", d.rays_a},
          {"rays_b", d.rays_b},
          {"points_a", d.points_a},
          {"points_b", d.points_b},
          {"not_finite", d.not_finite},
          {"paired", d.paired},
          {"paired_pct", d.paired_pct()},
          {"path_m", json_of(d.path_m)},
          {"inside_m", json_of(d.inside_m)},
          {"end_m", json_of(d.end_m)},
          {"worst",
           {{"launch_angle_deg", d.worst.launch_angle_deg},
            {"range", d.worst.range},
            {"depth", d.worst.depth},
            {"distance", d.worst.distance}}}};
}

constexpr const char* kinds[] = {"field", "arrivals", "rays"};

}  // namespace

std::string comparison_table(const CompareResult& result) {
  std::string text = emphasised(fmt::format("{}: {} against {}", kinds[result.comparison.index()],
                                            result.a, result.b)) +
                     '\n';
  text += std::visit([&](const auto& d) { return table_of(result, d); }, result.comparison);
  for (const std::string& line : result.exceeded) text += "outside   " + line + '\n';
  return text;
}

std::string comparison_json(const CompareResult& result) {
  ordered_json all = {{"filetype", "asdic comparison"},
                      {"version", "1.0"},
                      {"kind", kinds[result.comparison.index()]},
                      {"a", result.a},
                      {"b", result.b}};
  all.update(std::visit([](const auto& d) { return json_of(d); }, result.comparison));
  all["within_thresholds"] = result.within;
  all["exceeded"] = result.exceeded;
  if (!result.missed.empty()) all["missed"] = result.missed;
  return all.dump(1, ' ', false, ordered_json::error_handler_t::replace) + '\n';
}

}  // namespace asdic::detail::app
