#include "study/measures/echo_filter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstdio>
#include <functional>
#include <map>
#include <optional>

#include "core/error.h"
#include "core/geometry.h"
#include "core/units.h"
#include "processing/log_trend.h"
#include "processing/matched_filter.h"
#include "processing/normaliser.h"
#include "processing/signal_excess.h"
#include "sonar/noise/noise_spectrum.h"
#include "sonar/scenario/sampling.h"
#include "sonar/scenario/scenario.h"
#include "sonar/signal/pulse_coherence.h"
#include "study/measures/expected_power.h"
#include "study/plan/no_value.h"

namespace asdic::detail::study {
namespace {

/// What is listened for: the strongest path of a target.
struct Listened {
  double delay = 0.0, doppler = 1.0;
  Vec3 slowness = Vec3::Zero();  // [s/m]
  std::vector<MatchedFilterAt::Phone> phones;
};

const EchoPath* strongest(const PingRecord& record, int array, int target, int channel) {
  const EchoPath* best = nullptr;
  for (const EchoPath& echo : record.echoes)
    if (echo.array == array && echo.target == target &&
        (channel == Return::all_channels || echo.received.channel == channel) &&
        (best == nullptr || echo.level_db > best->level_db))
      best = &echo;
  return best;
}

/// The cells of an echo: those in which the filter answers to all pairs of the target's paths with
/// at least a tenth of the most power that it answers with in any. \param cell  its length [s]
/// \return numbers of cells after the strongest pair, rising; {0} if there is no path
std::vector<std::ptrdiff_t> cells_of(const PingRecord& record, int array, int target,
                                     const Pulse& pulse, double cell) {
  constexpr double faintest = 0.1;
  constexpr double reach = 8.0;  // cells from a pair, beyond which its answer is 4 % at most
  const EchoPath* loudest = strongest(record, array, target, Return::all_channels);
  if (loudest == nullptr) return {0};
  const auto coherence = pulse_coherence(pulse);
  std::map<std::ptrdiff_t, std::complex<double>> answers;
  for (const EchoPath& echo : record.echoes) {
    if (echo.array != array || echo.target != target ||
        echo.received.channel != loudest->received.channel)
      continue;
    const double later = echo.received.delay - loudest->received.delay;
    const std::complex<double> amplitude =
        echo.received.amplitude *
        std::polar(1.0, -2.0 * pi * std::fmod(pulse.centre_frequency() * later, 1.0));
    const auto first = static_cast<std::ptrdiff_t>(std::ceil(later / cell - reach)),
               last = static_cast<std::ptrdiff_t>(std::floor(later / cell + reach));
    for (std::ptrdiff_t k = first; k <= last; ++k) {
      const double after = static_cast<double>(k) * cell - later;
      const std::complex<double> alike = (*coherence)(std::abs(after));
      answers[k] += amplitude * (after < 0.0 ? std::conj(alike) : alike);
    }
  }
  double most = 0.0;
  for (const auto& [at, answer] : answers) most = std::max(most, std::norm(answer));
  std::vector<std::ptrdiff_t> cells;
  for (const auto& [at, answer] : answers)
    if (std::norm(answer) >= faintest * most) cells.push_back(at);
  return cells;
}

/// Length of a cell, 1/B, the matched filter's resolution [samples].
std::ptrdiff_t cell_samples(const Pulse& pulse, double sample_rate) {
  return static_cast<std::ptrdiff_t>(std::ceil(sample_rate / noise_bandwidth(pulse)));
}

/// u = −ln P of the highest of n independent cells, where P is the probability that without an echo
/// at least one of them is as high. \param level  the highest cell's own u
double level_among(double level, std::size_t n) {
  const double number = static_cast<double>(n);
  if (n == 1) return level;
  if (level > 30.0) return level - std::log(number);  // to n·e⁻³⁰
  const double none = number * std::log1p(-std::exp(-level));
  return none < -1.0 ? -std::log1p(-std::exp(none)) : -std::log(-std::expm1(none));
}

Listened listened(const PingSimulator& simulator, const PingRecord& record,
                  const MatchedFilterPlan& plan, int array, int target, const Vec3& reference) {
  const Scenario& scenario = simulator.scenario();
  const std::size_t first = first_channel(scenario, array);
  const std::size_t phones = scenario.arrays[static_cast<std::size_t>(array)].phones.size();
  Listened all;
  Vec3 slowness = Vec3::Zero();
  const EchoPath* loudest = strongest(record, array, target, Return::all_channels);
  if (loudest != nullptr) {
    all.delay = loudest->received.delay;
    all.doppler = loudest->received.doppler;
    slowness = loudest->received.slowness;
  } else {
    const Vec3 place = record.targets[static_cast<std::size_t>(target)].position;
    const double c = simulator.paths().speed_at(reference);
    all.delay = ((place - record.platform.position).norm() + (place - reference).norm()) / c;
    slowness = (reference - place).normalized() / c;
  }
  all.slowness = slowness;
  for (std::size_t n = 0; n < phones; ++n) {
    if (plan.phone && static_cast<std::size_t>(*plan.phone) != n) continue;
    double delay = all.delay + slowness.dot(record.phones[first + n] - reference);
    if (loudest != nullptr && loudest->received.channel != Return::all_channels)
      if (const EchoPath* own = strongest(record, array, target, static_cast<int>(n)))
        delay = own->received.delay +  // a path of each phone's own, told at the reference point
                own->received.slowness.dot(record.phones[first + n] - reference);
    all.phones.push_back({first + n, delay});
  }
  return all;
}

/// What the filter needs so many samples after the echo.
SampleRange needed_by(const MatchedFilterAt& filter, std::ptrdiff_t shift) {
  return {.first = filter.first() + shift,
          .count = static_cast<std::size_t>(filter.end() - filter.first())};
}

/// A part of the record has all of that.
bool holds(const SampleRange& part, const MatchedFilterAt& filter, std::ptrdiff_t shift) {
  return filter.first() + shift >= part.first &&
         filter.end() + shift <= part.first + static_cast<std::ptrdiff_t>(part.count);
}

/// How far from an echo its filter still answers to it, over so much of |A|².
class Ringing {
 public:
  /// \param ratio  Doppler factor of the echo over the filter's
  Ringing(const Pulse& pulse, double ratio) {
    step_ = 0.25 / std::max(pulse.bandwidth_99(), 2.0 / pulse.duration());
    const auto n = static_cast<std::ptrdiff_t>(std::ceil(pulse.duration() / step_)) + 1;
    std::vector<std::complex<double>> own, other;
    double energy = 0.0;
    for (std::ptrdiff_t i = 0; i < n; ++i) {
      const double t = static_cast<double>(i) * step_;
      own.push_back(std::conj(pulse.analytic(t)));
      other.push_back(pulse.analytic(ratio * t));
      energy += std::norm(own.back());
    }
    for (std::ptrdiff_t shift = 0; shift < n; ++shift) {
      std::complex<double> late = 0.0, early = 0.0;
      for (std::ptrdiff_t i = shift; i < n; ++i) {
        late += other[static_cast<std::size_t>(i)] * own[static_cast<std::size_t>(i - shift)];
        early += other[static_cast<std::size_t>(i - shift)] * own[static_cast<std::size_t>(i)];
      }
      most_.push_back(std::max(std::norm(late), std::norm(early)) / (energy * energy));
    }
    for (std::size_t i = most_.size() - 1; i-- > 0;) most_[i] = std::max(most_[i], most_[i + 1]);
  }
  /// [s]
  [[nodiscard]] double reach(double power) const {
    const auto it = std::find_if(most_.begin(), most_.end(), [&](double x) { return x < power; });
    return static_cast<double>(it - most_.begin()) * step_;
  }

