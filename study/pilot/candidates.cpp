#include "study/pilot/candidates.h"

#include <algorithm>
#include <utility>

#include "core/text.h"

namespace asdic::detail::study {
namespace {

/// A number of the scenario; none: it is not told, or no number.
std::optional<double> number_at(const Study& study, const std::string& path) {
  const TomlValue* value = find_at(study.scenario, path);
  if (value == nullptr) return std::nullopt;
  if (const auto* whole = std::get_if<std::int64_t>(&value->data))
    return static_cast<double>(*whole);
  if (const auto* real = std::get_if<double>(&value->data)) return *real;
  return std::nullopt;
}

std::optional<std::string> word_at(const Study& study, const std::string& path) {
  const TomlValue* value = find_at(study.scenario, path);
  if (value == nullptr) return std::nullopt;
  const auto* word = std::get_if<std::string>(&value->data);
  return word == nullptr ? std::nullopt : std::optional(*word);
}

bool is_false(const Study& study, const std::string& path) {
  const TomlValue* value = find_at(study.scenario, path);
  const bool* flag = value == nullptr ? nullptr : std::get_if<bool>(&value->data);
  return flag != nullptr && !*flag;
}

/// "array", or "array.1" of several.
std::string array_path(const Study& study) {
  const TomlValue* array = study.scenario.find("array");
  const bool several = array != nullptr && std::get_if<TomlValue::Array>(&array->data) != nullptr;
  return several ? "array." + std::to_string(study.measure.array) : "array";
}

std::string whole(double x) { return std::to_string(static_cast<long long>(x)); }

void of_measures(const MeasurePlan& plan, std::vector<Candidate>& to) {
  if (plan.detection)
    to.push_back({{"measure.detection=false", "measure.echo_level=true"},
                  "detection: no Pd and no false alarms, levels alone"});
  if (plan.wants("localisation_error"))
    to.push_back({{"measure.localisation_error=false", "measure.echo_level=true"},
                  "where the receiver puts the target"});
  if (plan.cells)
    to.push_back({{"measure.cells=false"},
                  "false alarms by every cell: one cell a row is left to count them"});
  if (plan.series_every > 0)
    to.push_back({{"measure.time_series=\"none\""}, "the samples that are kept"});
  if (plan.spectra_every > 0)
    to.push_back({{"measure.spectra=\"none\""}, "the spectra that are kept"});
  if (plan.detections_every > 0)
    to.push_back({{"measure.detections=\"none\""}, "the detections that are kept"});
  if (!plan.uses_matched_filter()) return;
  const MatchedFilterPlan& filter = plan.matched_filter;
  if (filter.background == MatchedFilterPlan::Background::expected) {
    to.push_back({{"measure.matched_filter.background=\"trend\""},
                  "false alarms at their rate where the background bends or steps: it holds where "
                  "the level rises or falls evenly in dB"});
    if (filter.draws >= 6)
      to.push_back({{"measure.matched_filter.draws=" + std::to_string(filter.draws / 3)},
                    "sharpness of the threshold: a background from fewer draws scatters more, so "
                    "the threshold is set higher"});
  }
  if (!filter.phone)
    to.push_back({{"measure.matched_filter.phone=0"},
                  "the array's gain: one phone listens, not a beam to the echo"});
}

void of_scenario(const Study& study, std::vector<Candidate>& to) {
  const MeasurePlan& plan = study.measure;
  if (study.scenario.find("reverberation") != nullptr && !is_false(study, "reverberation.enabled"))
    to.push_back({{"reverberation.enabled=false"},
                  "reverberation: only where noise alone decides is the answer the same"});
  if (plan.needs_samples()) {
    if (word_at(study, "pings.samples").value_or("pressure") != "baseband")
      to.push_back({{"pings.samples=\"baseband\""}, "nothing in the pulse's band"});
    const std::string phones = array_path(study) + ".phones";
    if (const auto n = number_at(study, phones); n && *n >= 2.0)
      to.push_back({{phones + '=' + whole(*n / 2.0)},
                    "half of the array: 3 dB of its gain against noise, beams twice as wide"});
  }
  if (!plan.filter_alone() && plan.needs_samples())
    if (const auto duration = number_at(study, "pings.recording_duration"))
      to.push_back({{"pings.recording_duration=" + to_text(*duration / 2.0)},
                    "echoes and cells of the record's second half"});
  for (const char* key : {"max_surface_bounces", "max_bottom_bounces"})
    if (const auto n = number_at(study, std::string("propagation.") + key); n && *n >= 2.0)
      to.push_back({{std::string("propagation.") + key + '=' + whole(*n / 2.0)},
                    "paths with more bounces, and what they send back late"});
}

}  // namespace

std::vector<Candidate> candidates(const Study& study) {
  std::vector<Candidate> all;
  of_measures(study.measure, all);
  of_scenario(study, all);
  return all;
}

}  // namespace asdic::detail::study
