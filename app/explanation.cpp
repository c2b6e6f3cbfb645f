#include "app/explanation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>

#include "core/error.h"
#include "io/bellhop/results.h"
#include "io/files/input_file.h"
#include "io/result/result_file.h"

namespace asdic::detail::app {
namespace {

using bellhop::ArrivalsFile;
using bellhop::RayFile;
using bellhop::ShadeFile;

/// The answer of a run as BELLHOP's files hold it.
PropagationFile file_of(const PropagationCase& run_case, const PropagationResult& result) {
  switch (run_case.task) {
    case Task::field:
      return bellhop::shade_file(run_case, result);
    case Task::arrivals:
    case Task::eigenrays_and_arrivals:
      return bellhop::arrivals_file(run_case, result, false);
    case Task::rays:
    case Task::eigenrays:
      break;
  }
  return bellhop::ray_file(run_case, result);
}

Comparison compare_files(const PropagationFile& a, const PropagationFile& b, Task task) {
  if (const auto* field = std::get_if<ShadeFile>(&a))
    return compare::compare_fields(*field, std::get<ShadeFile>(b));
  if (const auto* arrivals = std::get_if<ArrivalsFile>(&a))
    return compare::compare_arrivals(*arrivals, std::get<ArrivalsFile>(b));
  // an eigenray of BELLHOP is a ray of its fan: near the exact one in angle, not at it
  const compare::RayOptions options{.angle_deg = task == Task::eigenrays ? 0.1 : 1e-6};
  return compare::compare_rays(std::get<RayFile>(a), std::get<RayFile>(b), options);
}

std::string name_of(BeamKind kind) {
  switch (kind) {
    case BeamKind::hat:
      return "hat beams";
    case BeamKind::gaussian:
      return "Gaussian beams";
    case BeamKind::ray_centred_hat:
      return "ray-centred hat beams";
    case BeamKind::ray_centred_gaussian:
      return "ray-centred Gaussian beams";
    case BeamKind::simple_gaussian:
      return "simple Gaussian beams";
    case BeamKind::cerveny_cartesian:
      return "Cerveny beams";
    case BeamKind::cerveny_ray_centred:
      break;
  }
  return "ray-centred Cerveny beams";
}

std::string kind_of(const PropagationCase& c) {
  switch (c.task) {
    case Task::rays:
      return "rays";
    case Task::eigenrays:
      return "eigenrays, " + name_of(c.beams.kind);
    case Task::arrivals:
    case Task::eigenrays_and_arrivals:
      return "arrivals, " + name_of(c.beams.kind);
    case Task::field:
      break;
  }
  const char* field = c.field == FieldKind::coherent     ? "coherent"
                      : c.field == FieldKind::incoherent ? "incoherent"
                                                         : "semi-coherent";
  return fmt::format("{} field, {}", field, name_of(c.beams.kind));
}

const char* extension_of(Task task) {
  switch (task) {
    case Task::field:
      return ".shd";
    case Task::arrivals:
    case Task::eigenrays_and_arrivals:
      return ".arr";
    case Task::rays:
    case Task::eigenrays:
      break;
  }
  return ".ray";
}

/// Runs of one case in turn, with a common progress.
class Runs {
 public:
  Runs(const PropagationCase& run_case, int count, const Progress& progress)
      : case_(run_case), count_(count), progress_(progress) {}

  PropagationFile bellhop_emulation(const BellhopEmulationOptions& options,
                                    std::size_t* beams = nullptr) {
    const PropagationResult result = run_bellhop_emulation(case_, options, next());
    if (beams != nullptr) *beams = result.beams;
    return file_of(case_, result);
  }
  PropagationFile own() { return file_of(case_, run(case_, next())); }

