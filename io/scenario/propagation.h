#pragma once
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "core/memory_budget.h"
#include "io/text/toml_table.h"
#include "raytrace/cases/propagation_case.h"

namespace asdic {

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

/// The budget that run.memory of a file, sonar's or not, sets; the default where it says nothing.
[[nodiscard]] MemoryBudget read_budget(const std::filesystem::path& path,
                                       std::span<const std::string> overrides);
/// The same of a tree that was read before. \param otherwise  where it says nothing
[[nodiscard]] MemoryBudget budget_of(const TomlValue& document, MemoryBudget otherwise = {});

/// Whether a file describes a sonar: it has a [platform], or no [run] either.
[[nodiscard]] bool has_sonar(const std::filesystem::path& path,
                             std::span<const std::string> overrides);

/// Whether [run] of a file asks for rays or eigenrays: it names that task.
[[nodiscard]] bool asks_for_rays(const std::filesystem::path& path,
                                 std::span<const std::string> overrides);

/// A fault that a run found in a case, told of the file it came from: "source_depths[0]" is
/// "FILE:LINE: run.source.depth[0]".
[[nodiscard]] InputError told_of_scenario(const InputError& error,
                                          const std::filesystem::path& path,
                                          std::span<const std::string> overrides);

/// How a task, a kind of field, beam or source is called in a file and in messages.
[[nodiscard]] std::string_view name(Task task) noexcept;
[[nodiscard]] std::string_view name(FieldKind kind) noexcept;
[[nodiscard]] std::string_view name(FieldSolver solver) noexcept;
[[nodiscard]] std::string_view name(BeamKind kind) noexcept;
[[nodiscard]] std::string_view name(SourceKind kind) noexcept;
[[nodiscard]] std::string_view name(CervenyBeams::Width width) noexcept;
[[nodiscard]] std::string_view name(CervenyBeams::Curvature curvature) noexcept;
[[nodiscard]] std::string_view name(CervenyBeams::Component component) noexcept;

namespace scenario {

/// `count` values from first to last, both included: what { first, last, count } stands for.
[[nodiscard]] std::vector<double> evenly_spaced(double first, double last, std::size_t count);

/// run.memory: bytes, or a text such as "4 GB" or "512 MiB"; 0 where it is not given.
[[nodiscard]] double read_memory(TomlTable& table);

/// [run] and its tables. `run_case` brings the environment, and a frequency and source depths for
/// where none are given (a frequency of 0, no depths: they are required).
void read_run(TomlTable table, PropagationCase& run_case);

}  // namespace scenario
}  // namespace asdic
