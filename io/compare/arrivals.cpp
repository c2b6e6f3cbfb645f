#include "io/compare/arrivals.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <iterator>
#include <sstream>
#include <tuple>

#include "core/error.h"
#include "core/units.h"

namespace asdic::detail::compare {
namespace {

using bellhop::ArrivalRow;
using Complex = std::complex<double>;
using Rows = std::vector<ArrivalRow>;

constexpr double strong_db = 20.0;

/// Amplitude with the absorption: A·exp(ω Im τ).
double strength(const ArrivalRow& row, double frequency) {
  return row.amplitude * std::exp(2.0 * pi * frequency * row.delay_imaginary);
}

/// A·exp(iφ)·exp(−iω(τ − τ₀)), with τ complex: absorption is included.
Complex pressure(const ArrivalRow& row, double frequency, Complex time) {
  const double w = 2.0 * pi * frequency;
  return std::polar(row.amplitude * std::exp(w * (row.delay_imaginary - time.imag())),
                    radians(row.phase_deg) - w * (row.delay - time.real()));
}

bool finite(const ArrivalRow& row) {
  for (const double x : {row.amplitude, row.phase_deg, row.delay, row.delay_imaginary,
                         row.launch_angle_deg, row.arrival_angle_deg})
    if (!std::isfinite(x)) return false;
  return true;
}

auto history(const ArrivalRow& row) { return std::tie(row.surface_bounces, row.bottom_bounces); }

/// One path out of its beams, [first, last).
ArrivalRow join(Rows::const_iterator first, Rows::const_iterator last, double frequency) {
  if (last - first == 1) return *first;
  double total = 0.0;
  for (auto row = first; row != last; ++row) total += strength(*row, frequency);
  ArrivalRow path{.surface_bounces = first->surface_bounces,
                  .bottom_bounces = first->bottom_bounces};
  for (auto row = first; row != last; ++row) {
    const double weight =
        total > 0.0 ? strength(*row, frequency) / total : 1.0 / static_cast<double>(last - first);
    path.delay += weight * row->delay;
    path.delay_imaginary += weight * row->delay_imaginary;
    path.launch_angle_deg += weight * row->launch_angle_deg;
    path.arrival_angle_deg += weight * row->arrival_angle_deg;
  }
  Complex sum = 0.0;
  for (auto row = first; row != last; ++row)
    sum += pressure(*row, frequency, {path.delay, path.delay_imaginary});
  path.amplitude = std::abs(sum);  // its absorption is in the mean delay
  path.phase_deg = degrees(std::arg(sum));
  return path;
}

struct ArrivalPair {
  std::size_t a, b;
};

/// Paths of the same bounces, the nearest in delay first, each used once; the launch angle breaks
/// ties: a degree counts as the whole tolerance.
std::vector<ArrivalPair> pair_up(const Rows& a, const Rows& b, double tolerance) {
  struct Candidate {
    double cost;
    std::size_t a, b;
  };
  std::vector<Candidate> candidates;
  // Both are sorted by bounces and delay (join_beams), so partners lie in a window that moves on.
  std::size_t low = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const auto before = [&](const ArrivalRow& row) {
      return history(row) < history(a[i]) ||
             (history(row) == history(a[i]) && row.delay < a[i].delay - tolerance);
    };
    while (low < b.size() && before(b[low])) ++low;
    for (std::size_t j = low;
         j < b.size() && history(b[j]) == history(a[i]) && b[j].delay <= a[i].delay + tolerance;
         ++j)
      candidates.push_back({std::abs(a[i].delay - b[j].delay) / tolerance +
                                std::abs(a[i].launch_angle_deg - b[j].launch_angle_deg),
                            i, j});
  }
  std::sort(candidates.begin(), candidates.end(), [](const Candidate& x, const Candidate& y) {
    return std::tie(x.cost, x.a, x.b) < std::tie(y.cost, y.a, y.b);
  });
  std::vector<char> used_a(a.size(), 0), used_b(b.size(), 0);
  std::vector<ArrivalPair> pairs;
  for (const Candidate& c : candidates) {
    if (used_a[c.a] != 0 || used_b[c.b] != 0) continue;
    used_a[c.a] = used_b[c.b] = 1;
    pairs.push_back({c.a, c.b});
  }
  return pairs;
}

double strongest(const Rows& rows, double frequency) {
  double peak = 0.0;
  for (const ArrivalRow& row : rows) peak = std::max(peak, strength(row, frequency));
  return peak;
}

/// Into ±180°.
double wrapped(double angle_deg) { return std::remainder(angle_deg, 360.0); }

/// Gathers receiver by receiver what the comparison is made of.
class Gatherer {
 public:
  Gatherer(double frequency, const ArrivalOptions& options)
      : frequency_(frequency), options_(options) {}

