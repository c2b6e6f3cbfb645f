#pragma once
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "study/plan/measure_plan.h"
#include "study/plan/rare_plan.h"
#include "study/plan/summary_plan.h"
#include "study/sampling/clusters.h"
#include "study/sampling/correlation.h"
#include "study/sampling/design.h"
#include "study/sampling/proposal.h"
#include "study/sampling/variable.h"

namespace asdic::detail::study {

/// What becomes of a realisation whose drawn values make no scenario (a target below the bottom).
enum class OnError { stop, skip };

/// [correlation]: inputs that depend on one another by a Gaussian copula.
struct Correlation {
  std::vector<std::size_t> inputs{};  ///< which of the variables; none: all are independent
  bool of_ranks = false;              ///< the matrix was given as Spearman's
  Copula copula{};                    ///< of the inputs, in their order
};

/// A Monte Carlo study as plain data: a scenario, what varies in it, what is measured, what is made
/// of the measurements. docs/formats/study.md
struct Study {
  std::string title;
  std::uint64_t seed = 1;          ///< of designs and of every realisation's own streams
  std::uint64_t realisations = 0;  ///< indices 0 … realisations − 1
  Design design = Design::random;
  DesignOptions design_options{};
  OnError on_error = OnError::stop;
  std::vector<Variable> variables;  ///< [vary]
  Correlation correlation;          ///< [correlation]
  MeasurePlan measure;              ///< [measure]
  SummaryPlan summary;              ///< [summary]
  RarePlan rare{};                  ///< [rare]
  Proposal proposal{};              ///< from where inputs are drawn instead of their laws

  std::vector<std::string> until;  ///< [study] until, as --until takes each of them
  std::string until_where;         ///< "study.toml:7: study.until"

  TomlValue scenario;  ///< what the variables edit: with its include and the overrides in it
  TomlValue document;  ///< [study], [set], [vary], [correlation], [measure], [rare], [summary],
                       ///< with their overrides

  std::string scenario_text;            ///< of the scenario, verbatim
  std::filesystem::path scenario_path;  ///< where it was read; files it names are relative to it
  std::string text;                     ///< the study file, verbatim
  std::filesystem::path path;
  std::vector<std::string> overrides;  ///< "key.path=value"
  std::vector<std::string> warnings;   ///< what the reader met that the user should know
};

/// Whether rows are drawn from elsewhere than the inputs' laws, and so have weights.
[[nodiscard]] inline bool is_weighted(const Study& study) noexcept {
  return !study.proposal.empty();
}

/// Inputs that have one index together.
struct SaltelliGroup {
  std::string name;                    ///< "range", "wind_speed + depth"; "chance"
  std::vector<std::size_t> variables;  ///< none: what realisations draw beside their inputs
};
/// The groups of Saltelli's design: those of DesignOptions, every other entry of [vary] by itself,
/// and chance, if it is one. An entry that draws nothing is in none.
[[nodiscard]] std::vector<SaltelliGroup> saltelli_groups(const Study& study);
[[nodiscard]] SaltelliBlocks saltelli_blocks(const Study& study);

/// Which rows are not independent of one another.
[[nodiscard]] Clusters clusters_of(const Study& study);

/// "500 blocks of 8 realisations, …": what a design makes of its blocks or replicates and what that
/// costs; "" of designs without them.
[[nodiscard]] std::string design_text(const Study& study);

/// SHA-256 of all that decides the rows (seed, design, scenario with what it includes, variables,
/// measures, overrides), as hexadecimal text: parts with the same one belong together. How many
/// realisations are asked for enters only where the design depends on it (Latin hypercube);
/// the summary and on_error never do.
[[nodiscard]] std::string identity(const Study& study);

}  // namespace asdic::detail::study
