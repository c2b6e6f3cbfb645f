#include "study/sampling/cross_entropy.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "study/sampling/design.h"

namespace asdic::detail::study {
namespace {

constexpr double least_deviation = 0.708, most_deviation = 4.0, farthest_centre = 7.5;
constexpr std::size_t most_laws = 3;
constexpr int rounds = 40;  // of the search

/// A normal law of independent scores.
struct Law {
  double share = 1.0;
  std::vector<double> centre, deviation;
};

/// ln of its density over the standard one's, which is all that choices depend on.
double log_ratio(const Law& law, std::span<const double> z) {
  double sum = std::log(law.share);
  for (std::size_t d = 0; d < z.size(); ++d) {
    const double s = (z[d] - law.centre[d]) / law.deviation[d];
    sum += 0.5 * (z[d] * z[d] - s * s) - std::log(law.deviation[d]);
  }
  return sum;
}

/// Rows that are fitted.
struct Sample {
  std::vector<const LevelRow*> rows;
  std::vector<double> weight;  ///< of sum 1
  double effective = 0.0;
  [[nodiscard]] std::size_t dimensions() const { return rows.front()->scores.size(); }
};

/// \param belongs  [rows] how much each is of the law
Law fitted(const Sample& sample, const std::vector<double>& belongs) {
  const std::size_t dimensions = sample.dimensions();
  Law law{.share = 0.0,
          .centre = std::vector<double>(dimensions, 0.0),
          .deviation = std::vector<double>(dimensions, 0.0)};
  for (std::size_t i = 0; i < belongs.size(); ++i) law.share += sample.weight[i] * belongs[i];
  if (!(law.share > 0.0)) return law;
  const auto mean = [&](auto value) {
    double sum = 0.0;
    for (std::size_t i = 0; i < belongs.size(); ++i)
      sum += sample.weight[i] * belongs[i] * value(sample.rows[i]->scores);
    return sum / law.share;
  };
  for (std::size_t d = 0; d < dimensions; ++d) {
    const double m = mean([&](const std::vector<double>& z) { return z[d]; });
    const double v = mean([&](const std::vector<double>& z) { return (z[d] - m) * (z[d] - m); });
    law.centre[d] = std::clamp(m, -farthest_centre, farthest_centre);
    law.deviation[d] = std::clamp(std::sqrt(v), least_deviation, most_deviation);
  }
  return law;
}

/// A mixture and how likely the rows are by it.
struct Mixture {
  std::vector<Law> laws;
  double log_likelihood = -std::numeric_limits<double>::infinity();  ///< of effective rows
};

/// Expectation and maximisation from given centres. \param starts  rows that are centres at first
Mixture searched(const Sample& sample, const std::vector<std::size_t>& starts) {
  const std::size_t n = sample.rows.size(), k = starts.size();
  Mixture mixture;
  for (const std::size_t start : starts)
    mixture.laws.push_back({.share = 1.0 / static_cast<double>(k),
                            .centre = sample.rows[start]->scores,
                            .deviation = std::vector<double>(sample.dimensions(), 1.0)});
  std::vector<std::vector<double>> belongs(k, std::vector<double>(n, 0.0));
  for (int round = 0; round < rounds; ++round) {
    double sum = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
      double most = -std::numeric_limits<double>::infinity(), all = 0.0;
      for (std::size_t j = 0; j < k; ++j) {
        belongs[j][i] = log_ratio(mixture.laws[j], sample.rows[i]->scores);
        most = std::max(most, belongs[j][i]);
      }
      for (std::size_t j = 0; j < k; ++j) all += belongs[j][i] = std::exp(belongs[j][i] - most);
      for (std::size_t j = 0; j < k; ++j) belongs[j][i] /= all;
      sum += sample.weight[i] * (most + std::log(all));
    }
    mixture.log_likelihood = sample.effective * sum;
    if (round + 1 == rounds) break;
    for (std::size_t j = 0; j < k; ++j) {
      mixture.laws[j] = fitted(sample, belongs[j]);
      if (!(mixture.laws[j].share > 0.02)) {  // nothing is left of it
        mixture.log_likelihood = -std::numeric_limits<double>::infinity();
        return mixture;
      }
    }
  }
  return mixture;
}

/// Centres far from one another: each next one by weight times its squared distance (k-means++,
/// Arthur & Vassilvitskii, SODA 2007).
std::vector<std::size_t> centres(const Sample& sample, std::size_t count, std::uint64_t seed,
                                 std::uint64_t attempt) {
  std::vector<std::size_t> starts;
  std::vector<double> chance = sample.weight;
  for (std::size_t k = 0; k < count; ++k) {
    const double at = uniform_draw(seed, attempt, static_cast<std::uint32_t>(k)) *
                      std::accumulate(chance.begin(), chance.end(), 0.0);
    double before = 0.0;
    std::size_t pick = 0;
    while (pick + 1 < chance.size() && (before += chance[pick]) < at) ++pick;
    starts.push_back(pick);
    for (std::size_t i = 0; i < chance.size(); ++i) {
      double least = std::numeric_limits<double>::infinity();
      for (const std::size_t start : starts) {
        double d2 = 0.0;
        for (std::size_t d = 0; d < sample.dimensions(); ++d) {
          const double d1 = sample.rows[i]->scores[d] - sample.rows[start]->scores[d];
          d2 += d1 * d1;
        }
        least = std::min(least, d2);
      }
      chance[i] = sample.weight[i] * least;
    }
  }
  return starts;
}

std::vector<Law> best_mixture(const Sample& sample, std::uint64_t seed) {
  Mixture best;
  double best_score = -std::numeric_limits<double>::infinity();
  for (std::size_t k = 1; k <= most_laws; ++k)
    for (std::uint64_t attempt = 0; attempt < (k == 1 ? 1U : 4U); ++attempt) {
      Mixture mixture = searched(sample, centres(sample, k, seed, 10 * k + attempt));
      const auto parameters = static_cast<double>(k * 2 * sample.dimensions() + k - 1);
      const double score = mixture.log_likelihood - 0.5 * parameters * std::log(sample.effective);
      if (!(score > best_score)) continue;
      best_score = score;
      best = std::move(mixture);
    }
  return best.laws;
}

/// What differs from the standard law by more than chance.
ProposalPart part_of(const Law& law, double effective) {
  constexpr double sure = 2.5;  // standard errors
  const double n = std::max(1.0, effective * law.share);
  ProposalPart part{.share = law.share};
  const auto rounded = [](double x) { return std::round(x * 1e3) / 1e3; };  // as it is written
  for (std::size_t d = 0; d < law.centre.size(); ++d) {
    const bool moved = std::abs(law.centre[d]) > sure / std::sqrt(n);
    const bool spread = std::abs(law.deviation[d] - 1.0) > sure / std::sqrt(2.0 * n);
    CoordinateDraw draw;
    if (moved || spread)
      draw =
          ScoreLaw{moved ? rounded(law.centre[d]) : 0.0, spread ? rounded(law.deviation[d]) : 1.0};
    part.draws.push_back(std::move(draw));
  }
  part.share = rounded(law.share);
  return part;
}

}  // namespace