 private:
  double step_ = 0.0;
  std::vector<double> most_;  // |χ|² at this offset and beyond
};

/// Times at which the array receives the ping: echoes of any target, and the ping on its way out.
class Busy {
 public:
  /// \param duration  of the pulse as it is received [s]   \param reference  the array's point
  /// \param heard  E|y|² of noise alone: echoes are left out only as far as the filter's answer to
  /// them is over a thirtieth of that; 0: as far as the pulses overlap
  Busy(const PingSimulator& simulator, const PingRecord& record, const Listened& echo, int array,
       double duration, const Vec3& reference, double heard = 0.0)
      : rate_(record.recording.sample_rate) {
    // Two pulses that are one duration apart have nothing in common; the rest is for windows that
    // ring and for Doppler.
    const double apart = 1.1 * duration;
    double reach = 0.0;
    for (const MatchedFilterAt::Phone& phone : echo.phones)
      reach = std::max(reach, (record.phones[phone.channel] - reference).norm());
    const Pulse& pulse = simulator.pulse(record.transmitter);
    std::vector<std::pair<double, Ringing>> known;  // by the ratio of Doppler factors
    const auto apart_of = [&](const EchoPath& other) {
      if (!(heard > 0.0)) return apart;
      constexpr double share = 1.0 / 30.0;
      const double power = 2.0 * power_from_db(other.level_db) * micropascal * micropascal;
      const double cycles = pulse.centre_frequency() * pulse.duration(),
                   ratio = other.received.doppler / echo.doppler;
      auto it = std::find_if(known.begin(), known.end(), [&](const auto& one) {
        return std::abs(one.first - ratio) * cycles < 0.05;
      });
      if (it == known.end()) it = known.insert(it, {ratio, Ringing(pulse, ratio)});
      return std::min(apart, it->second.reach(share * heard / power));
    };
    for (const EchoPath& other : record.echoes) {
      if (other.array != array) continue;
      double spread = 0.0;  // in time over the phones, once they are steered at the target
      for (const MatchedFilterAt::Phone& phone : echo.phones)
        spread = std::max(spread, std::abs((other.received.slowness - echo.slowness)
                                               .dot(record.phones[phone.channel] - reference)));
      const double half = apart_of(other);
      if (half > 0.0) add(other.received.delay - echo.delay, half + spread);
    }
    const double c = simulator.paths().speed_at(reference);
    for (const ManyEchoes& many : record.many_echoes)  // whose pairs are not all listed
      if (many.array == array)
        add(0.5 * (many.first + many.last) - echo.delay,
            0.5 * (many.last - many.first) + apart + 2.0 * reach / c);
    for (const Leg& leg : record.legs)  // the direct blast: from whatever side
      if (leg.kind == Leg::Kind::source_to_array && leg.array == array)
        for (const Arrival& path : leg.arrivals)
          add(path.delay - echo.delay, apart + 2.0 * reach / c);
  }

