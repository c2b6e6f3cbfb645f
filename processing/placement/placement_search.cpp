#include "processing/placement/placement_search.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>
#include <optional>

#include "core/random.h"
#include "raytrace/parallel/parallel.h"

namespace asdic::detail {
namespace {

/// Two sums of the same terms in another order are equal.
constexpr double rounding = 1e-12;

/// Probabilities of exactly 0 … k − 1 detections so far: [k][draws × cells].
class Detections {
 public:
  Detections(std::size_t at_least, std::size_t size) : size_(size), exactly_(at_least * size, 0.0) {
    std::fill_n(exactly_.begin(), size, 1.0);
  }

  /// One map more, which detects independently of those before.
  void add(const std::vector<float>& map) {
    assert(map.size() == size_);
    for (std::size_t j = exactly_.size() / size_; j-- > 0;)
      for (std::size_t x = 0; x < size_; ++x) {
        const double p = double(map[x]);
        double& here = exactly_[j * size_ + x];
        here *= 1.0 - p;
        if (j > 0) here += p * exactly_[(j - 1) * size_ + x];
      }
  }
  /// That there are not enough.
  [[nodiscard]] double too_few(std::size_t x) const {
    double sum = 0.0;
    for (std::size_t at = x; at < exactly_.size(); at += size_) sum += exactly_[at];
    return sum;
  }
  /// That one more would be enough: what a map adds is p times that.
  [[nodiscard]] double one_short(std::size_t x) const {
    return exactly_[exactly_.size() - size_ + x];
  }

 private:
  std::size_t size_;
  std::vector<double> exactly_;
};

/// The best two sets of all that were looked at.
class BestTwo {
 public:
  void look(double value, SensorSet set) {
    std::sort(set.begin(), set.end());
    if (set == best_ || set == second_) return;
    if (best_.empty() || value > value_ + rounding) {
      second_ = std::move(best_);
      second_value_ = value_;
      best_ = std::move(set);
      value_ = value;
    } else if (second_.empty() || value > second_value_ + rounding) {
      second_ = std::move(set);
      second_value_ = value;
    }
  }
  /// What a set must be above to matter.
  [[nodiscard]] double second() const { return second_.empty() ? -1.0 : second_value_; }
  void tell(PlacementChoice& choice) const {
    choice.best = best_;
    choice.value = value_;
    choice.runner_up = second_;
    choice.runner_value = second_value_;
  }

 private:
  SensorSet best_, second_;
  double value_ = 0.0, second_value_ = 0.0;
};

class Search {
 public:
  Search(const PlacementProblem& problem, const PlacementSettings& settings,
         const Progress& progress)
      : problem_(problem),
        settings_(settings),
        progress_(progress),
        count_(problem.candidates.size()),
        cells_(problem.weight.size()),
        at_least_(problem.at_least),
        size_(problem.draws * cells_) {}

  PlacementChoice run() {
    PlacementChoice choice;
    SensorSet set;
    for (std::size_t n = 0; n < problem_.sensors; ++n) {
      // While there are fewer than count as one, the most that there can be.
      const std::size_t maps = problem_.pairs ? (n + 1) * (n + 1) : n + 1;
      at_least_ = std::min(problem_.at_least, maps);
      set.push_back(best_of(values_with(set), set).first);
      at_least_ = problem_.at_least;
      choice.greedy.push_back(set);
      choice.greedy_value.push_back(value_of(set));
      bound(set);
      tell_progress(0.2 * double(n + 1) / double(problem_.sensors));
    }
    bound({});
    std::tie(set, choice.swapped_value) = improved(set, choice.greedy_value.back(), &choice.swaps);
    choice.swapped = sorted(set);
    bound(set);
    const bool all = settings_.method == PlacementMethod::exhaustive ||
                     (settings_.method == PlacementMethod::automatic &&
                      number_of_sets(problem_) <= settings_.most_sets &&
                      number_of_sets(problem_) * work_of_set() <= settings_.most_work);
    if (!all)
      for (int start = 0; start < settings_.starts; ++start) {
        const SensorSet drawn = drawn_set(start);
        static_cast<void>(improved(drawn, value_of(drawn), nullptr));
        tell_progress(0.2 + 0.8 * (start + 1.0) / settings_.starts);
      }
    if (all) look_at_all();
    choice.proved = all;
    best_.tell(choice);
    choice.upper_bound = all ? choice.value : std::min(1.0, bound_);
    constexpr double sums = 1e-9;  // that are added up in other orders
    if (!all && choice.upper_bound <= choice.value + sums) choice.proved = true;
    return choice;
  }

