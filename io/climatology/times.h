#pragma once
#include <optional>
#include <string>
#include <vector>

#include "io/climatology/data_grid.h"

// Which time steps of which files stand for the time that a user asks for.
namespace asdic::detail {

/// When: of a date, of a month of every year, or the mean of all times that the data have.
struct OceanTime {
  std::optional<int> month{};    ///< 1..12
  std::optional<Moment> date{};  ///< rules, where it is given
  /// "2024-02-29", "month 3", "mean of all times"
  [[nodiscard]] std::string text() const;
};

namespace climatology {

/// Steps of files on the same axes, weighted; the weights add up to 1.
struct TimeChoice {
  struct Part {
    std::size_t file, step;
    double weight;
  };
  std::vector<Part> parts{};
  std::string said{};  ///< what was averaged or interpolated: "mean of 31 steps, 2024-01-01 to …"
  int fit = 0;         ///< 0 the time asked for, 1 its season, 2 the year, 3 the data tell no time
};

/// By the times of the axes, never by their number: 24 hourly steps are a day. A date is
/// interpolated between the steps about it, in the year where the data are of every year; what lies
/// further from all of them than a month is refused. \throws InputError that says which times there
/// are
[[nodiscard]] TimeChoice choose_steps(const std::vector<DataGrid>& files, const OceanTime& when);

}  // namespace climatology
}  // namespace asdic::detail
