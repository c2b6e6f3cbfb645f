#include "study/summary/saltelli.h"

#include <algorithm>
#include <cmath>

#include "study/plan/no_value.h"

namespace asdic::detail::study {
namespace {

/// A block's values, less the mean of A and B: it moves no index, but its scatter.
class Block {
 public:
  Block(const BlockValues& values, std::size_t block, double mean)
      : values_(values), block_(block), mean_(mean) {}
  double operator[](std::size_t row) const { return values_.at(block_, row) - mean_; }

 private:
  const BlockValues& values_;
  std::size_t block_;
  double mean_;
};

/// The blocks in which some rows are known.
class Known {
 public:
  Known(const BlockValues& values, const std::vector<std::size_t>& needed) : values_(values) {
    double sum = 0.0;
    for (std::size_t block = 0; block < values.size(); ++block) {
      if (!std::all_of(needed.begin(), needed.end(),
                       [&](std::size_t row) { return std::isfinite(values.at(block, row)); }))
        continue;
      blocks_.push_back(static_cast<std::uint32_t>(block));
      sum += values.at(block, SaltelliBlocks::a) + values.at(block, SaltelliBlocks::b);
    }
    mean_ = blocks_.empty() ? 0.0 : sum / (2.0 * static_cast<double>(blocks_.size()));
  }
  [[nodiscard]] std::size_t size() const noexcept { return blocks_.size(); }
  [[nodiscard]] bool empty() const noexcept { return blocks_.empty(); }
  [[nodiscard]] Block operator[](std::size_t k) const { return {values_, blocks_[k], mean_}; }

 private:
  const BlockValues& values_;
  std::vector<std::uint32_t> blocks_;
  double mean_ = 0.0;
};

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
Index index_of(const Known& all, const Part& part, double confidence) {
  std::vector<double> n, v;
  n.reserve(all.size());
  v.reserve(all.size());
  for (std::size_t k = 0; k < all.size(); ++k) {
    const Block block = all[k];
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

BlockValues::Places::Places(std::span<const std::uint64_t> index, std::size_t rows)
    : index_(index), rows_(rows) {
  for (std::size_t row = 0; row < index.size(); ++row)
    if (row == 0 || index[row] / rows != index[row - 1] / rows) first_.push_back(row);
}

std::optional<std::size_t> BlockValues::Places::row(std::size_t block, std::size_t in_block) const {
  const std::size_t first = first_[block];
  const std::uint64_t wanted = index_[first] / rows_ * rows_ + in_block;
  // Of a whole block it is where it would be; of others before that.
  std::size_t row = std::min(first + in_block, index_.size() - 1);
  while (row > first && index_[row] > wanted) --row;
  return index_[row] == wanted ? std::optional(row) : std::nullopt;
}

double BlockValues::at(std::size_t block, std::size_t row) const {
  const std::optional<std::size_t> place = places_.row(block, row);
  const bool known = place && valid_[*place] != 0 && std::isfinite(values_[*place]);
  return known ? values_[*place] : no_value;
}

Index first_order_index(const SaltelliBlocks& blocks, const BlockValues& values, std::size_t group,
                        double confidence) {
  return index_of(
      Known(values, rows_of(blocks, {group})),
      [&](const Block& f) { return first(blocks, f, group); }, confidence);
}

Index total_order_index(const SaltelliBlocks& blocks, const BlockValues& values, std::size_t group,
                        bool proportion, ProportionInterval kind, double confidence) {
  const Known all(values, rows_of(blocks, {group}));
  Index index = index_of(
      all, [&](const Block& f) { return total(blocks, f, group); }, confidence);
  if (index.interval.low < 0.0) index.interval.low = 0.0;  // NaN stays
  if (!proportion || all.empty()) return index;
  // A and A_B^i differ in k of n blocks: few of them are no normal matter, and none is not never.
  double different = 0.0, v = 0.0;
  for (std::size_t k = 0; k < all.size(); ++k) {
    const Block f = all[k];
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
      Known(values, rows_of(blocks, {one, other})),
      [&](const Block& f) { return second(blocks, f, one, other); }, confidence);
}

Index unexplained_share(const SaltelliBlocks& blocks, const BlockValues& values,
                        double confidence) {
  std::vector<std::size_t> rows(blocks.rows());
  for (std::size_t row = 0; row < rows.size(); ++row) rows[row] = row;
  return index_of(
      Known(values, rows),
      [&](const Block& f) {
        double left = variance(f);
        for (std::size_t group = 0; group < blocks.groups(); ++group)
          left -= first(blocks, f, group);
        return left;
      },
      confidence);
}

}  // namespace asdic::detail::study
