#include "study/summary/saltelli.h"

#include <algorithm>
#include <cmath>

#include "study/plan/no_value.h"

namespace asdic::detail::study {
namespace {

/// The values of a block, less the mean of A and B: it moves no index, but its scatter.
using Block = std::vector<double>;

/// The blocks in which `needed` rows are known, centred.
std::vector<Block> known(const BlockValues& values, const std::vector<std::size_t>& needed) {
  std::vector<Block> all;
  for (const Block& block : values)
    if (std::all_of(needed.begin(), needed.end(),
                    [&](std::size_t row) { return std::isfinite(block[row]); }))
      all.push_back(block);
  double sum = 0.0;
  for (const Block& block : all) sum += block[SaltelliBlocks::a] + block[SaltelliBlocks::b];
  const double mean = all.empty() ? 0.0 : sum / (2.0 * static_cast<double>(all.size()));
  for (Block& block : all)
    for (double& x : block) x -= mean;
  return all;
}

std::vector<std::size_t> rows_of(const SaltelliBlocks& blocks,
                                 std::initializer_list<std::size_t> groups) {
  std::vector<std::size_t> rows{SaltelliBlocks::a, SaltelliBlocks::b};
  for (const std::size_t group : groups) {
    rows.push_back(blocks.ab(group));
    if (blocks.second_order()) rows.push_back(blocks.ba(group));
  }
  return rows;
}

double square(double x) { return x * x; }

/// A block's part of the variance: A and B are independent.
double variance(const Block& f) {
  return 0.5 * (square(f[SaltelliBlocks::a]) + square(f[SaltelliBlocks::b]));
}

double first(const SaltelliBlocks& blocks, const Block& f, std::size_t i) {
  const double a = f[SaltelliBlocks::a], b = f[SaltelliBlocks::b];
  const double one = b * (f[blocks.ab(i)] - a);
  return blocks.second_order() ? 0.5 * (one + a * (f[blocks.ba(i)] - b)) : one;
}

double total(const SaltelliBlocks& blocks, const Block& f, std::size_t i) {
  const double one = 0.5 * square(f[SaltelliBlocks::a] - f[blocks.ab(i)]);
  return blocks.second_order() ? 0.5 * (one + 0.5 * square(f[SaltelliBlocks::b] - f[blocks.ba(i)]))
                               : one;
}

double second(const SaltelliBlocks& blocks, const Block& f, std::size_t i, std::size_t j) {
  const double both = 0.5 * (f[blocks.ba(i)] * f[blocks.ab(j)] + f[blocks.ba(j)] * f[blocks.ab(i)]);
  return both - f[SaltelliBlocks::a] * f[SaltelliBlocks::b] - first(blocks, f, i) -
         first(blocks, f, j);
}

template <class Part>
Index index_of(const std::vector<Block>& all, const Part& part, double confidence) {
  std::vector<double> n, v;
  for (const Block& block : all) {
    n.push_back(part(block));
    v.push_back(variance(block));
  }
  const Ratio ratio = ratio_of(n, v, confidence);
  Index index{.blocks = static_cast<double>(all.size()),
              .value = ratio.value,
              .interval = ratio.interval,
              .error = no_value};
  if (all.size() < 2) return index;
  Moments influence, whole;
  for (std::size_t i = 0; i < n.size(); ++i) {
    influence.add(n[i] - ratio.value * v[i]);
    whole.add(v[i]);
  }
  index.error = influence.deviation() / std::sqrt(index.blocks) / whole.mean();
  return index;
}

}  // namespace

Index first_order_index(const SaltelliBlocks& blocks, const BlockValues& values, std::size_t group,
                        double confidence) {
  return index_of(
      known(values, rows_of(blocks, {group})),
      [&](const Block& f) { return first(blocks, f, group); }, confidence);
}

Index total_order_index(const SaltelliBlocks& blocks, const BlockValues& values, std::size_t group,
                        bool proportion, ProportionInterval kind, double confidence) {
  const std::vector<Block> all = known(values, rows_of(blocks, {group}));
  Index index = index_of(
      all, [&](const Block& f) { return total(blocks, f, group); }, confidence);
  if (index.interval.low < 0.0) index.interval.low = 0.0;  // NaN stays
  if (!proportion || all.empty()) return index;
  // A and A_B^i differ in k of n blocks: few of them are no normal matter, and none is not never.
  double different = 0.0, v = 0.0;
  for (const Block& f : all) {
    different += f[SaltelliBlocks::a] != f[blocks.ab(group)] ? 1.0 : 0.0;
    v += variance(f) / index.blocks;
  }
  if (!(v > 0.0)) return index;
  const Interval share = proportion_interval(kind, different, index.blocks, confidence);
  index.interval.low = std::min(index.interval.low, 0.5 * share.low / v);
  index.interval.high = std::max(index.interval.high, 0.5 * share.high / v);
  return index;
}

Index second_order_index(const SaltelliBlocks& blocks, const BlockValues& values, std::size_t one,
                         std::size_t other, double confidence) {
  return index_of(
      known(values, rows_of(blocks, {one, other})),
      [&](const Block& f) { return second(blocks, f, one, other); }, confidence);
}

Index unexplained_share(const SaltelliBlocks& blocks, const BlockValues& values,
                        double confidence) {
  std::vector<std::size_t> rows(blocks.rows());
  for (std::size_t row = 0; row < rows.size(); ++row) rows[row] = row;
  return index_of(
      known(values, rows),
      [&](const Block& f) {
        double left = variance(f);
        for (std::size_t group = 0; group < blocks.groups(); ++group)
          left -= first(blocks, f, group);
        return left;
      },
      confidence);
}

}  // namespace asdic::detail::study