 private:
  Progress next() {
    const double begin = static_cast<double>(done_++) / count_;
    return [this, begin](double share) { return !progress_ || progress_(begin + share / count_); };
  }
  const PropagationCase& case_;
  int count_, done_ = 0;
  const Progress& progress_;
};

double step_of(const PropagationCase& c) {
  if (c.literal.step > 0.0) return c.literal.step;
  return 0.1 * (c.environment.bottom.depth - c.environment.surface.depth);
}

/// Who wrote the results that a .prt goes with: asdic signs the first line of its own.
Explanation::OnDisk::Writer writer_of(const std::filesystem::path& prt) {
  using Writer = Explanation::OnDisk::Writer;
  std::error_code unknown;
  if (!std::filesystem::is_regular_file(prt, unknown)) return Writer::unknown;
  std::istringstream text(read_input(prt, "what a run has printed"));
  if (text.view().empty()) return Writer::unknown;
  if (!text.view().starts_with("asdic ")) return Writer::bellhop;
  for (std::string line; std::getline(text, line);)
    if (line.starts_with("traced") && line.find("as BELLHOP does") != std::string::npos)
      return Writer::asdic_bellhop_emulation;
  return Writer::asdic;
}

}  // namespace

Explanation explain(const bellhop::Input& input, const std::filesystem::path& root,
                    const ExplainOptions& options, const Progress& progress) {
  const PropagationCase& c = input.run_case;
  Explanation e{.title = c.title, .kind = kind_of(c), .frequency = c.frequency, .step = step_of(c)};
  e.notes = input.notes;
  const bool has_rows = c.task == Task::arrivals || c.task == Task::eigenrays_and_arrivals;
  const bool single = c.task == Task::field || has_rows;
  const bool fan = c.task != Task::rays;
  Runs runs(c, 3 + (fan ? 1 : 0) + (has_rows ? 1 : 0) + (single ? 1 : 0) + 1, progress);

  const PropagationFile asked = runs.bellhop_emulation({}, &e.beams);
  BellhopEmulationOptions best;
  const auto improve = [&](const std::string& name, const std::string& setting,
                           const BellhopEmulationOptions& changed) {
    e.effects.push_back(
        {name, setting, compare_files(asked, runs.bellhop_emulation(changed), c.task)});
  };
  best.step = e.step / options.finer_step;
  improve("step", fmt::format("{:.4g} m -> {:.4g} m", e.step, *best.step), {.step = best.step});
  if (fan) {
    best.beams = static_cast<int>(options.denser_fan * (static_cast<double>(e.beams) - 1.0)) + 1;
    improve("number of beams", fmt::format("{} -> {}", e.beams, *best.beams),
            {.beams = best.beams});
  }
  if (has_rows) {
    best.merge = false;
    improve("merging", "with the last row -> none", {.merge = false});
  }
  if (single) {
    best.single_precision = false;
    improve("single precision", "float32 -> float64", {.single_precision = false});
  }
  const PropagationFile improved = runs.bellhop_emulation(best);
  PropagationFile truth = improved;
  try {
    truth = runs.own();
    e.truth = "asdic's own tracer";
    e.rest =
        Effect{"what remains", "all of these -> the truth", compare_files(improved, truth, c.task)};
  } catch (const InputError& error) {
    e.truth = "BELLHOP's own way with all of these improved";
    e.notes.push_back(std::string("asdic's own run: ") +
                      bellhop::told_of_file(error, input).what());
  }
  e.total = compare_files(asked, truth, c.task);

  std::filesystem::path stem = root;
  if (stem.extension() == ".env") stem.replace_extension();
  const std::filesystem::path file = stem.string() + extension_of(c.task);
  if (std::filesystem::exists(file)) {
    try {
      const PropagationFile old = read_result(file);
      e.on_disk =
          Explanation::OnDisk{file.string(), writer_of(stem.string() + ".prt"),
                              compare_files(old, asked, c.task), compare_files(old, truth, c.task)};
    } catch (const InputError& error) {
      e.notes.push_back(fmt::format("{}: not compared: {}", file.string(), error.what()));
    } catch (const std::bad_variant_access&) {
      e.notes.push_back(file.string() + ": not compared: another kind of result");
    }
  }
  for (const std::string& leak : input.leaks)
    e.advice.push_back("look at the input first: " + leak +
                       "; what follows holds for the case as it is read, not for one that was "
                       "meant otherwise");
  for (std::string& line : advice_on(e)) e.advice.push_back(std::move(line));
  return e;
}

}  // namespace asdic::detail::app
