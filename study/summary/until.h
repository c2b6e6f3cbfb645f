#pragma once
#include <functional>
#include <map>
#include <optional>

#include "study/sampling/index_set.h"
#include "study/summary/summary.h"

namespace asdic::detail::study {

/// When a study has seen enough: the confidence interval of its first answer is as narrow as asked
/// for, looked at after fixed numbers of realisations only, those with one digit that is not 0,
/// from 100 on: 100, 200, … 1000, 2000, … So the number at which it stops depends on the rows
/// alone, not on who made them when; and there are few looks, each of which is a chance to stop by
/// luck.
[[nodiscard]] bool is_look(std::uint64_t count) noexcept;

/// Feeds an estimate with rows in the order of their indices, in whatever order they come, and says
/// when to stop. Keeps rows only while an earlier one is missing.
class OrderedEstimate {
 public:
  /// \param first       the first index
  /// \param half_width  of the confidence interval to stop at, in the unit of the estimate
  OrderedEstimate(RunningEstimate estimate, std::uint64_t first,
                  std::optional<double> half_width = {});

  void add(Row row);

  /// Of the rows without a gap from the first.
  [[nodiscard]] std::optional<Estimate> estimate() const { return estimate_.estimate(); }
  /// How many realisations are enough, once that is known. Later rows no longer count.
  [[nodiscard]] std::optional<std::uint64_t> enough() const noexcept { return enough_; }
  /// Of these rows, those that were skipped.
  [[nodiscard]] std::uint64_t skipped() const noexcept { return skipped_; }
  [[nodiscard]] const std::string& name() const noexcept { return estimate_.name(); }
  /// Of these rows, those that are valid and tell nothing of the estimate.
  [[nodiscard]] std::uint64_t left_out() const noexcept { return estimate_.left_out(); }
  [[nodiscard]] std::uint64_t waiting() const noexcept { return waiting_.size(); }

 private:
  void take(const Row& row);

  RunningEstimate estimate_;
  std::uint64_t first_, next_, skipped_ = 0;
  std::optional<double> half_width_;
  std::optional<std::uint64_t> enough_;
  std::map<std::uint64_t, Row> waiting_;  // rows after a gap, without their time series
};

/// \throws InputError ("--until") for designs whose points depend on how many there are
void check_until(const Study& study);

}  // namespace asdic::detail::study
