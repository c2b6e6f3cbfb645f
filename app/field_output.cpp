#include "app/field_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "app/console.h"
#include "io/compare/statistics.h"
#include "io/hdf5/environment_group.h"
#include "io/scenario/propagation.h"
#include "raytrace/cases/beam_error_text.h"

namespace asdic::detail::app {
namespace {

using nlohmann::ordered_json;

/// Transmission losses where there is sound, sorted [dB].
std::vector<double> losses(const std::vector<std::complex<float>>& pressure) {
  std::vector<double> all;
  for (const std::complex<float> p : pressure)
    if (const double magnitude = std::abs(std::complex<double>(p)); magnitude > 0.0)
      all.push_back(-20.0 * std::log10(magnitude));
  std::sort(all.begin(), all.end());
  return all;
}

/// \param received  of so many receivers
double silent_pct(std::size_t receivers, std::size_t received) {
  const auto all = static_cast<double>(receivers);
  return all > 0.0 ? 100.0 * (all - static_cast<double>(received)) / all : 0.0;
}

std::string receivers_text(const ReceiverGrid& grid) {
  return grid.irregular
             ? count_of(grid.ranges.size(), "receiver")
             : fmt::format("{} depths x {} ranges", grid.depths.size(), grid.ranges.size());
}

}  // namespace

std::string loss_text(const std::vector<std::complex<float>>& pressure) {
  const std::vector<double> tl = losses(pressure);
  if (tl.empty()) return "loss       no sound at 100 %\n";
  return fmt::format("loss       {} to {} dB, median {} dB; no sound at {:.3g} %\n",
                     number(tl.front(), 1), number(tl.back(), 1),
                     number(compare::quantile(tl, 0.5), 1), silent_pct(pressure.size(), tl.size()));
}

FieldData field_data(const PropagationCase& run_case, PropagationResult&& result) {
  return {.title = run_case.title,
          .frequency = run_case.frequency,
          .kind = run_case.field,
          .source = run_case.beams.source,
          .source_depths = run_case.source_depths,
          .receivers = run_case.receivers,
          .pressure = std::move(result.field),
          .beam_kind = std::string(word_of(run_case.beams.kind)),
          .beams = result.beams,
          .beam_error_db = result.beam_error_db,
          .beam_error_bounded = result.beam_error_bounded,
          .beam_errors = std::move(result.beam_errors),
          .solver = std::string(word_of(result.waves ? FieldSolver::waves : FieldSolver::beams)),
          .earth = EarthLine(run_case)};
}

void write_field_file(OutputFile&& to, const FieldResult& result) {
  Hdf5Output output(std::move(to));
  Hdf5File& file = output.file();
  write_root(file, "asdic field", result.origin);
  write_field(file, result.data);
  const auto& ranges = result.run_case.receivers.ranges;
  const auto [first, last] = std::minmax_element(ranges.begin(), ranges.end());
  const double furthest = std::max(0.0, *last);
  write_environment_group(file, plane_of(result.run_case), std::min(0.0, *first), furthest,
                          reach_on_map(result.run_case, furthest));
  output.finish();
}

std::string field_text(const FieldResult& result, double wall) {
  const FieldData& data = result.data;
  std::string text =
      emphasised(data.title.empty() ? result.origin.path : data.title) +
      fmt::format("\nfield      {}, {:g} Hz, {} source, {}, {}\n", word_of(data.kind),
                  data.frequency, word_of(data.source),
                  count_of(data.source_depths.size(), "depth"), receivers_text(data.receivers));
  if (data.beams > 0)
    text += fmt::format("beams      {} of kind {}; {}\n", data.beams, data.beam_kind,
                        beam_error_text(data.beam_error_db, data.beam_error_bounded));
  else if (data.solver == word_of(FieldSolver::waves))
    text += "waves      no beams: the wave equation is solved\n";
  else
    text += "beams      none: the note tells why\n";
  if (const double share = share_sure(data.beam_errors); !std::isnan(share))
    text += "certain    " + certainty_text(share) + '\n';
  text += loss_text(data.pressure);
  for (const std::string& note : result.notes) text += "note: " + note + '\n';
  return text + fmt::format("{}: {}, {}\n", result.output.string(),
                            byte_count(double(std::filesystem::file_size(result.output))),
                            duration(wall));
}

std::string field_json(const FieldResult& result) {
  const FieldData& data = result.data;
  const std::vector<double> tl = losses(data.pressure);
  const double sure = share_sure(data.beam_errors);
  ordered_json loss;
  if (!tl.empty())
    loss = {{"least", tl.front()}, {"median", compare::quantile(tl, 0.5)}, {"greatest", tl.back()}};
  const ordered_json all = {{"filetype", "asdic field summary"},
                            {"version", "1.0"},
                            {"title", data.title},
                            {"scenario", result.origin.path},
                            {"output", result.output.string()},
                            {"frequency_hz", data.frequency},
                            {"field", word_of(data.kind)},
                            {"source", word_of(data.source)},
                            {"source_depths", data.source_depths.size()},
                            {"receivers", data.receivers.size()},
                            {"beam_kind", data.beam_kind},
                            {"solver", data.solver},
                            {"beams", data.beams},
                            {"beam_error_db", data.beam_error_db},
                            {"beam_error_bounded", data.beam_error_bounded},
                            {"sure_pct", 100.0 * sure},
                            {"sure_db", sure_db},
                            {"tl_db", loss},
                            {"silent_pct", silent_pct(data.pressure.size(), tl.size())},
                            {"warnings", result.origin.warnings},
                            {"notes", result.notes}};
  return all.dump(1, ' ', false, ordered_json::error_handler_t::replace) + '\n';
}

}  // namespace asdic::detail::app
