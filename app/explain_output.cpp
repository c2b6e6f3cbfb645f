#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "app/console.h"
#include "app/explanation.h"

namespace asdic::detail::app {
namespace {

using compare::ArrivalDifference;
using compare::FieldDifference;
using compare::RayDifference;
using nlohmann::ordered_json;

std::string figure(double value) {
  return value != 0.0 && std::abs(value) < 0.01 ? fmt::format("{:.1e}", value)
                                                : fmt::format("{:.3g}", value);
}

std::vector<Table::Column> columns_of(const Comparison& kind) {
  std::vector<Table::Column> columns = {{"what", "", true}, {"from -> to", "", true}};
  if (std::holds_alternative<FieldDifference>(kind))
    for (const auto& [name, unit] : {std::pair{"median", "|dTL| dB"},
                                     {"95 %", "dB"},
                                     {"99 %", "dB"},
                                     {"within 1 dB", "%"},
                                     {"phase", "median deg"},
                                     {"level", "dB"}})
      columns.push_back({name, unit});
  else if (std::holds_alternative<ArrivalDifference>(kind))
    for (const auto& [name, unit] : {std::pair{"matched", "%"},
                                     {"delay", "median us"},
                                     {"95 %", "us"},
                                     {"amplitude", "median dB"},
                                     {"95 %", "dB"},
                                     {"angle", "95 % deg"},
                                     {"energy", "dB"}})
      columns.push_back({name, unit});
  else
    for (const auto& [name, unit] :
         {std::pair{"paired", "%"}, {"path", "median m"}, {"95 %", "m"}, {"max", "m"}})
      columns.push_back({name, unit});
  return columns;
}

std::vector<std::string> cells_of(const Comparison& difference) {
  if (const auto* d = std::get_if<FieldDifference>(&difference))
    return {figure(d->tl_db.median),  figure(d->tl_db.p95),        figure(d->tl_db.p99),
            figure(d->within_pct[3]), figure(d->phase_deg.median), figure(d->level_db)};
  if (const auto* d = std::get_if<ArrivalDifference>(&difference))
    return {figure(d->matched_pct()),    figure(d->delay_us.median),
            figure(d->delay_us.p95),     figure(d->amplitude_db.median),
            figure(d->amplitude_db.p95), figure(d->arrival_deg.p95),
            figure(d->energy_db)};
  const auto& d = std::get<RayDifference>(difference);
  return {figure(d.paired_pct()), figure(d.inside_m.median), figure(d.inside_m.p95),
          figure(d.inside_m.max)};
}

ordered_json json_of(const Comparison& difference) {
  // what `asdic compare --json` prints, but for what it says of files and thresholds
  auto all = ordered_json::parse(comparison_json({.a = "", .b = "", .comparison = difference}));
  for (const char* key : {"filetype", "version", "a", "b", "within_thresholds", "exceeded"})
    all.erase(key);
  return all;
}

ordered_json json_of(const Effect& effect) {
  ordered_json out = {{"what", effect.name}, {"setting", effect.setting}};
  out["difference"] = json_of(effect.difference);
  return out;
}

}  // namespace

std::string explanation_table(const Explanation& e) {
  std::string text = emphasised(e.title) + '\n';
  text += fmt::format("{} at {:g} Hz; BELLHOP: step {:.4g} m, {}\n", e.kind, e.frequency, e.step,
                      count_of(e.beams, "beam"));
  text += "truth: " + e.truth + "\n\n";
  Table table(columns_of(e.total));
  const auto add = [&table](const std::string& name, const std::string& setting,
                            const Comparison& difference) {
    std::vector<std::string> cells = {name, setting};
    for (std::string& cell : cells_of(difference)) cells.push_back(std::move(cell));
    table.row(std::move(cells));
  };
  add("BELLHOP", "as asked -> the truth", e.total);
  for (const Effect& effect : e.effects) add("  " + effect.name, effect.setting, effect.difference);
  if (e.rest) add("  " + e.rest->name, e.rest->setting, e.rest->difference);
  if (e.on_disk) {
    add("file on disk", "-> BELLHOP run here", e.on_disk->bellhop_emulation);
    add("", "-> the truth", e.on_disk->truth);
  }
  text += table.text() + '\n';
  for (const std::string& line : e.advice) text += "* " + line + '\n';
  for (const std::string& line : e.notes) text += "note: " + line + '\n';
  return text;
}

std::string explanation_json(const Explanation& e) {
  ordered_json all = {{"filetype", "asdic explanation"},
                      {"version", "1.0"},
                      {"title", e.title},
                      {"kind", e.kind},
                      {"frequency_hz", e.frequency},
                      {"step_m", e.step},
                      {"beams", e.beams},
                      {"truth", e.truth}};
  all["total"] = json_of(e.total);
  all["effects"] = ordered_json::array();
  for (const Effect& effect : e.effects) all["effects"].push_back(json_of(effect));
  if (e.rest) all["rest"] = json_of(*e.rest);
  if (e.on_disk) {
    all["on_disk"]["file"] = e.on_disk->file;
    constexpr const char* writers[] = {"unknown", "BELLHOP", "asdic", "asdic --like-bellhop"};
    all["on_disk"]["written_by"] = writers[static_cast<int>(e.on_disk->writer)];
    all["on_disk"]["against_bellhop"] = json_of(e.on_disk->bellhop_emulation);
    all["on_disk"]["against_truth"] = json_of(e.on_disk->truth);
  }
  all["advice"] = e.advice;
  all["notes"] = e.notes;
  return all.dump(1, ' ', false, ordered_json::error_handler_t::replace) + '\n';
}

}  // namespace asdic::detail::app