 private:
  [[nodiscard]] static SensorSet sorted(SensorSet set) {
    std::sort(set.begin(), set.end());
    return set;
  }
  void tell_progress(double share) const {
    if (progress_ && !progress_(share)) throw Interrupted();
  }
  [[nodiscard]] const std::vector<float>& map(std::size_t sends, std::size_t hears) const {
    return problem_.maps[sends * count_ + hears];
  }
  [[nodiscard]] double weight(std::size_t x) const {
    return problem_.weight[x % cells_] / double(problem_.draws);
  }
  [[nodiscard]] Detections none() const { return {at_least_, size_}; }

  /// Adds all maps that a candidate brings to a set.
  void join(Detections& detections, const SensorSet& set, std::size_t candidate) const {
    if (!problem_.pairs) return detections.add(problem_.maps[candidate]);
    detections.add(map(candidate, candidate));
    for (const std::size_t other : set) {
      detections.add(map(candidate, other));
      detections.add(map(other, candidate));
    }
  }
  [[nodiscard]] Detections detections_of(const SensorSet& set) const {
    Detections made = none();
    SensorSet so_far;
    for (const std::size_t one : set) {
      join(made, so_far, one);
      so_far.push_back(one);
    }
    return made;
  }
  [[nodiscard]] double value_of(const Detections& detections) const {
    double lost = 0.0;
    for (std::size_t x = 0; x < size_; ++x) lost += weight(x) * detections.too_few(x);
    return std::max(0.0, 1.0 - lost);
  }
  [[nodiscard]] double value_of(const SensorSet& set) const { return value_of(detections_of(set)); }

  [[nodiscard]] bool fits(const SensorSet& set, std::size_t candidate) const {
    return std::none_of(set.begin(), set.end(), [&](std::size_t one) {
      return problem_.candidates[one].place == problem_.candidates[candidate].place;
    });
  }

  /// Of a set with each candidate more; −1 where its place is taken. \param first  candidates
  /// before it are not looked at
  [[nodiscard]] std::vector<double> values_with(const SensorSet& set, std::size_t first = 0) const {
    return values_with(detections_of(set), set, first);
  }
  [[nodiscard]] std::vector<double> values_with(const Detections& so_far, const SensorSet& set,
                                                std::size_t first) const {
    const double value = value_of(so_far);
    std::vector<double> values(count_, -1.0);
    in_parallel(count_ - first, [&](std::size_t i) {
      const std::size_t candidate = first + i;
      if (!fits(set, candidate)) return;
      if (!problem_.pairs) {
        values[candidate] = value + gain(so_far, problem_.maps[candidate]);
        return;
      }
      Detections with = so_far;
      join(with, set, candidate);
      values[candidate] = value_of(with);
    });
    return values;
  }
  [[nodiscard]] double gain(const Detections& so_far, const std::vector<float>& map) const {
    double sum = 0.0;
    for (std::size_t x = 0; x < size_; ++x) sum += weight(x) * double(map[x]) * so_far.one_short(x);
    return sum;
  }

  /// The best candidate to add, the first of several. Whole sets are noted.
  std::pair<std::size_t, double> best_of(const std::vector<double>& values, const SensorSet& set) {
    std::size_t best = count_;
    for (std::size_t c = 0; c < count_; ++c) {
      if (values[c] < 0.0) continue;
      if (best == count_ || values[c] > values[best] + rounding) best = c;
      if (set.size() + 1 == problem_.sensors) note(set, c, values[c]);
    }
    assert(best < count_);
    return {best, values[best]};
  }
  void note(SensorSet set, std::size_t more, double value) {
    if (value < best_.second()) return;
    set.push_back(more);
    best_.look(value, std::move(set));
  }

