#pragma once
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "study/expression/expression.h"
#include "study/plan/no_value.h"
#include "study/sampling/clusters.h"
#include "study/sampling/index_set.h"
#include "study/summary/summary.h"

namespace asdic::detail::study {

/// After how many realisations a study looks whether it has seen enough: fixed numbers, so that
/// where it stops depends on the rows alone, not on who made them when; and few of them, for each
/// look is a chance to stop by luck. Of rows by themselves those with one digit that is not 0, from
/// 100 on: 100, 200, … 1000, 2000, …; of blocks as many blocks; of R replicates R·2^j and 3R·2^j,
/// from 100 on.
[[nodiscard]] bool is_look(std::uint64_t count, const Clusters& clusters = {}) noexcept;

/// How many of these looks there are up to a number of realisations, and that number itself.
[[nodiscard]] std::uint64_t looks_until(std::uint64_t count, const Clusters& clusters = {});

/// At which confidence rules are looked at, so that what holds at any of the study's looks is wrong
/// no more often than the confidence of the summary says: 1 − (1 − confidence)/looks (Bonferroni).
[[nodiscard]] double confidence_of_rules(const Study& study);

/// What has to be known, and how well.
struct UntilTarget {
  std::string name;                  ///< "pd", "pd_by_range", "total_order"; "": the first question
  double half_width = 0.0;           ///< of its widest confidence interval, at most …
  std::optional<Expression> rule{};  ///< … or what has to hold of it, in every bin
  // Where it stands:
  std::string column{};             ///< of the table of rows: a measure
  std::vector<SummaryAxis> axes{};  ///< of a table along them; none: the mean of all rows
  bool over_map = false;            ///< of the cells of [summary.map]
  std::string index{};  ///< "first_order", …: an index of sensitivity; "": none of these
  std::string shown{};  ///< its column in those tables

  [[nodiscard]] bool has_table() const noexcept {
    return !index.empty() || !axes.empty() || over_map;
  }
};

/// "0.05", "pd_by_range=0.1", "pd: low > 0.9 || high < 0.9", "low > 0.9": a target of which name
/// and half-width, or rule, are known. \param where  for messages \throws InputError
[[nodiscard]] UntilTarget parse_until(const std::string& text, const std::string& where);
/// What rules may name: "half_width", "high", …
[[nodiscard]] const std::vector<std::string>& names_of_rules();
/// What they are of. \return whether the rule holds; false where something is not known
struct RuleValues {
  double mean = 0.0, low = 0.0, high = 0.0, rows = 0.0;
};
[[nodiscard]] bool holds(const Expression& rule, const RuleValues& values);

/// What a program decides by itself: whether these rows, with their answer_columns(), are enough.
using EnoughRows = std::function<bool(const Table& rows)>;

/// When a study has seen enough: all of its targets are known as well as asked for.
class Until {
 public:
  Until() = default;
  /// Of the first question.
  Until(double half_width) : targets_{{.half_width = half_width}} {}  // NOLINT: as it is written
  /// \param texts  "0.05", "pd_by_range=0.1", as of --until
  /// \param where  of them, for messages   \param own  looked at besides
  /// \throws InputError
  Until(const Study& study, const std::vector<std::string>& texts,
        const std::string& where = "--until", EnoughRows own = {});

  explicit operator bool() const noexcept { return has_value(); }
  [[nodiscard]] bool has_value() const noexcept { return !targets_.empty() || own_; }
  [[nodiscard]] const std::vector<UntilTarget>& targets() const noexcept { return targets_; }
  [[nodiscard]] const EnoughRows& own() const noexcept { return own_; }
  /// What of a study its tables take; none where they take nothing but the first question.
  [[nodiscard]] const std::shared_ptr<const Study>& study() const noexcept { return study_; }
  /// The same, with the confidence of rules.
  [[nodiscard]] const std::shared_ptr<const Study>& of_rules() const noexcept { return of_rules_; }
  /// "--until 0.05 --until pd_by_range=0.1".
  [[nodiscard]] std::string text() const;

 private:
  std::vector<UntilTarget> targets_;
  std::shared_ptr<const Study> study_, of_rules_;
  EnoughRows own_;
};

/// How well a target is known.
struct Known {
  std::string name;
  double half_width = infinity;  ///< of its widest interval; infinite: one is not known at all
  double asked = 0.0;
  std::string where;   ///< the widest: "range 12500"; "": there is one alone
  std::string rule{};  ///< in place of a half-width; `where` is one for which it does not hold
  bool holds = false;
  RuleValues values{};               ///< of a rule without bins, or there
  double rows = no_value;            ///< realisations there, of bins and cells; NaN: of neither
  std::size_t cells = 0, empty = 0;  ///< of a map, and those without a realisation
  [[nodiscard]] bool enough() const noexcept { return rule.empty() ? half_width <= asked : holds; }
};

/// Feeds an estimate with rows in the order of their indices, in whatever order they come, and says
/// when to stop. Keeps rows only while an earlier one is missing; for targets along axes and of
/// sensitivity, the columns that they take.
class OrderedEstimate {
 public:
  /// \param first  the first index
  /// \param until  what to stop at
  OrderedEstimate(RunningEstimate estimate, std::uint64_t first, const Until& until = {});

  void add(Row row);

  /// Of the rows without a gap from the first.
  [[nodiscard]] std::optional<Estimate> estimate() const { return estimate_.estimate(); }
  /// How many realisations are enough, once that is known. Later rows no longer count.
  [[nodiscard]] std::optional<std::uint64_t> enough() const noexcept { return enough_; }
  /// How well each target is known by these rows.
  [[nodiscard]] std::vector<Known> known() const;
  /// Of these rows, those that were skipped.
  [[nodiscard]] std::uint64_t skipped() const noexcept { return skipped_; }
  [[nodiscard]] const std::string& name() const noexcept { return estimate_.name(); }
  /// Of these rows, those that are valid and tell nothing of the estimate.
  [[nodiscard]] std::uint64_t left_out() const noexcept { return estimate_.left_out(); }
  /// Reason why the answer is not known in the first of these rows; "": none was given.
  [[nodiscard]] const std::string& unknown() const noexcept { return estimate_.unknown(); }
  [[nodiscard]] std::uint64_t waiting() const noexcept { return waiting_.size(); }

 private:
  void take(const Row& row);
  /// The tables that tell of a target; none of a mean of all rows.
  [[nodiscard]] std::vector<SummaryTable> tables_of(const Study& study,
                                                    const UntilTarget& target) const;
  [[nodiscard]] Known known(const UntilTarget& target, std::size_t mean) const;
  [[nodiscard]] Known known_rule(const UntilTarget& target, std::size_t mean) const;
  [[nodiscard]] bool all_enough() const;

  RunningEstimate estimate_;
  std::uint64_t first_, next_, skipped_ = 0;
  Until until_;
  struct Mean {
    std::size_t column = 0;
    bool proportion = false;
    RowMean of;
  };
  std::vector<Mean> means_;         // [targets] of their columns
  std::size_t weight_ = 0;          // column of the weights; as many as there are: none
  std::vector<std::size_t> taken_;  // columns that rows_ holds
  Table rows_;
  OwnValues own_;
  std::optional<std::uint64_t> enough_;
  std::map<std::uint64_t, Row> waiting_;  // rows after a gap, without their time series
};

/// \throws InputError for designs whose points depend on how many there are
void check_until(const Study& study, const std::string& where = "--until");

}  // namespace asdic::detail::study