Level next_level(std::span<const LevelRow> rows, double count, double effective,
                 std::uint64_t seed) {
  std::vector<const LevelRow*> sorted;
  for (const LevelRow& row : rows) sorted.push_back(&row);
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const LevelRow* a, const LevelRow* b) { return a->excess > b->excess; });
  Level level;
  double w = 0.0, ww = 0.0;
  for (const LevelRow* row : sorted) {
    // Rows that are alike belong together; beyond the event all are.
    const bool enough = w * w >= effective * ww && ww > 0.0;
    if (enough && row->excess < 0.0 && row->excess < sorted[level.rows - 1]->excess) break;
    w += std::exp(row->log_weight);
    ww += std::exp(2.0 * row->log_weight);
    ++level.rows;
  }
  level.hits = static_cast<std::size_t>(std::count_if(
      rows.begin(), rows.end(), [](const LevelRow& row) { return row.excess > 0.0; }));
  level.reached = std::min(0.0, sorted[level.rows - 1]->excess);
  level.effective = ww > 0.0 ? w * w / ww : 0.0;
  level.probability = w / count;
  Sample sample{.rows = {sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(level.rows)},
                .weight = {},
                .effective = level.effective};
  for (const LevelRow* row : sample.rows) sample.weight.push_back(std::exp(row->log_weight) / w);
  for (const Law& law : best_mixture(sample, seed))
    level.parts.push_back(part_of(law, level.effective));
  return level;
}

}  // namespace asdic::detail::study