  /// The filter receives nothing of them when it listens so many samples after the echo.
  [[nodiscard]] bool free(std::ptrdiff_t shift) const {
    const double t = static_cast<double>(shift) / rate_;
    return std::none_of(spans_.begin(), spans_.end(),
                        [&](const Span& busy) { return busy.first < t && t < busy.second; });
  }

 private:
  using Span = std::pair<double, double>;  // [s] after the echo
  void add(double middle, double half) { spans_.emplace_back(middle - half, middle + half); }

  double rate_;
  std::vector<Span> spans_;
};

/// Tells whether a cell is free, so many samples after the echo.
using IsFree = std::function<bool(std::ptrdiff_t shift)>;

/// The nearest free cells on both sides, whole cells away: `reference_cells` on either; where the
/// record has fewer on one side, the other makes up for them. Empty where there are fewer than
/// half of what is asked for: a threshold over a handful of cells detects next to nothing.
std::vector<std::ptrdiff_t> reference_cells(const MatchedFilterPlan& plan,
                                            const SampleRange& record,
                                            const MatchedFilterAt& filter, const IsFree& free,
                                            std::ptrdiff_t at, std::ptrdiff_t cell) {
  const auto guard = static_cast<std::ptrdiff_t>(plan.guard_cells);
  const auto wanted = static_cast<std::size_t>(plan.reference_cells);
  const auto side = [&](std::ptrdiff_t step) {
    std::vector<std::ptrdiff_t> found;
    for (std::ptrdiff_t shift = at + (guard + 1) * step;
         found.size() < 2 * wanted && holds(record, filter, shift); shift += step)
      if (free(shift)) found.push_back(shift);
    return found;
  };
  std::vector<std::ptrdiff_t> before = side(-cell), after = side(cell);
  const std::size_t of_before =
      std::min(before.size(), std::max(wanted, 2 * wanted - std::min(2 * wanted, after.size())));
  const std::size_t of_after = std::min(after.size(), 2 * wanted - of_before);
  before.resize(of_before);
  before.insert(before.end(), after.begin(), after.begin() + static_cast<std::ptrdiff_t>(of_after));
  if (before.size() < wanted) before.clear();
  return before;
}

/// One target's filter, and where in the whole record it listens.
class TargetFilter {
 public:
  TargetFilter(const PingSimulator& simulator, const PingRecord& record,
               const MatchedFilterPlan& plan, int array, int target)
      : plan_(plan),
        whole_(recording_of(simulator.scenario())),
        pulse_(simulator.pulse(record.transmitter)),
        reference_(simulator.geometry(record.ping).reference_place(array).position),
        echo_(listened(simulator, record, plan, array, target, reference_)),
        filter_({.sample_rate = whole_.sample_rate,
                 .start = whole_.start,
                 .samples = whole_.samples,
                 .carrier = whole_.carrier,
                 .epoch = record.recording.epoch},
                pulse_, echo_.doppler, echo_.phones),
        duration_(pulse_.duration() / echo_.doppler),
        busy_(simulator, record, echo_, array, duration_, reference_),
        near_(simulator, record, echo_, array, duration_, reference_,
              plan.background == MatchedFilterPlan::Background::trend
                  ? filter_.noise(
                        noise_density(simulator.scenario().noise, pulse_.centre_frequency()))
                  : 0.0),
        cell_(cell_samples(pulse_, whole_.sample_rate)),
        spread_(cells_of(record, array, target, pulse_,
                         static_cast<double>(cell_) / whole_.sample_rate)) {}
  TargetFilter(const TargetFilter&) = delete;
  TargetFilter& operator=(const TargetFilter&) = delete;

