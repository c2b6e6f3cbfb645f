#include "study/summary/tail.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/random.h"

namespace asdic::detail::study {
namespace {

constexpr double least_xi = -0.5, most_xi = 1.0;  // of regular likelihoods, and some more

/// ln P(level ≥ u₀ + y | ≥ u₀)
double log_survival(double y, double shape, double scale) {
  const double x = y / scale;
  if (std::abs(shape) < 1e-9) return -x;
  const double inside = 1.0 + shape * x;
  return inside > 0.0 ? -std::log(inside) / shape : -std::numeric_limits<double>::infinity();
}

/// Counts over a threshold.
struct Excesses {
  std::vector<double> ends;    // [bins] lower, over the threshold: 0 first
  std::vector<double> counts;  // [bins]
  double total = 0.0;

  [[nodiscard]] double likelihood(double shape, double scale) const {
    double sum = 0.0, from = 1.0;
    for (std::size_t i = 0; i < counts.size(); ++i) {
      const double to =
          i + 1 < ends.size() ? std::exp(log_survival(ends[i + 1], shape, scale)) : 0.0;
      if (counts[i] > 0.0) sum += counts[i] * std::log(std::max(from - to, 1e-300));
      from = to;
    }
    return sum;
  }
  /// The likeliest scale of a shape.
  [[nodiscard]] double scale_of(double shape) const {
    double mean = 0.0;
    for (std::size_t i = 0; i < counts.size(); ++i) mean += counts[i] * ends[i] / total;
    const double middle = std::log(std::max(mean, 0.05));
    double a = middle - 2.0, b = middle + 2.0;
    constexpr double golden = 0.6180339887498949;
    double c = b - golden * (b - a), d = a + golden * (b - a);
    double at_c = likelihood(shape, std::exp(c)), at_d = likelihood(shape, std::exp(d));
    for (int i = 0; i < 22; ++i) {
      if (at_c > at_d) {
        b = d;
        d = c;
        at_d = at_c;
        c = b - golden * (b - a);
        at_c = likelihood(shape, std::exp(c));
      } else {
        a = c;
        c = d;
        at_c = at_d;
        d = a + golden * (b - a);
        at_d = likelihood(shape, std::exp(d));
      }
    }
    return std::exp(0.5 * (a + b));
  }
};

struct Pareto {
  double shape = 0.0, scale = 1.0, likelihood = 0.0;
};

/// The likeliest: golden sections over ξ, and of each over σ. \param steps  of the outer ones
Pareto likeliest(const Excesses& of, double low, double high, int steps) {
  const auto at = [&](double shape) {
    const double scale = of.scale_of(shape);
    return Pareto{shape, scale, of.likelihood(shape, scale)};
  };
  constexpr double golden = 0.6180339887498949;
  Pareto c = at(high - golden * (high - low)), d = at(low + golden * (high - low));
  for (int i = 0; i < steps; ++i) {
    if (c.likelihood > d.likelihood) {
      high = d.shape;
      d = c;
      c = at(high - golden * (high - low));
    } else {
      low = c.shape;
      c = d;
      d = at(low + golden * (high - low));
    }
  }
  return c.likelihood > d.likelihood ? c : d;
}

/// Anderson & Darling's statistic of counts in levels (Choulakian, Lockhart & Stephens, Can. J.
/// Stat. 22, 125, 1994): Σ Z²·p/(H(1 − H))/n, Z the sums of what is too much, H of what is
/// expected.
double anderson_darling(const Excesses& of, const Pareto& law) {
  double seen = 0.0, sum = 0.0, before = 0.0;
  for (std::size_t i = 0; i + 1 < of.ends.size(); ++i) {
    seen += of.counts[i];
    const double below = -std::expm1(log_survival(of.ends[i + 1], law.shape, law.scale));
    const double too_many = seen - of.total * below;
    if (below > 0.0 && below < 1.0 - 1e-12)
      sum += too_many * too_many * (below - before) / (below * (1.0 - below));
    before = below;
  }
  return sum / of.total;
}

/// As many cells of a law, drawn one by one.
Excesses drawn(const Excesses& like, const Pareto& law, std::size_t count, RandomStream& random) {
  Excesses made{.ends = like.ends, .counts = std::vector<double>(like.ends.size(), 0.0)};
  made.total = static_cast<double>(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double e = -std::log(random.uniform());
    const double y =
        law.scale * (std::abs(law.shape) < 1e-9 ? e : std::expm1(law.shape * e) / law.shape);
    const auto place = std::upper_bound(made.ends.begin(), made.ends.end(), y) - 1;
    made.counts[static_cast<std::size_t>(place - made.ends.begin())] += 1.0;
  }
  return made;
}

/// P of at least the statistic, by as many samples of the law itself, fitted as it was.
double goodness_of(const Excesses& of, const Pareto& law, double dispersion) {
  constexpr int samples = 99;
  constexpr double most = 2000.0;
  const double worth = of.total / dispersion;
  // Of dependent cells the statistic is as much larger as their counts' variance.
  const double found = anderson_darling(of, law) / dispersion;
  const auto count = static_cast<std::size_t>(std::clamp(std::round(worth), 1.0, most));
  RandomStream random(1, Draw::study_noise, 2, count);
  int as_large = 0;
  for (int i = 0; i < samples; ++i) {
    const Excesses sample = drawn(of, law, count, random);
    const Pareto own = likeliest(sample, std::max(least_xi, law.shape - 0.4),
                                 std::min(most_xi, law.shape + 0.4), 8);
    as_large += anderson_darling(sample, own) >= found;
  }
  return (as_large + 1.0) / (samples + 1.0);
}

}  // namespace

double Tail::rate(double u) const noexcept {
  return share * std::exp(log_survival(u - from, shape, scale));
}

Interval Tail::interval(double u) const noexcept {
  const double here = log_survival(u - from, shape, scale);
  double low = here, high = here;
  for (const Likely& law : likely) {
    low = std::min(low, log_survival(u - from, law.shape, law.least));
    high = std::max(high, log_survival(u - from, law.shape, law.greatest));
  }
  if (!std::isfinite(here))  // beyond the end of the likeliest law, not of all that are likely
    return {0.0, std::min(1.0, share * std::exp(high + half_of_share))};
  const double down = std::hypot(here - low, half_of_share),
               up = std::hypot(high - here, half_of_share);
  return {share * std::exp(here - down), std::min(1.0, share * std::exp(here + up))};
}

Tail fit_tail(std::span<const double> levels, std::span<const double> counts,
              std::span<const double> dispersion, double confidence, bool goodness) {
  constexpr double wanted = 2000.0, least = 50.0, largest_share = 0.05;
  Tail tail;
  const double all = std::accumulate(counts.begin(), counts.end(), 0.0);
  double above = 0.0;
  std::size_t at = counts.size();
  while (at > 1) {
    const double more = above + counts[at - 1];
    if (more > largest_share * all) break;
    above = more;
    --at;
    if (above / dispersion[at] >= wanted) break;
  }
  if (at >= counts.size() || above / dispersion[at] < least) return tail;
  Excesses excesses{.total = above};
  for (std::size_t i = at; i < counts.size(); ++i) {
    excesses.ends.push_back(levels[i] - levels[at]);
    excesses.counts.push_back(counts[i]);
  }
  const double worse = std::max(1.0, dispersion[at]);
  const Pareto law = likeliest(excesses, least_xi, most_xi, 24);
  tail.fitted = true;
  tail.from = levels[at];
  tail.count = above;
  tail.worth = above / worse;
  tail.share = above / all;
  tail.shape = law.shape;
  tail.scale = law.scale;
  if (goodness) tail.goodness = goodness_of(excesses, law, worse);
  const double z = two_sided(confidence);
  tail.half_of_share = z * std::sqrt(worse * (1.0 - tail.share) / above);

  // The region of likely laws: of two parameters together no more than of the one that is asked
  // for, since each rate is one number. It is found along ξ, outwards until there is none.
  const double faint = law.likelihood - 0.5 * z * z * worse;
  tail.shape_interval = {law.shape, law.shape};
  const double step = 0.25 / std::sqrt(tail.worth);
  for (const double way : {-step, step})
    for (int k = 0; k < 60; ++k) {
      const double shape = law.shape + k * way;
      if (shape < -1.0 || shape > 2.0) break;
      const double scale = k == 0 ? law.scale : excesses.scale_of(shape);
      if (excesses.likelihood(shape, scale) < faint) break;
      const auto end = [&](double factor) {
        double inside = std::log(scale), outside = inside;
        // Cells all in one level are as likely of any smaller scale: 10 is far enough then.
        for (int i = 0; i < 100; ++i) {
          outside += factor;
          if (excesses.likelihood(shape, std::exp(outside)) < faint) break;
        }
        inside = outside - factor;
        for (int i = 0; i < 16; ++i) {
          const double half = 0.5 * (inside + outside);
          (excesses.likelihood(shape, std::exp(half)) >= faint ? inside : outside) = half;
        }
        return std::exp(inside);
      };
      tail.likely.push_back({shape, end(-0.1), end(0.1)});
      tail.shape_interval.low = std::min(tail.shape_interval.low, shape);
      tail.shape_interval.high = std::max(tail.shape_interval.high, shape);
    }
  return tail;
}

Interval far_interval(const Tail& tail, const ShapeFit& shape, double u, double cells) {
  Interval interval = tail.interval(u);
  if (!(shape.low > 0.0)) return interval;
  const double least = std::isinf(shape.high) ? std::exp(-u) : k_exceedance(u, shape.high, cells);
  interval.low = std::min(interval.low, least);
  interval.high = std::max(interval.high, k_exceedance(u, shape.low, cells));
  return interval;
}

}  // namespace asdic::detail::study
