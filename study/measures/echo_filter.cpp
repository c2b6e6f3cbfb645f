#include "study/measures/echo_filter.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
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
        cell_(
            static_cast<std::ptrdiff_t>(std::ceil(whole_.sample_rate / noise_bandwidth(pulse_)))) {}
  TargetFilter(const TargetFilter&) = delete;
  TargetFilter& operator=(const TargetFilter&) = delete;

  [[nodiscard]] const MatchedFilterAt& filter() const noexcept { return filter_; }

  /// A time and the cells that it is compared with [samples after the echo].
  struct Place {
    std::ptrdiff_t at = 0;
    std::vector<std::ptrdiff_t> around;
  };
  /// Not known: outside the record or with too few free cells.
  [[nodiscard]] std::optional<Place> place(std::ptrdiff_t at) const {
    const SampleRange record{.first = 0, .count = whole_.samples};
    if (!holds(record, filter_, at)) return std::nullopt;
    Place found{.at = at, .around = {}};
    if (plan_.background == MatchedFilterPlan::Background::noise ||
        plan_.background == MatchedFilterPlan::Background::expected ||
        plan_.background == MatchedFilterPlan::Background::summed)
      return found;
    found.around = reference_cells(
        plan_, record, filter_, [&](std::ptrdiff_t shift) { return near_.free(shift); }, at, cell_);
    return found.around.empty() ? std::nullopt : std::optional(found);
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
  /// Tries the places without an echo, the nearest first and of two the earlier, until one will do.
  template <class Try>
  void where_free(Try&& will_do) const {
    const auto step = static_cast<std::ptrdiff_t>(std::ceil(duration_ * whole_.sample_rate));
    const auto most = static_cast<std::ptrdiff_t>(whole_.samples) / step + 1;
    for (std::ptrdiff_t k = 2; k <= most; ++k)
      for (const std::ptrdiff_t shift : {-k * step, k * step})
        if (busy_.free(shift))
          if (const auto found = place(shift); found && will_do(*found)) return;
  }

 private:
  const MatchedFilterPlan& plan_;
  Recording whole_;
  const Pulse& pulse_;
  Vec3 reference_;  // of the array when the ping is sent
  Listened echo_;
  MatchedFilterAt filter_;
  double duration_;  // of the pulse as it is received [s]
  Busy busy_, near_;
  std::ptrdiff_t cell_;  // [samples]
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
    const auto include = [&](const TargetFilter::Place& place) {
      const auto add = [&](std::ptrdiff_t shift) {
        const SampleRange needed = needed_by(one.filter(), shift);
        first = std::min(first, needed.first);
        end = std::max(end, needed.first + static_cast<std::ptrdiff_t>(needed.count));
      };
      add(place.at);
      for (const std::ptrdiff_t shift : place.around) add(shift);
      return true;
    };
    if (const auto present = one.place(0)) include(*present);
    one.where_free(include);
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
  const Scenario& scenario = simulator.scenario();
  const TargetFilter one(simulator, record, plan, array, target);
  const MatchedFilterAt& filter = one.filter();
  const SampleRange part = part_of(simulator, record);
  const double density =
      noise_density(scenario.noise, simulator.pulse(record.transmitter).centre_frequency());

  const auto answer_at = [&](std::ptrdiff_t shift) {
    return filter.answer(record.pressure, record.recording.samples, part.first, shift);
  };
  using Background = MatchedFilterPlan::Background;
  const auto compare = [&](const TargetFilter::Place& place, double mean, double& statistic,
                           double& threshold) {
    statistic = threshold = no_value;
    if (!holds(part, filter, place.at)) return false;
    if (plan.background == Background::noise) {
      statistic = answer_at(place.at) / filter.noise(density);
      threshold = -std::log(false_alarm_probability);
      return true;
    }
    if (plan.background == Background::expected || plan.background == Background::summed) {
      if (!(mean > 0.0)) return false;
      statistic = answer_at(place.at) / mean;
      threshold = cfar_multiplier(false_alarm_probability, plan.estimated_from());
      return true;
    }
    std::vector<double> powers, times;
    double sum = 0.0;
    for (const std::ptrdiff_t shift : place.around) {
      if (!holds(part, filter, shift)) return false;
      powers.push_back(answer_at(shift));
      times.push_back(static_cast<double>(shift - place.at));
      sum += powers.back();
    }
    if (!(sum > 0.0)) return false;
    const auto cells = static_cast<double>(place.around.size());
    if (plan.background == Background::trend && cells > 2.0) {
      if (*std::min_element(powers.begin(), powers.end()) <= 0.0) return false;
      // The ratio that is as rare over the mean of as many cells without a trend: (3) holds for it.
      statistic =
          cells *
          std::expm1(-log_exceedance_over_trend(powers, times, answer_at(place.at)) / cells);
    } else {
      statistic = answer_at(place.at) * cells / sum;
    }
    threshold = cfar_multiplier(false_alarm_probability, cells);
    return true;
  };

  FilterAnswer answer;
  answer.present = answer.threshold = answer.absent = answer.absent_threshold = no_value;
  if (const auto present = one.place(0))
    compare(*present, expected.present, answer.present, answer.threshold);
  one.where_free([&](const TargetFilter::Place& place) {
    return compare(place, expected.absent, answer.absent, answer.absent_threshold);
  });
  return answer;
}

