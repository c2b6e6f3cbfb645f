// Part of summary_parts.h: what is to be known of weights.
#include <cmath>
#include <cstdio>

#include "study/plan/no_value.h"
#include "study/summary/axis.h"
#include "study/summary/intervals.h"
#include "study/summary/summary_parts.h"
#include "study/summary/weighted_mean.h"

namespace asdic::detail::study {
namespace {

constexpr double few = 50.0;        // rows of an event, as many of one weight
constexpr double much = 0.1;        // of a probability, that one row has
constexpr double impossible = 5.0;  // standard errors
constexpr double seen = 10.0;  // rows of an event from the parts that guard: as many of a part of
                               // it that is as probable are missed once in 20 000 times

std::string in_digits(double x) {
  std::string text(32, ' ');
  text.resize(static_cast<std::size_t>(std::snprintf(text.data(), text.size(), "%.3g", x)));
  return text;
}

/// E[w] = 1, whatever is drawn from what.
std::string mean_weight_warning(const std::vector<double>& weights) {
  Moments moments;
  for (const double w : weights) moments.add(w);
  const double error = moments.deviation() / std::sqrt(moments.count());
  if (!(moments.count() > 100.0) || !(std::abs(moments.mean() - 1.0) > impossible * error))
    return "";
  return "weights: their mean is " + in_digits(moments.mean()) + " (+- " + in_digits(error) +
         "), expected 1: rows of large weight are missing, and probabilities with them";
}

/// What the rows of one part of the proposal have of an outcome.
struct FromPart {
  double rows = 0.0, of_event = 0.0, sum = 0.0;
};
/// \param outcome  0 or 1   \return [parts]
std::vector<FromPart> by_part(const Study& study, const Table& table,
                              const std::vector<double>& weights, std::size_t column,
                              double outcome) {
  std::vector<FromPart> parts(study.proposal.parts().size());
  const ColumnValues& from = table.values[column_of(table, drawn_from_column)];
  for (std::size_t row = 0; row < table.index.size(); ++row) {
    FromPart& part = parts[static_cast<std::size_t>(from[row])];
    part.rows += 1.0;
    if (!counts(table, row, column) || table.values[column][row] != outcome) continue;
    part.of_event += 1.0;
    part.sum += weights[row];
  }
  return parts;
}

}  // namespace

RowMeans::RowMeans(const Study& study, const Table& table)
    : table_(table), clusters_(clusters_of(study)), weights_(weights_of(table)) {}

RowMean RowMeans::in_cell(std::span<const std::size_t> rows, std::size_t column) const {
  RowMean mean(clusters_, weighted());
  for (const std::size_t row : rows)
    if (counts(table_, row, column))
      mean.add(table_.index[row], table_.values[column][row], weight(row));
  return mean;
}

RowMean RowMeans::of_column(std::size_t column) const {
  return of_all([&](std::size_t row) {
    return counts(table_, row, column) ? table_.values[column][row] : no_value;
  });
}

void add_worth(SummaryTable& to, const std::string& head) {
  add_column(to, {.unit = "1"}, head + "effective",
             "(sum of weights)^2 over sum of their squares, of the rows in which the rarer "
             "outcome happened");
  add_column(to, {.unit = "1"}, head + "largest_share",
             "of the rarer outcome's probability that one row alone has");
}

void put_worth(SummaryTable& to, const RowMean& mean) {
  put(to, {mean.weighted().effective_of_event(), mean.weighted().largest_share()});
}

std::vector<SummaryTable> drawn_from_table(const Study& study, const Table& table) {
  const std::optional<std::size_t> question = first_question(table.columns);
  if (!question || !is_proportion(table.columns[*question]) ||
      column_of(table, drawn_from_column) >= table.columns.size())
    return {};
  const auto parts = by_part(study, table, weights_of(table), *question, 1.0);
  SummaryTable made{.name = "drawn_from",
                    .title = "Parts of the proposal, and what of " +
                             proportion_name(table.columns[*question]) + " their rows found",
                    .axes = {"part"}};
  add_column(made, {.unit = "1"}, "part", "of the proposal");
  add_column(made, {.unit = "1"}, "share", "of the rows, as it is set");
  add_column(made, {.unit = "1"}, "count", "rows");
  add_column(made, {.unit = "1"}, "hits", "of them, those of the event");
  add_column(made, {.unit = "1"}, "share_of_event", "of the sum of the event's weights");
  double all = 0.0;
  for (const FromPart& part : parts) all += part.sum;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    made.columns[0].labels.push_back(study.proposal.parts()[k].name);
    put(made, {static_cast<double>(k), study.proposal.parts()[k].share, parts[k].rows,
               parts[k].of_event, parts[k].sum / all});
  }
  return {made};
}

std::vector<std::string> weight_warnings(const Study& study, const Table& table) {
  const std::vector<double> weights = weights_of(table);
  const RowMeans means(study, table);
  std::vector<std::string> all;
  if (std::string one = mean_weight_warning(weights); !one.empty()) all.push_back(std::move(one));
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    if (!is_proportion(table.columns[c])) continue;
    const WeightedMean mean = means.of_column(c).weighted();
    if (!(mean.count() > 0.0)) continue;
    const std::string name = proportion_name(table.columns[c]);
    const std::string rows = in_digits(mean.rows_of_event());
    if (!(mean.rows_of_event() > 0.0))
      all.push_back(name + ": all " + in_digits(mean.count()) + " rows agree, which are worth " +
                    in_digits(mean.effective()) +
                    " of the inputs' own laws: the proposal does not reach what is rare");
    else if (mean.effective_of_event() < few || mean.largest_share() > much)
      all.push_back(name + ": its " + rows + " rows of the rarer outcome are worth " +
                    in_digits(mean.effective_of_event()) + " of equal weight (expected " +
                    in_digits(few) + " or more), and one has " +
                    in_digits(100.0 * mean.largest_share()) +
                    " % of the sum: the interval may miss more often than it says. More rows, or "
                    "a proposal that reaches all of the event");
    if (column_of(table, drawn_from_column) >= table.columns.size()) continue;
    const bool rare = mean.probability() < 0.5;
    const auto parts = by_part(study, table, weights, c, rare ? 1.0 : 0.0);
    double guards = 0.0;
    for (std::size_t k = 0; k < parts.size(); ++k)
      if (study.proposal.parts()[k].guards) guards += parts[k].of_event;
    if (mean.rows_of_event() > 0.0 && guards < seen)
      all.push_back(name +
                    ": of the rows that guard against what the proposal misses (laws, "
                    "wide), " +
                    in_digits(guards) + " reached the event (expected " + in_digits(seen) +
                    " or more): another part of it, as probable, may be unseen and is not in the "
                    "interval. More rows, or a larger rare.wide or rare.spread");
  }
  return all;
}

}  // namespace asdic::detail::study
