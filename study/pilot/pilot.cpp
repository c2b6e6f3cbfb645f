#include "study/pilot/pilot.h"

#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/error.h"
#include "core/memory_budget.h"
#include "io/scenario/propagation.h"
#include "raytrace/parallel/stop.h"
#include "study/pilot/process_memory.h"
#include "study/reader/study_reader.h"
#include "study/summary/intervals.h"

namespace asdic::detail::study {
namespace {

/// Rows of one study, one after the other.
class Tries {
 public:
  Tries(const Study& study, const PilotOptions& options) : realiser_(study), options_(options) {}

  Row make(std::uint64_t index, RowCost& cost) const {
    Row row;
    until_stopped(options_.stop, [&] { row = realiser_.realise(index, &cost); });
    return row;
  }
  [[nodiscard]] double cost_of(std::span<const std::uint64_t> indices) const {
    double all = 0.0;
    for (const std::uint64_t index : indices) {
      RowCost cost;
      static_cast<void>(make(index, cost));
      all += cost.total;
    }
    return all;
  }

 private:
  Realiser realiser_;
  const PilotOptions& options_;
};

/// What some rows keep beside their columns, on the average over all [bytes].
class KeptBytes {
 public:
  explicit KeptBytes(const MeasurePlan& plan)
      : all_{{{.every = plan.series_every},
              {.every = plan.spectra_every},
              {.every = plan.detections_every}}} {}

  void add(const Row& row) {
    if (!row.pressure.empty())
      all_[0].add(static_cast<double>(row.pressure.size() * sizeof(float)));
    for (const KeptArray& array : row.kept)
      all_[array.name == spectra_kind().name ? 1 : 2].add(
          static_cast<double>((array.head.size() + array.values.size()) * sizeof(double)));
  }
  /// Of the kinds that were met.
  [[nodiscard]] double of_row() const {
    double sum = 0.0;
    for (const Kind& kind : all_)
      if (kind.rows > 0.0) sum += kind.bytes / kind.rows / static_cast<double>(kind.every);
    return sum;
  }
  [[nodiscard]] bool all_met() const {
    return std::all_of(all_.begin(), all_.end(),
                       [](const Kind& kind) { return kind.every == 0 || kind.rows > 0.0; });
  }