std::vector<FreeCell> free_cells(const PingSimulator& simulator, const PingRecord& record,
                                 const MatchedFilterPlan& plan, int array, int target,
                                 const ExpectedAnswer& expected) {
  using Background = MatchedFilterPlan::Background;
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
  const double noise = one.filter().noise(noise_density(
      simulator.scenario().noise, simulator.pulse(record.transmitter).centre_frequency()));
  std::vector<FreeCell> cells;
  std::vector<double> around, times;
  for (std::size_t i = 0; i < lattice.count; ++i) {
    if (open[i] == 0) continue;
    const std::ptrdiff_t shift = shift_of(i);
    const double time = one.delay() + static_cast<double>(shift) / record.recording.sample_rate;
    if (plan.background == Background::noise) {
      cells.push_back({time, powers[i] / noise});
      continue;
    }
    if (plan.background == Background::summed) {
      if (i < expected.cells.size() && expected.cells[i] > 0.0)
        cells.push_back({time, powers[i] / expected.cells[i]});
      continue;
    }
    if (plan.background == Background::expected) {
      if (i < expected.cells.size() && expected.cells[i] > 0.0)
        cells.push_back(
            {time, expected.draws * std::log1p(powers[i] / expected.cells[i] / expected.draws)});
      continue;
    }
    around.clear();
    times.clear();
    double sum = 0.0;
    for (const std::ptrdiff_t other :
         one.around(shift, [&](std::ptrdiff_t s) { return near[at(s)] != 0; })) {
      around.push_back(powers[at(other)]);
      times.push_back(static_cast<double>(other - shift));
      sum += around.back();
    }
    if (around.empty()) continue;
    const auto m = static_cast<double>(around.size());
    cells.push_back({time, plan.background == Background::trend && m > 2.0
                               ? -log_exceedance_over_trend(around, times, powers[i])
                               : m * std::log1p(powers[i] / sum)});
  }
  return cells;
}

std::vector<ExpectedAnswer> expected_answers(
    const PingSimulator& simulator, const PingRecord& record, const MatchedFilterPlan& plan,
    int array, bool cells, const std::function<PingRecord(int k, const SampleRange& part)>& draw) {
  const SampleRange part =
      cells ? SampleRange{.first = 0, .count = recording_of(simulator.scenario()).samples}
            : samples_for_filter(simulator, record, plan, array);
  std::vector<ExpectedAnswer> all(record.targets.size());
  for (ExpectedAnswer& one : all) one.draws = plan.draws;
  for (int k = 0; k < plan.draws; ++k) {
    PingRecord drawn = draw(k, part);
    const SampleRange there = part_of(simulator, drawn);
    // What it is heard by is where this ping's echoes come from, at the places of its own phones.
    PingRecord asked = record;
    asked.pressure.clear();
    asked.phones = drawn.phones;
    for (std::size_t target = 0; target < all.size(); ++target) {
      const TargetFilter one(simulator, asked, plan, array, static_cast<int>(target));
      const auto answer_at = [&](std::ptrdiff_t shift) {
        if (!holds(there, one.filter(), shift)) return no_value;
        return one.filter().answer(drawn.pressure, drawn.recording.samples, there.first, shift) /
               plan.draws;
      };
      if (one.place(0)) all[target].present += answer_at(0);
      one.where_free([&](const TargetFilter::Place& place) {
        all[target].absent += answer_at(place.at);
        return true;
      });
      if (!cells) continue;
      // The ping's own lattice, whatever phones this draw has.
      const TargetFilter::Lattice lattice =
          TargetFilter(simulator, record, plan, array, static_cast<int>(target)).lattice();
      const std::vector<double> powers =
          one.filter().answers(drawn.pressure, drawn.recording.samples, there.first, lattice.first,
                               lattice.step, lattice.count);
      all[target].cells.resize(lattice.count, 0.0);
      for (std::size_t i = 0; i < lattice.count; ++i)
        all[target].cells[i] += powers[i] / plan.draws;
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
    std::vector<double> later;
    std::vector<double*> into;
    const auto ask = [&](std::ptrdiff_t shift, double& answer) {
      later.push_back(static_cast<double>(shift) / record.recording.sample_rate);
      into.push_back(&answer);
    };
    if (one.place(0)) ask(0, all[target].present);
    one.where_free([&](const TargetFilter::Place& place) {
      ask(place.at, all[target].absent);
      return true;
    });
    if (cells) {
      const TargetFilter::Lattice lattice = one.lattice();
      all[target].cells.resize(lattice.count);
      for (std::size_t i = 0; i < lattice.count; ++i)
        ask(lattice.first + static_cast<std::ptrdiff_t>(i) * lattice.step, all[target].cells[i]);
    }
    const std::vector<double> answers = power(one.filter(), one.doppler(), later);
    for (std::size_t i = 0; i < into.size(); ++i) *into[i] = answers[i];
  }
  return all;
}

}  // namespace asdic::detail::study
