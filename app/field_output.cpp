#include "app/field_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/console.h"
#include "io/compare/statistics.h"
#include "io/hdf5/environment_group.h"
#include "io/scenario/propagation.h"
#include "raytrace/cases/beam_error_text.h"

namespace asdic::detail::app {
namespace {

std::string receivers_text(const ReceiverGrid& grid) {
  return grid.irregular
             ? count_of(grid.ranges.size(), "receiver")
             : fmt::format("{} depths x {} ranges", grid.depths.size(), grid.ranges.size());
}

}  // namespace

std::string loss_text(const std::vector<std::complex<float>>& pressure) {
  const std::vector<double> tl = losses_of(pressure);
  if (tl.empty()) return "loss       no sound at 100 %\n";
  return fmt::format("loss       {} to {} dB, median {} dB; no sound at {:.3g} %\n",
                     number(tl.front(), 1), number(tl.back(), 1),
                     number(compare::quantile(tl, 0.5), 1), silent_pct(pressure.size(), tl.size()));
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

}  // namespace asdic::detail::app