  void receiver(const Rows& rows_a, const Rows& rows_b, const MissedPath& place) {
    ++result_.receivers;
    result_.rows_a += rows_a.size();
    result_.rows_b += rows_b.size();
    for (const Rows* rows : {&rows_a, &rows_b})
      result_.not_finite += rows->size() - static_cast<std::size_t>(
                                               std::count_if(rows->begin(), rows->end(), finite));
    add_sum(rows_a, rows_b);
    const Rows a = join_beams(rows_a, frequency_, options_);
    const Rows b = join_beams(rows_b, frequency_, options_);
    const double peak = std::max(strongest(a, frequency_), strongest(b, frequency_));
    const double cut = peak * amplitude_from_db(-options_.below_strongest_db);
    const double strong = peak * amplitude_from_db(-strong_db);
    for (const ArrivalRow& row : a)
      if (const double s = strength(row, frequency_); s >= cut) {
        ++result_.paths_a;
        energy_a_ += s * s;
      }
    // All are paired before weak ones are dropped: a pair at the edge must not be split by it.
    std::vector<char> found(b.size(), 0);
    for (const ArrivalPair& pair : pair_up(a, b, options_.max_delay_difference)) {
      const double sa = strength(a[pair.a], frequency_), sb = strength(b[pair.b], frequency_);
      if (sa == 0.0 || sb == 0.0) continue;
      found[pair.b] = 1;
      if (sb >= cut) add_pair(a[pair.a], b[pair.b], 20.0 * std::log10(sa / sb));
    }
    for (std::size_t j = 0; j < b.size(); ++j) {
      const double s = strength(b[j], frequency_);
      if (s < cut) continue;
      ++result_.paths_b;
      energy_b_ += s * s;
      if (s >= strong) ++result_.strong_b;
      if (found[j] != 0) {
        ++result_.matched;
        energy_matched_ += s * s;
        if (s >= strong) ++result_.strong_matched;
      } else {
        MissedPath missed = place;
        missed.level_db = 20.0 * std::log10(s / peak);
        missed.path = b[j];
        result_.missed.push_back(missed);
      }
    }
  }

  ArrivalDifference finish() {
    if (energy_b_ > 0.0) {
      result_.energy_matched_pct = 100.0 * energy_matched_ / energy_b_;
      result_.energy_db = 10.0 * std::log10(energy_a_ / energy_b_);
    }
    result_.amplitude_db = spread_of(std::move(amplitude_));
    result_.delay_us = spread_of(std::move(delay_));
    result_.phase_deg = spread_of(std::move(phase_));
    result_.launch_deg = spread_of(std::move(launch_));
    result_.arrival_deg = spread_of(std::move(arrival_));
    result_.sum_db = spread_of(std::move(sum_));
    std::stable_sort(
        result_.missed.begin(), result_.missed.end(),
        [](const MissedPath& x, const MissedPath& y) { return x.level_db > y.level_db; });
    return std::move(result_);
  }

 private:
  void add_pair(const ArrivalRow& a, const ArrivalRow& b, double amplitude_db) {
    amplitude_.push_back(amplitude_db);
    delay_.push_back(1e6 * (a.delay - b.delay));
    phase_.push_back(wrapped(a.phase_deg - b.phase_deg));
    launch_.push_back(a.launch_angle_deg - b.launch_angle_deg);
    arrival_.push_back(a.arrival_angle_deg - b.arrival_angle_deg);
  }

  /// The field at the receiver, as the rows give it.
  void add_sum(const Rows& a, const Rows& b) {
    Complex pa = 0.0, pb = 0.0;
    for (const ArrivalRow& row : a)
      if (finite(row)) pa += pressure(row, frequency_, 0.0);
    for (const ArrivalRow& row : b)
      if (finite(row)) pb += pressure(row, frequency_, 0.0);
    if (std::abs(pa) > 0.0 && std::abs(pb) > 0.0)
      sum_.push_back(20.0 * std::log10(std::abs(pb) / std::abs(pa)));  // ΔTL = TL(A) − TL(B)
  }