  [[nodiscard]] const MatchedFilterAt& filter() const noexcept { return filter_; }

  /// A cell and the cells that it is compared with [samples after the echo].
  struct Place {
    std::ptrdiff_t at = 0;
    std::vector<std::ptrdiff_t> around{};
  };
  /// Cells that are tested together by the highest of them.
  using Window = std::vector<Place>;

  /// The cells of the echo that can be tested within the record; none: the answer is not known.
  [[nodiscard]] Window echo() const {
    return window(0, [](std::ptrdiff_t) { return true; });
  }
  /// The same cells moved to the nearest time without an echo, those that are free there. Of two
  /// equally near times the earlier one is taken.
  [[nodiscard]] Window without_echo() const {
    const auto step = static_cast<std::ptrdiff_t>(std::ceil(duration_ * whole_.sample_rate));
    const auto most = static_cast<std::ptrdiff_t>(whole_.samples) / step + 1;
    for (std::ptrdiff_t k = 2; k <= most; ++k)
      for (const std::ptrdiff_t moved : {-k * step, k * step})
        if (Window found = window(moved, [&](std::ptrdiff_t at) { return free(at); });
            !found.empty())
          return found;
    return {};
  }
  /// Reason why no cell of the echo can be tested; "" if one can.
  [[nodiscard]] std::string why_not_known() const {
    if (!echo().empty()) return "";
    const SampleRange record{.first = 0, .count = whole_.samples};
    const bool there = std::any_of(spread_.begin(), spread_.end(), [&](std::ptrdiff_t cell) {
      return holds(record, filter_, cell * cell_);
    });
    std::array<char, 200> text{};
    if (there)
      static_cast<void>(std::snprintf(
          text.data(), text.size(),
          "fewer than %.0f of the cells around the echo are free of echoes and of the direct sound",
          plan_.reference_cells));
    else
      static_cast<void>(std::snprintf(
          text.data(), text.size(),
          "the echo comes after %.4g s and lasts %.3g s, the record is from %.4g to %.4g s",
          echo_.delay, duration_, whole_.start,
          whole_.start + static_cast<double>(whole_.samples) / whole_.sample_rate));
    return text.data();
  }
  /// Whole cells from the echo that lie in the whole record: the first [samples after the echo],
  /// and how many.
  struct Lattice {
    std::ptrdiff_t first = 0, step = 1;
    std::size_t count = 0;
  };
  [[nodiscard]] Lattice lattice() const {
    const SampleRange record{.first = 0, .count = whole_.samples};
    const auto most = static_cast<std::ptrdiff_t>(whole_.samples) / cell_ + 1;
    Lattice found{.first = 0, .step = cell_, .count = 0};
    const auto middle = static_cast<std::ptrdiff_t>(std::floor(
        (0.5 * static_cast<double>(whole_.samples) - static_cast<double>(filter_.first())) /
        static_cast<double>(cell_)));
    for (std::ptrdiff_t k = middle - most; k <= middle + most; ++k) {
      if (!holds(record, filter_, k * cell_)) continue;
      if (found.count++ == 0) found.first = k * cell_;
    }
    return found;
  }
  /// The same as place(), of which cells are free known beforehand.
  [[nodiscard]] std::vector<std::ptrdiff_t> around(std::ptrdiff_t at, const IsFree& free) const {
    return reference_cells(plan_, {.first = 0, .count = whole_.samples}, filter_, free, at, cell_);
  }
  [[nodiscard]] bool free(std::ptrdiff_t shift) const { return busy_.free(shift); }
  /// For a background: so little is left of an echo that it does not matter there.
  [[nodiscard]] bool near_free(std::ptrdiff_t shift) const { return near_.free(shift); }
  /// When the echo comes [s].
  [[nodiscard]] double delay() const noexcept { return echo_.delay; }
  [[nodiscard]] double doppler() const noexcept { return echo_.doppler; }
  /// |y|² in the cells of a window. \param part  of the whole record that was received
  /// \return [window]; NaN where the part does not hold all of a cell
  [[nodiscard]] std::vector<double> answers(const PingRecord& received, const SampleRange& part,
                                            const Window& window) const {
    const std::size_t samples = received.recording.samples;
    constexpr std::size_t few = 8;  // sums in time; more cells take a transform
    std::vector<double> powers;
    if (window.size() > few) {
      const std::ptrdiff_t first = window.front().at, last = window.back().at;
      const std::vector<double> all =
          filter_.answers(received.pressure, samples, part.first, first, cell_,
                          static_cast<std::size_t>((last - first) / cell_) + 1);
      for (const Place& one : window)
        powers.push_back(all[static_cast<std::size_t>((one.at - first) / cell_)]);
      return powers;
    }
    for (const Place& one : window)
      powers.push_back(holds(part, filter_, one.at)
                           ? filter_.answer(received.pressure, samples, part.first, one.at)
                           : no_value);
    return powers;
  }