  /// The best swap of one sensor, until none is better.
  std::pair<SensorSet, double> improved(SensorSet set, double value, int* swaps) {
    best_.look(value, set);
    for (;;) {
      SensorSet better = set;
      double better_value = value;
      for (std::size_t m = 0; m < set.size(); ++m) {
        SensorSet others = set;
        others.erase(others.begin() + static_cast<std::ptrdiff_t>(m));
        const auto [candidate, found] = best_of(values_with(others), others);
        if (found <= better_value + rounding) continue;
        better_value = found;
        better = others;
        better.push_back(candidate);
      }
      tell_progress(0.2);
      if (better_value <= value + rounding) return {sorted(set), value};
      set = better;
      value = better_value;
      if (swaps != nullptr) ++*swaps;
    }
  }

  [[nodiscard]] SensorSet drawn_set(int start) const {
    RandomStream random(settings_.seed, Draw::study_permutation, static_cast<std::uint32_t>(start),
                        0);
    SensorSet set;
    while (set.size() < problem_.sensors) {
      const auto c =
          std::min(count_ - 1, static_cast<std::size_t>(random.uniform() * double(count_)));
      if (fits(set, c)) set.push_back(c);
    }
    return set;
  }

  /// Of looking at one set more: numbers that its last sensor's maps have.
  [[nodiscard]] double work_of_set() const {
    const double maps = problem_.pairs ? 2.0 * double(problem_.sensors) - 1.0 : 1.0;
    return maps * double(size_);
  }

  /// Whether one sensor more never gains more than it would have before: submodular.
  [[nodiscard]] bool submodular() const { return !problem_.pairs && problem_.at_least == 1; }

  /// Lowers the bound by what is known at a set S: no set O of the wanted size detects more than
  /// g(S ∪ O) ≤ g(S) + Σ_{o in O} gain of o, of a submodular g that is at least the value.
  /// Of one detection g is the value of the pairs, of several min(1, Σp/k) by Markov's inequality.
  void bound(const SensorSet& set) {
    std::vector<double> missing(size_);
    double at = 0.0;
    if (problem_.at_least == 1) {
      const Detections detections = detections_of(set);
      for (std::size_t x = 0; x < size_; ++x) missing[x] = detections.too_few(x);
      at = value_of(detections);
    } else {
      std::vector<double> sum(size_, 0.0);
      const auto add = [&](const std::vector<float>& map) {
        for (std::size_t x = 0; x < size_; ++x) sum[x] += double(map[x]);
      };
      for (const std::size_t a : set) {
        if (!problem_.pairs) add(problem_.maps[a]);
        for (const std::size_t b : set)
          if (problem_.pairs) add(map(a, b));
      }
      for (std::size_t x = 0; x < size_; ++x) {
        missing[x] = std::max(0.0, 1.0 - sum[x] / double(problem_.at_least));
        at += weight(x) * (1.0 - missing[x]);
      }
    }
    const double k = double(problem_.at_least);
    const auto gain_of = [&](const std::vector<float>& map) {
      double gain = 0.0;
      for (std::size_t x = 0; x < size_; ++x)
        gain += weight(x) * (problem_.at_least == 1 ? double(map[x]) * missing[x]
                                                    : std::min(double(map[x]) / k, missing[x]));
      return gain;
    };
    std::vector<double> gains(count_, 0.0);
    in_parallel(count_, [&](std::size_t a) {
      if (!problem_.pairs) {
        gains[a] = gain_of(problem_.maps[a]);
        return;
      }
      std::vector<double> heard(count_);
      for (std::size_t b = 0; b < count_; ++b) heard[b] = gain_of(map(a, b));
      gains[a] = most_of(heard);
    });
    bound_ = std::min(bound_, at + most_of(gains));
  }
  /// What as many sensors as are wanted can have at most, one at a place.
  [[nodiscard]] double most_of(const std::vector<double>& gains) const {
    std::vector<double> by_place(problem_.places(), 0.0);
    for (std::size_t c = 0; c < count_; ++c) {
      double& most = by_place[problem_.candidates[c].place];
      most = std::max(most, gains[c]);
    }
    std::sort(by_place.begin(), by_place.end(), std::greater<>());
    by_place.resize(std::min(by_place.size(), problem_.sensors));
    return std::accumulate(by_place.begin(), by_place.end(), 0.0);
  }