  double frequency_;
  ArrivalOptions options_;
  ArrivalDifference result_;
  double energy_a_ = 0.0, energy_b_ = 0.0, energy_matched_ = 0.0;
  std::vector<double> amplitude_, delay_, phase_, launch_, arrival_, sum_;
};

void check_receivers(const std::string& axis, const std::vector<double>& a,
                     const std::vector<double>& b) {
  // Depths and ranges are float32 in the files.
  const auto same = [](double x, double y) { return std::abs(x - y) <= 1e-3 + 1e-6 * std::abs(y); };
  if (a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(), same)) return;
  std::ostringstream got;
  got << a.size() << " in A, " << b.size() << " in B";
  if (a.size() == b.size()) got << ", not all of them at the same place";
  throw InputError(
      {.where = "receivers: " + axis, .got = got.str(), .expected = "the same in both"});
}

}  // namespace

double ArrivalDifference::matched_pct() const noexcept { return share_pct(matched, paths_b); }

double ArrivalDifference::strong_matched_pct() const noexcept {
  return share_pct(strong_matched, strong_b);
}

Rows join_beams(const Rows& arrivals, double frequency, const ArrivalOptions& options) {
  Rows sorted;
  std::copy_if(arrivals.begin(), arrivals.end(), std::back_inserter(sorted), finite);
  std::stable_sort(sorted.begin(), sorted.end(), [](const ArrivalRow& x, const ArrivalRow& y) {
    return std::tie(x.surface_bounces, x.bottom_bounces, x.delay) <
           std::tie(y.surface_bounces, y.bottom_bounces, y.delay);
  });
  if (options.join_delay <= 0.0) return sorted;
  const auto neighbours = [&](const ArrivalRow& x, const ArrivalRow& y) {
    return history(x) == history(y) && y.delay - x.delay <= options.join_delay &&
           std::abs(y.launch_angle_deg - x.launch_angle_deg) <= options.join_angle_deg;
  };
  Rows paths;
  for (auto first = sorted.cbegin(); first != sorted.cend();) {
    auto last = first + 1;
    while (last != sorted.cend() && neighbours(*(last - 1), *last)) ++last;
    paths.push_back(join(first, last, frequency));
    first = last;
  }
  return paths;
}

ArrivalDifference compare_arrivals(const bellhop::ArrivalsFile& a, const bellhop::ArrivalsFile& b,
                                   const ArrivalOptions& options) {
  check_receivers("source depths", a.source_depths, b.source_depths);
  check_receivers("depths", a.receiver_depths, b.receiver_depths);
  check_receivers("ranges", a.receiver_ranges, b.receiver_ranges);
  // one plane of a map is comparable with a file that tells nothing of a map
  const bool planes = a.map.planes() == 1 && b.map.planes() == 1;
  if (!planes || (a.map.is_map() && b.map.is_map())) {
    check_receivers("azimuths", a.map.azimuths_deg, b.map.azimuths_deg);
    check_receivers("source x", a.map.source_x, b.map.source_x);
    check_receivers("source y", a.map.source_y, b.map.source_y);
  }
  if (a.arrivals.size() != b.arrivals.size())
    throw InputError({.where = "receivers",
                      .got = std::to_string(a.arrivals.size()) + " in A, " +
                             std::to_string(b.arrivals.size()) + " in B",
                      .expected = "the same in both"});
  const std::size_t ranges = b.receiver_ranges.size();
  const std::size_t rows = b.irregular ? 1 : b.receiver_depths.size();
  Gatherer gatherer(b.frequency, options);
  for (std::size_t i = 0; i < b.arrivals.size(); ++i)
    gatherer.receiver(a.arrivals[i], b.arrivals[i],
                      {.source = i / (rows * ranges) % b.source_depths.size(),
                       .row = i / ranges % rows,
                       .range = i % ranges,
                       .plane = i / (rows * ranges) / b.source_depths.size()});
  return gatherer.finish();
}

}  // namespace asdic::detail::compare