 private:
  /// The echo's cells moved by `moved` samples.   \param of  whether to take a cell
  template <class Of>
  [[nodiscard]] Window window(std::ptrdiff_t moved, Of&& of) const {
    Window found;
    for (const std::ptrdiff_t cell : spread_)
      if (const std::ptrdiff_t at = moved + cell * cell_; of(at))
        if (auto one = place(at)) found.push_back(std::move(*one));
    return found;
  }
  /// A cell with the cells around it; none outside the record or with too few free cells around.
  [[nodiscard]] std::optional<Place> place(std::ptrdiff_t at) const {
    using Background = MatchedFilterPlan::Background;
    const SampleRange record{.first = 0, .count = whole_.samples};
    if (!holds(record, filter_, at)) return std::nullopt;
    Place found{.at = at};
    if (plan_.background != Background::around && plan_.background != Background::trend)
      return found;
    found.around = around(at, [&](std::ptrdiff_t shift) { return near_free(shift); });
    return found.around.empty() ? std::nullopt : std::optional(found);
  }

  const MatchedFilterPlan& plan_;
  Recording whole_;
  const Pulse& pulse_;
  Vec3 reference_;  // of the array when the ping is sent
  Listened echo_;
  MatchedFilterAt filter_;
  double duration_;  // of the pulse as it is received [s]
  Busy busy_, near_;
  std::ptrdiff_t cell_;                 // [samples]
  std::vector<std::ptrdiff_t> spread_;  // the echo's cells, after the strongest pair [cells]
};

/// u = −ln P of one cell, P the probability of as high an answer in even Rayleigh noise.
/// Source: docs/theory/studies.md, eq. (12) and (16)
class LevelOverBackground {
 public:
  /// \param noise  E|y|² of white noise alone
  LevelOverBackground(const MatchedFilterPlan& plan, double noise) : plan_(plan), noise_(noise) {}