  void look_at_all() {
    looked_ = 0;
    look_further({}, none(), 0, 0.0, 1.0);
  }
  /// All sets that begin so. \param first  candidate that may come next
  void look_further(const SensorSet& set, const Detections& so_far, std::size_t first, double begun,
                    double part) {
    const std::size_t wanted = problem_.sensors - set.size();
    if (first >= count_) return;
    const std::vector<double> values = values_with(so_far, set, first);
    if (wanted == 1) {
      for (std::size_t c = first; c < count_; ++c)
        if (values[c] >= 0.0) note(set, c, values[c]);
      return;
    }
    if (submodular()) {
      const double value = value_of(so_far);
      std::vector<double> gains(count_, 0.0);
      for (std::size_t c = first; c < count_; ++c) gains[c] = std::max(0.0, values[c] - value);
      std::sort(gains.begin(), gains.end(), std::greater<>());
      const double most = std::accumulate(
          gains.begin(), gains.begin() + static_cast<std::ptrdiff_t>(std::min(wanted, count_)),
          value);
      if (most < best_.second() - rounding) return;
    }
    for (std::size_t c = first; c < count_; ++c) {
      if (!fits(set, c)) continue;
      SensorSet with = set;
      with.push_back(c);
      Detections detections = so_far;
      join(detections, set, c);
      const double share = part / double(count_ - first);
      look_further(with, detections, c + 1, begun + share * double(c - first), share);
      if (set.empty())
        tell_progress(0.2 + 0.8 * (begun + share * double(c + 1 - first)));
      else if (++looked_ % 64 == 0)
        tell_progress(0.2 + 0.8 * begun);
    }
  }

  const PlacementProblem& problem_;
  const PlacementSettings& settings_;
  const Progress& progress_;
  std::size_t count_, cells_, at_least_, size_;
  double bound_ = 1.0;
  std::size_t looked_ = 0;
  BestTwo best_;
};

}  // namespace

std::size_t PlacementProblem::places() const noexcept {
  std::size_t last = 0;
  for (const PlacementCandidate& one : candidates) last = std::max(last, one.place + 1);
  return last;
}

double number_of_sets(const PlacementProblem& problem) {
  // The elementary symmetric polynomial of how many options places have.
  std::vector<double> options(problem.places(), 0.0), sets(problem.sensors + 1, 0.0);
  for (const PlacementCandidate& one : problem.candidates) options[one.place] += 1.0;
  sets[0] = 1.0;
  for (const double here : options)
    for (std::size_t n = problem.sensors; n > 0; --n) sets[n] += here * sets[n - 1];
  return sets.back();
}

PlacementChoice choose_sensors(const PlacementProblem& problem, const PlacementSettings& settings,
                               const Progress& progress) {
  return Search(problem, settings, progress).run();
}

std::vector<double> combined_detection(const PlacementProblem& problem, const SensorSet& set) {
  const std::size_t size = problem.draws * problem.weight.size();
  Detections detections(problem.at_least, size);
  for (const std::size_t a : set) {
    if (!problem.pairs) detections.add(problem.maps[a]);
    for (const std::size_t b : set)
      if (problem.pairs) detections.add(problem.maps[a * problem.candidates.size() + b]);
  }
  std::vector<double> found(size);
  for (std::size_t x = 0; x < size; ++x) found[x] = 1.0 - detections.too_few(x);
  return found;
}

std::vector<double> shares_of(const PlacementProblem& problem, const SensorSet& set) {
  const std::vector<double> found = combined_detection(problem, set);
  std::vector<double> shares(problem.draws, 0.0);
  for (std::size_t x = 0; x < found.size(); ++x)
    shares[x / problem.weight.size()] += problem.weight[x % problem.weight.size()] * found[x];
  return shares;
}

}  // namespace asdic::detail
