#pragma once
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "study/expression/expression.h"
#include "study/plan/no_value.h"

namespace asdic::detail::study {

/// The column of [rare] event, and what its probability is called.
inline constexpr const char* rare_event_column = "rare_event";
inline constexpr const char* rare_event_probability = "p_event";

/// A comparison of what a row holds: "echo_to_background_db > 12".
struct RareEvent {
  std::string text;                    ///< as it stands
  Expression excess;                   ///< how far a row is beyond it; below 0: it has not happened
  bool at_zero = false;                ///< whether it has at 0: >=, <=
  std::vector<std::size_t> columns{};  ///< [excess.names()] of the row

  /// \param row  [columns of the study] \return NaN: not known
  [[nodiscard]] double excess_of(std::span<const double> row) const {
    std::vector<double> values;
    for (const std::size_t column : columns) values.push_back(row[column]);
    return excess.at(values);
  }
  /// 1: it has happened, 0, NaN: not known.
  [[nodiscard]] double of(double beyond) const {
    if (std::isnan(beyond)) return no_value;
    return beyond > 0.0 || (at_zero && beyond == 0.0) ? 1.0 : 0.0;
  }
};

/// [rare]: what is asked for that seldom happens, and from where it is drawn.
struct RarePlan {
  std::optional<RareEvent> event{};
  double share = 0.1;  ///< of the rows that are drawn from the inputs' own laws
  double wide = 0.2;   ///< of those whose normal scores scatter `spread` times as far
  double spread = 3.0;
  bool has_components = false;  ///< [[rare.component]]
  int levels = 12;              ///< of --adapt, at most
  int rows_per_level = 500;
};

}  // namespace asdic::detail::study