 private:
  struct Kind {
    std::uint64_t every = 0;
    double rows = 0.0, bytes = 0.0;
    void add(double more) {
      ++rows;
      bytes += more;
    }
  };
  std::array<Kind, 3> all_;
};

/// Inputs that go with the cost: by ranks, where they are told from none.
std::vector<CostDriver> drivers_of(const std::vector<Column>& columns, const std::vector<Row>& rows,
                                   const std::vector<double>& costs, double confidence,
                                   std::size_t& ordered) {
  struct Pair {
    const Column* input;
    std::vector<double> x, y;
  };
  std::vector<Pair> pairs;
  std::vector<CostDriver> all;
  for (std::size_t c = 0; c < columns.size(); ++c) {
    if (columns[c].role != Column::Role::input || !columns[c].labels.empty()) continue;
    std::vector<double> x, y;
    for (std::size_t k = 0; k < rows.size(); ++k)
      if (std::isfinite(rows[k].values[c])) {
        x.push_back(rows[k].values[c]);
        y.push_back(costs[k]);
      }
    if (x.size() < 5 ||
        *std::min_element(x.begin(), x.end()) == *std::max_element(x.begin(), x.end()))
      continue;
    pairs.push_back({&columns[c], std::move(x), std::move(y)});
  }
  ordered = pairs.size();
  // Of many inputs one would stand out by luck: all intervals together hold with the confidence.
  const double each = 1.0 - (1.0 - confidence) / std::max<double>(1.0, double(ordered));
  for (const Pair& pair : pairs) {
    const RankCorrelation rank = rank_correlation(ranks(pair.x), pair.y, each);
    if (rank.low > 0.0 || rank.high < 0.0) all.push_back({pair.input->name, rank});
  }
  std::sort(all.begin(), all.end(), [](const CostDriver& a, const CostDriver& b) {
    return std::abs(a.rank.value) > std::abs(b.rank.value);
  });
  return all;
}

/// Some rows, evenly from the cheapest to the dearest.
std::vector<std::uint64_t> across_costs(const std::vector<PilotRow>& rows, std::uint64_t count) {
  std::vector<const PilotRow*> sorted;
  for (const PilotRow& row : rows) sorted.push_back(&row);
  std::sort(sorted.begin(), sorted.end(),
            [](const PilotRow* a, const PilotRow* b) { return a->cost.total < b->cost.total; });
  const std::size_t taken = std::min<std::size_t>(count, sorted.size());
  std::vector<std::uint64_t> indices;
  for (std::size_t k = 0; k < taken; ++k)
    indices.push_back(sorted[(2 * k + 1) * sorted.size() / (2 * taken)]->index);
  std::sort(indices.begin(), indices.end());
  return indices;
}

/// Means over groups of rows that follow one another.
std::vector<double> by_group(const std::vector<double>& costs, std::uint64_t group) {
  std::vector<double> means;
  for (std::size_t k = 0; k + group <= costs.size(); k += group) {
    double sum = 0.0;
    for (std::size_t i = 0; i < group; ++i) sum += costs[k + i];
    means.push_back(sum / static_cast<double>(group));
  }
  return means;
}

}  // namespace

Pilot pilot(const Study& study, const PilotOptions& options) {
  const tbb::global_control alone(tbb::global_control::max_allowed_parallelism, 1);
  const Clusters clusters = clusters_of(study);
  Pilot made{.count = study.realisations,
             .group = clusters.kind == Clusters::Kind::blocks ? clusters.size : 1};
  const std::uint64_t groups =
      std::max<std::uint64_t>((options.rows + made.group - 1) / made.group, made.group > 1 ? 4 : 1);
  const std::vector<std::uint64_t> indices = rows_to_try(made.count, groups, made.group);
  if (indices.size() % made.group != 0) made.group = 1;
  const std::vector<Candidate> turns = candidates(study);
  const std::uint64_t changed = std::min<std::uint64_t>(options.changed, indices.size());
  const std::uint64_t steps = indices.size() + 1 + changed * (turns.size() + 2);
  std::uint64_t done = 0;
  const auto step = [&](std::uint64_t more) {
    done += more;
    if (options.progress) options.progress(done, steps);
  };

  std::vector<Row> rows;
  std::vector<double> costs, memory;
  RowCost first;  // with what a process does once: plans of transforms, pages of the program
  static_cast<void>(Tries(study, options).make(indices.front(), first));
  step(1);
  const Tries as_it_is(study, options);
  made.base_memory = resident_bytes();
  KeptBytes kept(study.measure);
  for (const std::uint64_t index : indices) {
    PilotRow row{.index = index};
    Row values;
    row.memory = taken_by([&] { values = as_it_is.make(index, row.cost); });
    row.valid = values.valid;
    kept.add(values);
    values.pressure = {};
    values.kept = {};
    values.cells = {};
    rows.push_back(std::move(values));
    made.rows.push_back(row);
    step(1);
  }
  made.start = std::max(0.0, first.total - made.rows.front().cost.total);
  for (const PilotRow& row : made.rows) {
    costs.push_back(row.cost.total);
    made.mean.total += row.cost.total / static_cast<double>(made.rows.size());
    for (std::size_t s = 0; s < made.mean.stages.size(); ++s)
      made.mean.stages[s] += row.cost.stages[s] / static_cast<double>(made.rows.size());
    if (std::isfinite(row.memory)) memory.push_back(row.memory);
  }
  constexpr double of_pages = 1e6;  // that a row may take or leave by chance [bytes]
  made.row_memory = memory.empty() ? std::nan("") : *std::max_element(memory.begin(), memory.end());
  made.row_most = predicted_greatest(memory, made.count, options.confidence, of_pages);
  made.processor =
      predicted_total(by_group(costs, made.group), made.group, made.count, options.confidence);
  made.processor.total += made.start;
  made.processor.interval.low += made.start;
  made.processor.interval.high += made.start;
  made.budget = budget_of(study.scenario, MemoryBudget()).bytes();
  // A row that needs more than the whole budget is refused.
  const double most = std::max(made.budget, made.row_memory);
  for (double* bytes :
       {&made.row_most.total, &made.row_most.interval.low, &made.row_most.interval.high})
    if (*bytes > most) *bytes = most;
  const std::vector<Column> every = columns(study);
  made.file_row = 8.0 * static_cast<double>(every.size() + reuse_columns().size()) + 9.0;
  made.kept_row = kept.of_row();
  made.kept_met = kept.all_met();
  made.drivers = drivers_of(every, rows, costs, options.confidence, made.ordered);

  const std::vector<std::uint64_t> few = across_costs(made.rows, changed);
  const Tries unchanged(study, options);
  const double before = unchanged.cost_of(few);
  step(few.size());
  // At once again: what such rows share is known.
  made.again = before > 0.0 ? unchanged.cost_of(few) / before : 1.0;
  step(few.size());
  for (const Candidate& turn : turns) {
    std::vector<std::string> set = options.set;
    set.insert(set.end(), turn.overrides.begin(), turn.overrides.end());
    try {
      const Study other = read_study(study.path, set);
      const Tries tries(other, options);
      const double cost = tries.cost_of(few);
      if (before > 0.0) made.turned.push_back({turn, cost / before});
    } catch (const InputError&) {  // it does not go with what else is set
      made.refused.push_back(turn);
    }
    step(few.size());
  }
  std::stable_sort(made.turned.begin(), made.turned.end(),
                   [](const Turned& a, const Turned& b) { return a.share < b.share; });
  return made;
}

}  // namespace asdic::detail::study