  /// \param mean  expected power there, for backgrounds that are expected   \return NaN: not known
  [[nodiscard]] double over_mean(double power, double mean) const {
    if (plan_.background == Background::noise) mean = noise_;
    if (!(mean > 0.0)) return no_value;
    const double m = plan_.estimated_from();
    return std::isinf(m) ? power / mean : m * std::log1p(power / mean / m);
  }
  /// \param others  answers of the cells around   \param times  of these, after this cell
  [[nodiscard]] double over_others(double power, std::span<const double> others,
                                   std::span<const double> times) const {
    double sum = 0.0;
    for (const double one : others) sum += one;
    if (!(sum > 0.0)) return no_value;
    const auto m = static_cast<double>(others.size());
    if (plan_.background != Background::trend || m <= 2.0) return m * std::log1p(power / sum);
    if (*std::min_element(others.begin(), others.end()) <= 0.0) return no_value;
    return -log_exceedance_over_trend(others, times, power);
  }
  [[nodiscard]] bool by_others() const noexcept {
    return plan_.background == Background::around || plan_.background == Background::trend;
  }

 private:
  using Background = MatchedFilterPlan::Background;
  const MatchedFilterPlan& plan_;
  double noise_;
};

/// Which part of the whole record a record holds.
SampleRange part_of(const PingSimulator& simulator, const PingRecord& record) {
  const double before =
      record.recording.start - recording_of(simulator.scenario()).start;  // whole samples
  return {.first = std::llround(before * record.recording.sample_rate),
          .count = record.recording.samples};
}

}  // namespace

SampleRange samples_for_filter(const PingSimulator& simulator, const PingRecord& record,
                               const MatchedFilterPlan& plan, int array) {
  // So few that nothing is gained by fewer; lengths in steps, so that what belongs to a length is
  // found again.
  constexpr std::ptrdiff_t few = 256, steps = 8;
  const auto whole = static_cast<std::ptrdiff_t>(recording_of(simulator.scenario()).samples);
  std::ptrdiff_t first = whole, end = 0;
  for (std::size_t target = 0; target < record.targets.size(); ++target) {
    const TargetFilter one(simulator, record, plan, array, static_cast<int>(target));
    const auto add = [&](std::ptrdiff_t shift) {
      const SampleRange needed = needed_by(one.filter(), shift);
      first = std::min(first, needed.first);
      end = std::max(end, needed.first + static_cast<std::ptrdiff_t>(needed.count));
    };
    for (const TargetFilter::Window& window : {one.echo(), one.without_echo()})
      for (const TargetFilter::Place& place : window) {
        add(place.at);
        for (const std::ptrdiff_t shift : place.around) add(shift);
      }
  }
  if (end <= first) first = end = 0;
  std::ptrdiff_t step = few / steps;
  while ((end - first) > 2 * steps * step) step *= 2;
  const std::ptrdiff_t count =
      std::min(whole, std::max(few, (end - first + step - 1) / step * step));
  first = std::min(first, whole - count);
  return {.first = first, .count = static_cast<std::size_t>(count)};
}

FilterAnswer filter_answer(const PingSimulator& simulator, const PingRecord& record,
                           const MatchedFilterPlan& plan, int array, int target,
                           double false_alarm_probability, const ExpectedAnswer& expected) {
  const TargetFilter one(simulator, record, plan, array, target);
  const MatchedFilterAt& filter = one.filter();
  const SampleRange part = part_of(simulator, record);
  const LevelOverBackground level(
      plan, filter.noise(noise_density(simulator.scenario().noise,
                                       simulator.pulse(record.transmitter).centre_frequency())));
  std::vector<double> around, times;
  const auto level_in = [&](const TargetFilter::Place& place, double power, double mean) {
    if (!level.by_others()) return level.over_mean(power, mean);
    around.clear();
    times.clear();
    for (const std::ptrdiff_t shift : place.around) {
      if (!holds(part, filter, shift)) return no_value;
      around.push_back(filter.answer(record.pressure, record.recording.samples, part.first, shift));
      times.push_back(static_cast<double>(shift - place.at));
    }
    return level.over_others(power, around, times);
  };
  // The cell of a window that is least probable by chance represents the window, given as the ratio
  // that is equally improbable in one cell, so that (3) is its threshold.
  const auto compare = [&](const TargetFilter::Window& window, const std::vector<double>& means,
                           double& statistic, double& threshold) {
    const std::vector<double> powers = one.answers(record, part, window);
    double most = no_value, cells = plan.estimated_from();
    std::size_t known = 0;
    for (std::size_t i = 0; i < window.size(); ++i) {
      const double u = level_in(window[i], powers[i], i < means.size() ? means[i] : no_value);
      if (std::isnan(u)) continue;
      ++known;
      if (most >= u) continue;
      most = u;
      if (level.by_others()) cells = static_cast<double>(window[i].around.size());
    }
    statistic = threshold = no_value;
    if (known == 0) return;
    const double u = level_among(most, known);
    statistic = std::isinf(cells) ? u : cells * std::expm1(u / cells);
    threshold = cfar_multiplier(false_alarm_probability, cells);
  };

  FilterAnswer answer;
  compare(one.echo(), expected.present, answer.present, answer.threshold);
  compare(one.without_echo(), expected.absent, answer.absent, answer.absent_threshold);
  if (std::isnan(answer.present)) {
    answer.unknown = one.why_not_known();
    if (answer.unknown.empty())
      answer.unknown = "nothing is received there that the echo could be compared with";
  }
  return answer;
}

int cells_of_echo(const PingSimulator& simulator, const PingRecord& record, int array, int target) {
  const double rate = recording_of(simulator.scenario()).sample_rate;
  const Pulse& pulse = simulator.pulse(record.transmitter);
  const double cell = static_cast<double>(cell_samples(pulse, rate)) / rate;
  return static_cast<int>(cells_of(record, array, target, pulse, cell).size());
}

std::vector<FreeCell> free_cells(const PingSimulator& simulator, const PingRecord& record,
                                 const MatchedFilterPlan& plan, int array, int target,
                                 const ExpectedAnswer& expected) {
  const TargetFilter one(simulator, record, plan, array, target);
  const TargetFilter::Lattice lattice = one.lattice();
  const std::vector<double> powers = one.filter().answers(
      record.pressure, record.recording.samples, part_of(simulator, record).first, lattice.first,
      lattice.step, lattice.count);
  const auto shift_of = [&](std::size_t i) {
    return lattice.first + static_cast<std::ptrdiff_t>(i) * lattice.step;
  };
  const auto at = [&](std::ptrdiff_t shift) {
    return static_cast<std::size_t>((shift - lattice.first) / lattice.step);
  };
  std::vector<char> open(lattice.count), near(lattice.count);
  for (std::size_t i = 0; i < lattice.count; ++i) {
    open[i] = one.free(shift_of(i)) && powers[i] > 0.0 ? 1 : 0;  // NaN: no
    near[i] = one.near_free(shift_of(i)) && powers[i] > 0.0 ? 1 : 0;
  }
  const LevelOverBackground level(
      plan,
      one.filter().noise(noise_density(simulator.scenario().noise,
                                       simulator.pulse(record.transmitter).centre_frequency())));
  std::vector<FreeCell> cells;
  std::vector<double> around, times;
  for (std::size_t i = 0; i < lattice.count; ++i) {
    if (open[i] == 0) continue;
    const std::ptrdiff_t shift = shift_of(i);
    double u = no_value;
    if (!level.by_others()) {
      u = level.over_mean(powers[i], i < expected.cells.size() ? expected.cells[i] : no_value);
    } else {
      around.clear();
      times.clear();
      for (const std::ptrdiff_t other :
           one.around(shift, [&](std::ptrdiff_t s) { return near[at(s)] != 0; })) {
        around.push_back(powers[at(other)]);
        times.push_back(static_cast<double>(other - shift));
      }
      u = level.over_others(powers[i], around, times);
    }
    if (!std::isnan(u))
      cells.push_back({one.delay() + static_cast<double>(shift) / record.recording.sample_rate, u});
  }
  return cells;
}

std::vector<ExpectedAnswer> expected_answers(
    const PingSimulator& simulator, const PingRecord& record, const MatchedFilterPlan& plan,
    int array, bool cells, const std::function<PingRecord(int k, const SampleRange& part)>& draw) {
  const SampleRange part =
      cells ? SampleRange{.first = 0, .count = recording_of(simulator.scenario()).samples}
            : samples_for_filter(simulator, record, plan, array);
  // The ping's own windows and lattice, whatever phones a draw has.
  struct Asked {
    TargetFilter::Window present, absent;
    TargetFilter::Lattice lattice;
  };
  std::vector<ExpectedAnswer> all(record.targets.size());
  std::vector<Asked> asked(all.size());
  for (std::size_t target = 0; target < all.size(); ++target) {
    const TargetFilter own(simulator, record, plan, array, static_cast<int>(target));
    asked[target] = {own.echo(), own.without_echo(), own.lattice()};
    all[target].present.assign(asked[target].present.size(), 0.0);
    all[target].absent.assign(asked[target].absent.size(), 0.0);
    if (cells) all[target].cells.assign(asked[target].lattice.count, 0.0);
  }
  const auto add = [&](const std::vector<double>& powers, std::vector<double>& to) {
    for (std::size_t i = 0; i < to.size(); ++i) to[i] += powers[i] / plan.draws;
  };
  for (int k = 0; k < plan.draws; ++k) {
    PingRecord drawn = draw(k, part);
    const SampleRange there = part_of(simulator, drawn);
    // What it is heard by is where this ping's echoes come from, at the places of its own phones.
    PingRecord heard = record;
    heard.pressure.clear();
    heard.phones = drawn.phones;
    for (std::size_t target = 0; target < all.size(); ++target) {
      const TargetFilter one(simulator, heard, plan, array, static_cast<int>(target));
      add(one.answers(drawn, there, asked[target].present), all[target].present);
      add(one.answers(drawn, there, asked[target].absent), all[target].absent);
      const TargetFilter::Lattice& lattice = asked[target].lattice;
      if (cells)
        add(one.filter().answers(drawn.pressure, drawn.recording.samples, there.first,
                                 lattice.first, lattice.step, lattice.count),
            all[target].cells);
    }
  }
  return all;
}

std::vector<ExpectedAnswer> summed_answers(const PingSimulator& simulator, const PingRecord& record,
                                           const MatchedFilterPlan& plan, int array, bool cells) {
  const ExpectedPower power(simulator, record, array);
  std::vector<ExpectedAnswer> all(record.targets.size());
  for (std::size_t target = 0; target < all.size(); ++target) {
    const TargetFilter one(simulator, record, plan, array, static_cast<int>(target));
    const auto ask = [&](std::size_t count, const auto& shift_of) {
      std::vector<double> later;
      for (std::size_t i = 0; i < count; ++i)
        later.push_back(static_cast<double>(shift_of(i)) / record.recording.sample_rate);
      return power(one.filter(), one.doppler(), later);
    };
    const TargetFilter::Window present = one.echo(), absent = one.without_echo();
    all[target].present = ask(present.size(), [&](std::size_t i) { return present[i].at; });
    all[target].absent = ask(absent.size(), [&](std::size_t i) { return absent[i].at; });
    if (!cells) continue;
    const TargetFilter::Lattice lattice = one.lattice();
    all[target].cells = ask(lattice.count, [&](std::size_t i) {
      return lattice.first + static_cast<std::ptrdiff_t>(i) * lattice.step;
    });
  }
  return all;
}

}  // namespace asdic::detail::study
