#include "processing/coverage/echo_mean.h"

#include <algorithm>
#include <cmath>

#include "raytrace/math/gauss_legendre.h"

namespace asdic::detail {
namespace {

constexpr double faintest = 1e-5;  // power of a pair over the loudest that may be left out
constexpr double unheard = 1e-3;   // of an answer's energy, that may be left out of its phases
constexpr std::size_t few_times = 5, many_times = 64;  // at which pairs are added up
constexpr double slow = 4.0;  // standard deviation of phases that eight places tell [rad]

constexpr double exponential_db = 5.57;  // an exponential law's standard deviation

/// Standard deviation of what is even over a width.
double deviation_of_even(double width) noexcept { return width / std::sqrt(12.0); }

}  // namespace

/// All pairs that may be heard, the loudest first, with their phases.
void EchoMeans::pair_up(std::span<const EchoLeg> out, std::span<const EchoLeg> back,
                        const EchoCell& cell) {
  pairs_.clear();
  double loudest = 0.0;
  const Vec2 beside(-cell.outward.y(), cell.outward.x());
  for (std::size_t i = 0; i < out.size(); ++i)
    for (std::size_t j = 0; j < back.size(); ++j) {
      const EchoLeg &a = out[i], &b = back[j];
      const std::complex<double> open = a.amplitude * b.amplitude;
      const std::complex<double> pressure = open * a.sent;
      const double power = std::norm(pressure);
      if (!(power > faintest * loudest)) continue;
      loudest = std::max(loudest, power);
      const Vec2 slowness = a.slowness + b.slowness;
      pairs_.push_back({pressure, open, a.delay + b.delay, slowness.dot(cell.outward),
                        slowness.dot(beside), power, b.elevation});
    }
  std::erase_if(pairs_, [&](const Pair& p) { return !(p.power > faintest * loudest); });
  sort_by_power();
  const double omega = 2.0 * pi * frequency_, along = omega * deviation_of_even(cell.length),
               across = omega * deviation_of_even(cell.width);
  for (Pair& p : pairs_) {
    const auto turn = std::polar(1.0, -omega * (p.delay - pairs_.front().delay));
    p.pressure *= turn;
    p.open *= turn;
    p.along *= along;
    p.across *= across;
  }
}

/// Pairs are large: their order is found first.
void EchoMeans::sort_by_power() {
  order_.clear();
  for (std::size_t i = 0; i < pairs_.size(); ++i)
    order_.emplace_back(pairs_[i].power, static_cast<std::uint32_t>(i));
  std::sort(order_.begin(), order_.end(), [](const auto& a, const auto& b) {
    return a.first != b.first ? a.first > b.first : a.second < b.second;
  });
  heard_.clear();
  for (const auto& [power, i] : order_) heard_.push_back(pairs_[i]);
  std::swap(pairs_, heard_);
}

/// Delays at which the filter may answer loudest: of pairs that it resolves, by the energy that it
/// receives there. What that comes to with its phases may be nothing; then another answers.
void EchoMeans::choose_times(double apart, std::size_t most) {
  constexpr double least = 0.1;  // of the most energy
  times_.clear();
  if (pairs_.size() > TurnedSum::few)
    list_times_of_many(apart);
  else
    list_times(apart);
  std::stable_sort(times_.begin(), times_.end(),
                   [](const Time& a, const Time& b) { return a.energy > b.energy; });
  if (times_.size() > most) times_.resize(most);
  while (times_.size() > 1 && times_.back().energy < least * times_.front().energy)
    times_.pop_back();
}

void EchoMeans::list_times(double apart) {
  for (const Pair& p : pairs_) {
    if (std::any_of(times_.begin(), times_.end(),
                    [&](const Time& known) { return std::abs(known.at - p.delay) < apart; }))
      continue;
    Time time{.at = p.delay, .elevation = p.elevation, .energy = 0.0};
    for (const Pair& q : pairs_) time.energy += q.power * std::norm(pulse_(p.delay - q.delay));
    times_.push_back(time);
  }
}

/// The same times; their energies from those of pairs within sixteenths of what is resolved.
void EchoMeans::list_times_of_many(double apart) {
  const auto [first, last] = std::minmax_element(
      pairs_.begin(), pairs_.end(), [](const Pair& a, const Pair& b) { return a.delay < b.delay; });
  const double begin = first->delay, length = last->delay - begin;
  constexpr double most_bins = 1 << 16;
  const double step = std::max(resolved_ / 16.0, length / most_bins);
  const auto bin_of = [&](double delay) {
    return static_cast<std::size_t>((delay - begin) / step);
  };
  energies_.assign(bin_of(last->delay) + 1, 0.0);
  for (const Pair& p : pairs_) energies_[bin_of(p.delay)] += p.power;
  coherence_.clear();  // of delays that many bins apart
  for (std::size_t k = 0; k < energies_.size(); ++k) {
    const double later = static_cast<double>(k) * step;
    if (later > pulse_.duration()) break;
    coherence_.push_back(std::norm(pulse_(later)));
  }
  // Times in slots as long as they are apart: no slot holds two, and what is near one of a slot is
  // in that or a neighbour.
  const auto slot_of = [&](double delay) {
    return static_cast<std::size_t>((delay - begin) / apart) + 1;
  };
  taken_.assign(slot_of(last->delay) + 2, 0);
  for (const Pair& p : pairs_) {
    const std::size_t slot = slot_of(p.delay);
    const auto near = [&](std::size_t of) {
      return taken_[of] > 0 && std::abs(times_[taken_[of] - 1].at - p.delay) < apart;
    };
    if (near(slot - 1) || near(slot) || near(slot + 1)) continue;
    Time time{.at = p.delay, .elevation = p.elevation, .energy = 0.0};
    const std::size_t bin = bin_of(p.delay), reach = coherence_.size() - 1;
    const std::size_t low = bin > reach ? bin - reach : 0;
    for (std::size_t k = low; k < std::min(energies_.size(), bin + reach + 1); ++k)
      time.energy += energies_[k] * coherence_[k > bin ? k - bin : bin - k];
    times_.push_back(time);
    taken_[slot] = static_cast<std::uint32_t>(times_.size());
  }
}

/// Whether the phases of no two pairs turn against one another by much.
bool EchoMeans::turns_slowly() const {
  const auto [least, most] = std::minmax_element(
      pairs_.begin(), pairs_.end(), [](const Pair& a, const Pair& b) { return a.along < b.along; });
  const auto [left, right] =
      std::minmax_element(pairs_.begin(), pairs_.end(),
                          [](const Pair& a, const Pair& b) { return a.across < b.across; });
  return most->along - least->along < slow && right->across - left->across < 0.1 * slow;
}

/// By Gauss' rule over the cell's length.
EchoMean EchoMeans::over_places() {
  EchoMean found;
  choose_times(0.25 * resolved_, many_times);
  const std::size_t n = pairs_.size();
  answers_.clear();
  for (const Time& time : times_)
    for (const Pair& p : pairs_) answers_.push_back(pulse_(time.at - p.delay));
  double greatest = 0.0, mean = 0.0, square = 0.0;
  const double half = std::sqrt(3.0);  // of what is even, in standard deviations
  gauss_legendre<8>(-half, half, [&](double at, double width) {
    places_.clear();
    for (const Pair& p : pairs_) {
      const auto turn = std::polar(1.0, -at * (p.along - pairs_.front().along));
      places_.push_back(p.pressure * turn);
      places_.push_back(p.open * turn);
    }
    double loudest = 0.0, open = 0.0;
    for (std::size_t t = 0; t < times_.size(); ++t) {
      std::complex<double> sum = 0.0, open_sum = 0.0;
      for (std::size_t i = 0; i < n; ++i) {
        sum += places_[2 * i] * answers_[t * n + i];
        open_sum += places_[2 * i + 1] * answers_[t * n + i];
      }
      loudest = std::max(loudest, std::norm(sum));
      open = std::max(open, std::norm(open_sum));
      if (std::norm(sum) <= greatest) continue;
      greatest = std::norm(sum);
      found.delay = times_[t].at;
      found.elevation = times_[t].elevation;
    }
    const double weight = width / (2.0 * half);
    found.open_power += weight * open;
    mean += weight * loudest;
    square += weight * loudest * loudest;
  });
  found.power = mean;
  if (mean > 0.0)
    found.spread_db =
        std::min(exponential_db,
                 db_per_neper / 2.0 * std::sqrt(std::max(0.0, square / (mean * mean) - 1.0)));
  return found;
}

EchoMean EchoMeans::operator()(std::span<const EchoLeg> out, std::span<const EchoLeg> back,
                               const EchoCell& cell) {
  pair_up(out, back, cell);
  if (pairs_.empty()) return {};
  EchoMean found = turns_slowly() ? over_places() : over_phases();
  // As if every phase were another one: 1 − Σp²/(Σp)² of the power fluctuates.
  double sum = 0.0, squares = 0.0;
  for (const Pair& p : pairs_) {
    const double power = p.power * std::norm(pulse_(found.delay - p.delay));
    sum += power;
    squares += power * power;
  }
  // A single path falls over the cell, too.
  found.spread_db = std::hypot(found.spread_db, cell.falls_db);
  if (sum > 0.0)
    found.phases_db = exponential_db * std::sqrt(std::max(0.0, 1.0 - squares / (sum * sum)));
  return found;
}

EchoMean EchoMeans::over_phases() {
  constexpr double nothing = 18.0;  // e⁻⁹
  EchoMean found;
  choose_times(resolved_, few_times);
  for (const Time& time : times_) {
    heard_.clear();
    double power = 0.0, open = 0.0, apart = 0.0;
    for (const Pair& p : pairs_) {
      const std::complex<double> answer = pulse_(time.at - p.delay);
      Pair here = p;
      here.pressure *= answer;
      here.open *= answer;
      here.power = std::norm(here.pressure);
      power += here.power;
      open += std::norm(here.open);
      if (here.power * static_cast<double>(pairs_.size()) > unheard * time.energy)
        heard_.push_back(here);
    }
    if (heard_.size() > TurnedSum::few) {
      turning_.clear();
      double own = 0.0, own_open = 0.0;
      for (const Pair& p : heard_) {
        turning_.push_back({p.pressure, p.open, p.along, p.across, p.power});
        own += p.power;
        own_open += std::norm(p.open);
      }
      const TurnedSum::Sums sums = turned_sum_(turning_);
      power += sums.power - own;
      open += sums.open - own_open;
      apart = std::max(0.0, own * own - sums.kept);
      heard_.clear();
    }
    for (std::size_t i = 0; i < heard_.size(); ++i) {
      const Pair& a = heard_[i];
      for (std::size_t j = 0; j < i; ++j) {
        const Pair& b = heard_[j];
        const double x = a.along - b.along, y = a.across - b.across, turned = x * x + y * y;
        if (turned > nothing) {
          apart += 2.0 * a.power * b.power;
          continue;
        }
        const double kept = std::exp(-0.5 * turned);
        power += 2.0 * kept * std::real(a.pressure * std::conj(b.pressure));
        open += 2.0 * kept * std::real(a.open * std::conj(b.open));
        apart += 2.0 * (1.0 - kept * kept) * a.power * b.power;
      }
    }
    found.open_power = std::max(found.open_power, open);
    if (!(power > found.power)) continue;
    found.power = power;
    found.delay = time.at;
    found.elevation = time.elevation;
    // By how much of the power changes over the cell.
    found.spread_db = exponential_db * std::min(1.0, std::sqrt(std::max(0.0, apart)) / power);
  }
  if (times_.size() > 1 && found.power > 0.0) add_louder_times(found);
  return found;
}

/// ⟨max_t|y|²⟩ − ⟨|y|²⟩ at the loudest time: at each place of a cell another answer may be the
/// loudest. A mean over few places, which the mean of the powers themselves is not.
void EchoMeans::add_louder_times(EchoMean& found) {
  constexpr int places = 6;
  constexpr double heard = 3e-3;  // over the loudest: fainter pairs choose no other time
  constexpr double first = 0.7548776662466927, second = 0.5698402909980532;  // even over a square
  const double width = std::sqrt(12.0);  // of what is even, in standard deviations
  const auto loud = static_cast<std::size_t>(
      std::partition_point(pairs_.begin(), pairs_.end(),
                           [&](const Pair& p) { return p.power > heard * pairs_[0].power; }) -
      pairs_.begin());
  const std::span<const Pair> pairs(pairs_.data(), loud);
  answers_.clear();
  std::size_t at = 0;
  for (const Time& time : times_) {
    if (time.at == found.delay) at = answers_.size() / loud;
    for (const Pair& p : pairs) answers_.push_back(pulse_(time.at - p.delay));
  }
  double louder = 0.0, open_louder = 0.0;
  for (int k = 0; k < places; ++k) {
    const double u = std::fmod(first * (k + 1), 1.0) - 0.5,
                 v = std::fmod(second * (k + 1), 1.0) - 0.5;
    places_.clear();
    for (const Pair& p : pairs) {
      const auto turn = std::polar(1.0, -width * (u * p.along + v * p.across));
      places_.push_back(p.pressure * turn);
      places_.push_back(p.open * turn);
    }
    double most = 0.0, here = 0.0, open_most = 0.0, open_here = 0.0;
    for (std::size_t t = 0; t < times_.size(); ++t) {
      std::complex<double> sum = 0.0, open = 0.0;
      const std::complex<double>* const answer = &answers_[t * loud];
      for (std::size_t i = 0; i < loud; ++i) {
        sum += places_[2 * i] * answer[i];
        open += places_[2 * i + 1] * answer[i];
      }
      most = std::max(most, std::norm(sum));
      open_most = std::max(open_most, std::norm(open));
      if (t == at) here = std::norm(sum), open_here = std::norm(open);
    }
    louder += (most - here) / places;
    open_louder += (open_most - open_here) / places;
  }
  found.power += louder;
  found.open_power += open_louder;
}

}  // namespace asdic::detail
