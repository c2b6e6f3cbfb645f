#pragma once
#include <cmath>
#include <functional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "study/measures/sampler.h"
#include "study/summary/summary.h"

namespace asdic::detail::support {

/// A study whose measure is a function of what its sampler draws, instead of a simulation: what its
/// tables say can be held against closed forms.
struct FunctionStudy {
  study::Study study{};
  /// \param values  of the inputs' columns \param chance  uniform, of the realisation's own draws
  std::function<double(std::span<const double> values, double chance)> of{};
  std::string measure = "level_db";  ///< "detected": a proportion
  bool chance_by_row = false;        ///< as if rows of a block had draws of their own

  /// An input that is uniform between two numbers.
  static study::Variable uniform(const std::string& name, double low, double high) {
    return {.name = name,
            .keys = {name},
            .origin = "",
            .law = study::NumberLaw{study::CutLaw(study::Uniform{low, high})}};
  }

  [[nodiscard]] study::Table table() const {
    const study::Sampler sampler(study);
    study::Table made{.columns = sampler.columns(), .index = {}, .valid = {}, .values = {}};
    made.columns.push_back({.name = measure, .unit = "1", .meaning = "of the inputs"});
    made.values.resize(made.columns.size());
    for (std::uint64_t i = 0; i < study.realisations; ++i) {
      const study::Sampler::Drawn drawn = sampler.draw(i);
      const double chance =
          study::uniform_draw(study.seed + 77, chance_by_row ? i : sampler.chance_of(i), 0);
      made.index.push_back(i);
      made.valid.push_back(1);
      for (std::size_t c = 0; c < drawn.values.size(); ++c)
        made.values[c].push_back(drawn.values[c]);
      made.values.back().push_back(of(drawn.values, chance));
    }
    return made;
  }
};

/// A table of a summary, by name. \throws std::runtime_error
inline const study::SummaryTable& table_named(const std::vector<study::SummaryTable>& tables,
                                              const std::string& name) {
  for (const study::SummaryTable& table : tables)
    if (table.name == name) return table;
  throw std::runtime_error("no table " + name);
}

inline const std::vector<double>& column_named(const study::SummaryTable& table,
                                               const std::string& name) {
  for (std::size_t c = 0; c < table.columns.size(); ++c)
    if (table.columns[c].name == name) return table.values[c];
  throw std::runtime_error("no column " + name);
}

/// How often an interval held the truth, and how wide it was beside the estimates' own scatter.
struct Coverage {
  int count = 0, held = 0;
  double width = 0.0, sum = 0.0, squares = 0.0;
  void add(double estimate, double low, double high, double truth) {
    ++count;
    held += low <= truth && truth <= high;
    width += high - low;
    sum += estimate;
    squares += estimate * estimate;
  }
  [[nodiscard]] double mean() const { return sum / count; }
  [[nodiscard]] double deviation() const {
    return std::sqrt(std::max(0.0, squares / count - mean() * mean()));
  }
  /// Half of the mean width in standard deviations of the estimate: 1.96 of a normal one.
  [[nodiscard]] double half_width() const { return 0.5 * width / count / deviation(); }
  /// Fewer than these have a chance of 10⁻⁶ where the interval covers `level`.
  [[nodiscard]] int least(double level = 0.95) const {
    return int(std::floor(level * count - 4.8 * std::sqrt(count * level * (1.0 - level)) - 1.0));
  }
};

}  // namespace asdic::detail::support
