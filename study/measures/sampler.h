#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "core/error.h"
#include "io/text/toml_value.h"
#include "sonar/scenario/scenario.h"
#include "study/measures/realisation.h"
#include "study/plan/study.h"
#include "study/sampling/design.h"

namespace asdic::detail::study {

/// Draws the inputs of realisations and writes them into scenarios.
class Sampler {
 public:
  explicit Sampler(const Study& study);

  /// The columns of the inputs, in the order of [vary]; last weight and part of rows that
  /// are drawn from a proposal.
  [[nodiscard]] const std::vector<Column>& columns() const noexcept { return columns_; }

  /// What one realisation draws: the values of the columns, and which of its values each choice is.
  struct Drawn {
    std::vector<double> values;        ///< [columns]
    std::vector<std::size_t> choices;  ///< [variables] 0 for those without choices
  };
  [[nodiscard]] Drawn draw(std::uint64_t index) const;
  /// The same of a point that is not the design's. \param u  [dimensions()] each in (0, 1), before
  /// the correlation of inputs, but as a proposal has drawn it
  /// \param from  as the proposal has drawn it
  [[nodiscard]] Drawn draw(std::uint64_t index, std::span<const double> u,
                           const Proposal::Drawn& from = {}) const;
  /// Coordinates of the inputs.
  [[nodiscard]] std::size_t dimensions() const noexcept {
    return design_.dimensions() - proposal_.dimensions();
  }
  /// The point of a realisation, as the proposal has drawn it. \param u  [dimensions()]
  Proposal::Drawn point(std::uint64_t index, std::span<double> u) const;
  /// What tells the realisation's own draws (noise, scatterers) from those of others.
  [[nodiscard]] std::uint64_t chance_of(std::uint64_t index) const noexcept {
    return design_.chance_of(index);
  }

  /// Puts the drawn values where their keys lead. \throws InputError if a path leads nowhere
  void apply(const Drawn& drawn, TomlValue& scenario) const;

  /// "range = 12000, wind_speed = 3.5": for messages.
  [[nodiscard]] std::string describe(const Drawn& drawn) const;

 private:
  bool on_grid_;
  std::vector<Variable> variables_;
  Correlation correlation_;
  Proposal proposal_;
  std::vector<std::size_t> first_column_;        // [variables + 1]
  std::vector<std::size_t> first_dimension_;     // [variables]
  std::vector<std::vector<std::size_t>> given_;  // [variables] columns that each looks at
  std::vector<std::size_t> order_;               // in which they are drawn
  std::vector<Column> columns_;
  PointDesign design_;
};

/// Points of the grid: the product of the numbers of values of all choices.
[[nodiscard]] std::uint64_t grid_points(const std::vector<Variable>& variables);

/// The scenario of the first realisation that makes one: what all of them have in common (targets,
/// phones) can be seen in it. \throws InputError of realisation 0, if it stops the study or none of
/// the first hundred makes a scenario
[[nodiscard]] Scenario example_of(const Study& study);

/// A fault of a realisation's scenario, with what was drawn. \param file  of the scenario, for
/// faults that name none
[[nodiscard]] InputError told(const InputError& error, const std::filesystem::path& file,
                              std::uint64_t index, const std::string& drawn);

}  // namespace asdic::detail::study
