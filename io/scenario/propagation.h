#pragma once
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "core/fields.h"
#include "core/memory_budget.h"
#include "io/text/toml_table.h"
#include "raytrace/cases/propagation_case.h"

namespace asdic::detail {

/// A run of the propagation model as a scenario file describes it: [environment] and [run]
/// (docs/formats/scenario.md). A whole sonar scenario will do: its ocean is used, in the plane that
/// leaves the platform along the transect, and the platform's depth and the pulse's frequency
/// stand where [run] gives none.
/// \param notes  grows by what the reader did that the user should know
/// \throws InputError "FILE:LINE: run.beams.kind: found X, expected Y" at the first fault
[[nodiscard]] PropagationCase read_propagation_case(const std::filesystem::path& path,
                                                    std::span<const std::string> overrides,
                                                    std::vector<std::string>& notes);

/// The same for text in memory. \param path  named in messages; files that the text names are
/// relative to its folder
[[nodiscard]] PropagationCase parse_propagation_case(std::string_view text,
                                                     const std::filesystem::path& path,
                                                     std::span<const std::string> overrides,
                                                     std::vector<std::string>& notes);

/// The same of a tree that was read before, with its includes and overrides in it.
/// \param noted  if not null, grows by every setting that was read
[[nodiscard]] PropagationCase propagation_case_of(const TomlValue& document,
                                                  const std::filesystem::path& path,
                                                  std::vector<std::string>& notes,
                                                  NotedSettings* noted = nullptr);

/// The budget that run.memory of a file, sonar's or not, sets; the default where it says nothing.
[[nodiscard]] MemoryBudget read_budget(const std::filesystem::path& path,
                                       std::span<const std::string> overrides);
/// The same of a tree that was read before. \param otherwise  where it says nothing
[[nodiscard]] MemoryBudget budget_of(const TomlValue& document, MemoryBudget otherwise = {});

/// Whether a file describes a sonar: it has a [platform], or no [run] either.
[[nodiscard]] bool has_sonar(const std::filesystem::path& path,
                             std::span<const std::string> overrides);

/// The same of a tree that was read before.
[[nodiscard]] bool has_sonar(const TomlValue& document);

/// Whether [run] of a file asks for rays or eigenrays: it names that task.
[[nodiscard]] bool asks_for_rays(const std::filesystem::path& path,
                                 std::span<const std::string> overrides);

/// A fault that a run found in a case, told of the file it came from: "source_depths[0]" is
/// "FILE:LINE: run.source.depth[0]".
[[nodiscard]] InputError told_of_scenario(const InputError& error,
                                          const std::filesystem::path& path,
                                          std::span<const std::string> overrides);

/// The same of a tree that was read before, of a file at `path`.
[[nodiscard]] InputError told_of_scenario(const InputError& error, const TomlValue& document,
                                          const std::filesystem::path& path);

// How a task, a kind of field, beam or source is called in a file and in messages.
inline constexpr std::string_view task_words[] = {"rays", "eigenrays", "arrivals",
                                                  "eigenrays-and-arrivals", "field"};
inline constexpr std::string_view field_kind_words[] = {"coherent", "incoherent", "semi-coherent"};
inline constexpr std::string_view field_solver_words[] = {"auto", "beams", "waves"};
inline constexpr std::string_view beam_kind_words[] = {"hat",
                                                       "gaussian",
                                                       "ray-centred-hat",
                                                       "ray-centred-gaussian",
                                                       "simple-gaussian",
                                                       "cerveny-cartesian",
                                                       "cerveny-ray-centred"};
inline constexpr std::string_view source_kind_words[] = {"point", "line"};
inline constexpr std::string_view width_words[] = {"space-filling", "minimum", "wkb", "cerveny"};
inline constexpr std::string_view curvature_words[] = {"standard", "doubled", "zero"};
inline constexpr std::string_view component_words[] = {"pressure", "vertical", "horizontal"};

constexpr std::span<const std::string_view> words(Task) { return task_words; }
constexpr std::span<const std::string_view> words(FieldKind) { return field_kind_words; }
constexpr std::span<const std::string_view> words(FieldSolver) { return field_solver_words; }
constexpr std::span<const std::string_view> words(BeamKind) { return beam_kind_words; }
constexpr std::span<const std::string_view> words(SourceKind) { return source_kind_words; }
constexpr std::span<const std::string_view> words(CervenyBeams::Width) { return width_words; }
constexpr std::span<const std::string_view> words(CervenyBeams::Curvature) {
  return curvature_words;
}
constexpr std::span<const std::string_view> words(CervenyBeams::Component) {
  return component_words;
}

namespace scenario {

/// run.memory [bytes], which is of a process and of no case.
void describe_memory(Fields& field, double& bytes);
/// The same out of a file; 0 where it is not given.
[[nodiscard]] double read_memory(TomlTable& table);

/// [run] and its tables: all of a case but its title and its ocean. The case brings the ocean, and
/// a frequency and source depths for where none are given (no depths: they are required).
struct RunTable {
  PropagationCase& run;
  void describe(Fields& field);
};

/// A RunTable out of a file, with run.memory, which is of the process and not of the run.
void read_run(TomlTable table, PropagationCase& run_case);

}  // namespace scenario
}  // namespace asdic::detail
