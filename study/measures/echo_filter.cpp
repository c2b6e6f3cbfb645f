#include "study/measures/echo_filter.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <optional>

#include "core/error.h"
#include "core/geometry.h"
#include "processing/matched_filter.h"
#include "processing/normaliser.h"
#include "processing/signal_excess.h"
#include "sonar/noise/noise_spectrum.h"
#include "sonar/scenario/sampling.h"
#include "sonar/scenario/scenario.h"
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

/// Times at which the array receives the ping: echoes of any target, and the ping on its way out.
class Busy {
 public:
  /// \param duration  of the pulse as it is received [s]   \param reference  the array's point
  Busy(const PingSimulator& simulator, const PingRecord& record, const Listened& echo, int array,
       double duration, const Vec3& reference)
      : rate_(record.recording.sample_rate) {
    // Two pulses that are one duration apart have nothing in common; the rest is for windows that
    // ring and for Doppler.
    const double apart = 1.1 * duration;
    double reach = 0.0;
    for (const MatchedFilterAt::Phone& phone : echo.phones)
      reach = std::max(reach, (record.phones[phone.channel] - reference).norm());
    for (const EchoPath& other : record.echoes) {
      if (other.array != array) continue;
      double spread = 0.0;  // in time over the phones, once they are steered at the target
      for (const MatchedFilterAt::Phone& phone : echo.phones)
        spread = std::max(spread, std::abs((other.received.slowness - echo.slowness)
                                               .dot(record.phones[phone.channel] - reference)));
      add(other.received.delay - echo.delay, apart + spread);
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

/// The nearest free cells on both sides, whole cells away: `reference_cells` on either; where the
/// record has fewer on one side, the other makes up for them. Empty where there are fewer than
/// half of what is asked for: a threshold over a handful of cells detects next to nothing.
std::vector<std::ptrdiff_t> reference_cells(const MatchedFilterPlan& plan,
                                            const SampleRange& record,
                                            const MatchedFilterAt& filter, const Busy& busy,
                                            std::ptrdiff_t at, std::ptrdiff_t cell) {
  const auto guard = static_cast<std::ptrdiff_t>(plan.guard_cells);
  const auto wanted = static_cast<std::size_t>(plan.reference_cells);
  const auto side = [&](std::ptrdiff_t step) {
    std::vector<std::ptrdiff_t> found;
    for (std::ptrdiff_t shift = at + (guard + 1) * step;
         found.size() < 2 * wanted && holds(record, filter, shift); shift += step)
      if (busy.free(shift)) found.push_back(shift);
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
    if (plan_.background == MatchedFilterPlan::Background::noise) return found;
    found.around = reference_cells(plan_, record, filter_, busy_, at, cell_);
    return found.around.empty() ? std::nullopt : std::optional(found);
  }
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
  Busy busy_;
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
                           double false_alarm_probability) {
  const Scenario& scenario = simulator.scenario();
  const TargetFilter one(simulator, record, plan, array, target);
  const MatchedFilterAt& filter = one.filter();
  const SampleRange part = part_of(simulator, record);
  const double density =
      noise_density(scenario.noise, simulator.pulse(record.transmitter).centre_frequency());

  const auto answer_at = [&](std::ptrdiff_t shift) {
    return filter.answer(record.pressure, record.recording.samples, part.first, shift);
  };
  const auto compare = [&](const TargetFilter::Place& place, double& statistic, double& threshold) {
    statistic = threshold = no_value;
    if (!holds(part, filter, place.at)) return false;
    if (plan.background == MatchedFilterPlan::Background::noise) {
      statistic = answer_at(place.at) / filter.noise(density);
      threshold = -std::log(false_alarm_probability);
      return true;
    }
    double sum = 0.0;
    for (const std::ptrdiff_t shift : place.around) {
      if (!holds(part, filter, shift)) return false;
      sum += answer_at(shift);
    }
    if (!(sum > 0.0)) return false;
    const auto cells = static_cast<double>(place.around.size());
    statistic = answer_at(place.at) * cells / sum;
    threshold = cfar_multiplier(false_alarm_probability, cells);
    return true;
  };

  FilterAnswer answer;
  answer.present = answer.threshold = answer.absent = answer.absent_threshold = no_value;
  if (const auto present = one.place(0)) compare(*present, answer.present, answer.threshold);
  one.where_free([&](const TargetFilter::Place& place) {
    return compare(place, answer.absent, answer.absent_threshold);
  });
  return answer;
}

}  // namespace asdic::detail::study
