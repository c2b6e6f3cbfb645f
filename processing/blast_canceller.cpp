#include "processing/blast_canceller.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numeric>
#include <set>

#include "core/error.h"
#include "core/memory_budget.h"
#include "core/units.h"
#include "raytrace/parallel/parallel.h"
#include "sonar/signal/fft.h"
#include "sonar/signal/sampled_signal.h"

namespace asdic::detail {
namespace {

using Complex = std::complex<double>;
using Matrix = Eigen::MatrixXcd;

constexpr double taps_per_cell = 2.0;   // of 1/bandwidth
constexpr double guard_cells = 3.0;     // before the first and after the last way of a group
constexpr double together = 100.0;      // cells: ways no further apart are fitted together
constexpr std::size_t most_taps = 200;  // of a group
constexpr int rounds = 2;               // over all groups
constexpr double ridge = 1e-11;         // of the mean energy of a column
constexpr double fading = 30.0;         // over the width: silence, and as much again of a slope [1]
constexpr double worth_db = 1.5;        // a finer fit has to lower the rest by so much
constexpr int parts_tried[] = {2, 4, 8, 16, 32};  // of the pulse

/// 0 in what is blanked and at the record's ends, 1 inside, with slopes of a raised cosine: what a
/// band-pass makes of a cut has died there.
class Fade {
 public:
  Fade(double first, double last, std::span<const std::pair<double, double>> blanked, double length)
      : first_(first), last_(last), blanked_(blanked.begin(), blanked.end()), length_(length) {}

  [[nodiscard]] double at(double t) const noexcept {
    double value = slope(std::min(t - first_, last_ - t));
    for (const auto& [from, to] : blanked_)
      value = std::min(value, slope(std::max(from - t, t - to)));
    return value;
  }
  [[nodiscard]] double length() const noexcept { return length_; }

 private:
  [[nodiscard]] double slope(double inside) const noexcept {
    const double x = std::clamp(2.0 * inside / length_ - 1.0, 0.0, 1.0);
    return 0.5 - 0.5 * std::cos(pi * x);
  }
  double first_, last_;
  std::vector<std::pair<double, double>> blanked_;
  double length_;
};

/// s₊(t)·e^{−i2πf_c t} as the band-pass leaves it.
SampledSignal in_band(const Replica& pulse, const ListeningBand& band, const Baseband& like) {
  const double rate = 2.0 * like.sample_rate, room = 60.0 / band.width;
  const std::size_t n = fast_fft_length(
      static_cast<std::size_t>(std::ceil((pulse.duration() + 2.0 * room) * rate)) + 64);
  const double spacing = rate / static_cast<double>(n);
  const auto half = static_cast<std::ptrdiff_t>(n / 2);
  FftBuffer<Complex> work(n);
  for (std::ptrdiff_t k = -half + 1; k < half; ++k) {
    const double f = like.carrier + static_cast<double>(k) * spacing, gain = band.gain(f);
    if (gain > 0.0)
      work[static_cast<std::size_t>(k < 0 ? k + static_cast<std::ptrdiff_t>(n) : k)] =
          gain * spacing * pulse.spectrum(f) *
          std::polar(1.0, -2.0 * pi * static_cast<double>(k) * spacing * room);
  }
  ComplexFft<double>(n).inverse(work.data());
  return {std::vector<Complex>(work.data(), work.data() + n), -room, rate};
}

/// Of a pulse's energy, what the band-pass leaves.
double share_in(const Replica& pulse, const ListeningBand& band) {
  const double spacing = 0.5 / pulse.duration(), reach = band.width;
  double sum = 0.0;
  for (double f = band.centre - reach; f < band.centre + reach; f += spacing)
    sum += std::norm(band.gain(f) * pulse.spectrum(f)) * spacing;
  return sum / pulse.energy();
}

/// Ways that are fitted together.
struct Group {
  const KnownBlast* blast = nullptr;
  std::size_t number = 0;  // of the blast
  KnownPath loudest;
  double first = 0.0, last = 0.0;  // delays [s]
  double wide = 0.0;               // delays that are fitted [s]
  double power = 0.0;
  bool narrowed = false;
  int parts = 0;         // of the pulse; −1: nothing is there
  double freedom = 0.0;  // as of its fit
  std::vector<double> taps = {};
  std::size_t begin = 0;        // of the model, a sample
  Eigen::MatrixXcf model = {};  // [samples × phones] as it is received
};

/// Between the moments, straight.
class Shift {
 public:
  Shift(const KnownBlast& blast, const KnownPath& path, std::size_t phone)
      : first_(blast.moments.front()),
        step_(blast.moments.size() > 1 ? blast.moments[1] - blast.moments[0] : 1.0) {
    for (std::size_t i = 0; i < blast.moments.size(); ++i)
      values_.push_back(path.slowness * blast.range[phone][i] +
                        path.slowness_down * blast.depth[phone][i]);
  }
  [[nodiscard]] double at(double t) const noexcept {
    const double last = static_cast<double>(values_.size() - 1);
    const double x = std::clamp((t - first_) / step_, 0.0, last);
    const auto i = std::min(static_cast<std::size_t>(x), values_.size() - 1);
    if (i + 1 == values_.size()) return values_[i];
    return std::lerp(values_[i], values_[i + 1], x - static_cast<double>(i));
  }
  [[nodiscard]] double furthest() const noexcept {
    double most = 0.0;
    for (const double value : values_) most = std::max(most, std::abs(value));
    return most;
  }
  /// Of what is received at t, when it would have been without the shift.
  [[nodiscard]] double without(double t) const noexcept {
    double still = t;
    for (int i = 0; i < 4; ++i) still = t - at(still);
    return still;
  }

 private:
  double first_, step_;
  std::vector<double> values_;
};

/// How much further than the loudest way's another way's shifts go [s].
double stray(const KnownBlast& blast, const KnownPath& path, const KnownPath& loudest) {
  double most = 0.0;
  for (std::size_t n = 0; n < blast.range.size(); ++n)
    for (std::size_t i = 0; i < blast.moments.size(); ++i)
      most = std::max(most,
                      std::abs((path.slowness - loudest.slowness) * blast.range[n][i] +
                               (path.slowness_down - loudest.slowness_down) * blast.depth[n][i]));
  return most;
}

/// The delays within `room` of any way of a group, as steps of a fixed size.
std::vector<double> taps_of(const KnownBlast& blast, const std::vector<KnownPath>& paths,
                            const KnownPath& loudest, double cell) {
  const double step = cell / taps_per_cell, origin = loudest.delay;
  std::set<std::ptrdiff_t> numbers;
  for (const KnownPath& path : paths) {
    const double room = guard_cells * cell + stray(blast, path, loudest);
    const auto first = std::floor((path.delay - room - origin) / step),
               last = std::ceil((path.delay + room - origin) / step);
    for (double k = first; k <= last; ++k) numbers.insert(static_cast<std::ptrdiff_t>(k));
  }
  std::vector<double> taps;
  for (const std::ptrdiff_t k : numbers) taps.push_back(origin + static_cast<double>(k) * step);
  return taps;
}

std::vector<Group> groups_of(std::span<const KnownBlast> blasts) {
  std::vector<Group> groups;
  for (std::size_t b = 0; b < blasts.size(); ++b) {
    const KnownBlast& blast = blasts[b];
    std::vector<KnownPath> paths = blast.paths;
    std::sort(paths.begin(), paths.end(),
              [](const KnownPath& x, const KnownPath& y) { return x.delay < y.delay; });
    const double cell = 1.0 / blast.pulse->bandwidth();
    for (std::size_t first = 0, last = 0; first < paths.size(); first = last) {
      for (last = first + 1;
           last < paths.size() && paths[last].delay - paths[last - 1].delay < together * cell;)
        ++last;
      std::vector<KnownPath> some(paths.begin() + static_cast<std::ptrdiff_t>(first),
                                  paths.begin() + static_cast<std::ptrdiff_t>(last));
      Group group{.blast = &blast, .number = b};
      for (const KnownPath& path : some) {
        group.power += path.power;
        if (path.power > group.loudest.power) group.loudest = path;
      }
      group.taps = taps_of(blast, some, group.loudest, cell);
      while (group.taps.size() > most_taps && some.size() > 1) {  // the faintest go
        group.narrowed = true;
        some.erase(std::min_element(
            some.begin(), some.end(),
            [](const KnownPath& x, const KnownPath& y) { return x.power < y.power; }));
        group.taps = taps_of(blast, some, group.loudest, cell);
      }
      group.first = group.taps.front();
      group.last = group.taps.back();
      group.wide = static_cast<double>(group.taps.size()) * cell / taps_per_cell;
      groups.push_back(std::move(group));
    }
  }
  return groups;
}

/// What is fitted of a group in the warped record, in so many parts of the pulse.
struct Fit {
  Matrix model;          // [span × rows]
  double left = 0.0;     // energy of the phones that is left, where it is trusted
  double all = 0.0;      // that there was
  double freedom = 0.0;  // numbers that were fitted, of each phone
};

class Canceller {
 public:
  Canceller(Baseband& record, const ListeningBand& band, std::span<const KnownBlast> blasts,
            std::span<const std::pair<double, double>> blanked)
      : record_(record),
        band_(band),
        blasts_(blasts),
        samples_(record.recorded),
        phones_(record.channels),
        fade_(record.start,
              record.start + static_cast<double>(record.recorded) / record.sample_rate, blanked,
              2.0 * fading / band.width),
        groups_(groups_of(blasts)) {
    for (const KnownBlast& blast : blasts) {
      pulses_.push_back(in_band(*blast.pulse, band, record));
      shares_.push_back(share_in(*blast.pulse, band));
    }
    for (Group& group : groups_) group.power *= shares_[group.number];
    std::sort(groups_.begin(), groups_.end(), [](const Group& a, const Group& b) {
      return std::pair(-a.power, a.first) < std::pair(-b.power, b.first);
    });
  }

  void run(BlastCancellation& result) {
    const double cells = static_cast<double>(samples_) * static_cast<double>(phones_);
    MemoryBudget budget = MemoryBudget::without_key();
    budget.take(
        {.where = "cancel_direct_blast",
         .what = std::to_string(groups_.size()) + " groups of straight ways in " +
                 std::to_string(samples_) + " samples on " + std::to_string(phones_) + " phones",
         .bytes = cells * (6.0 * sizeof(Complex) + 8.0 * static_cast<double>(groups_.size())),
         .remedy = "cancel_direct_blast = \"off\", or fewer phones"});
    rest_ = Matrix(static_cast<Eigen::Index>(samples_), static_cast<Eigen::Index>(phones_));
    for (std::size_t row = 0; row < phones_; ++row) {
      const auto values = record_.channel(row);
      for (std::size_t i = 0; i < samples_; ++i) rest_(at(i), at(row)) = Complex(values[i]);
    }
    const Eigen::MatrixXcf all = rest_.cast<std::complex<float>>();
    fit_all();
    tell(all, result);
    if (result.cancelled == 0) return;
    for (std::size_t row = 0; row < phones_; ++row) {
      std::complex<float>* values = record_.values.data() + row * record_.samples;
      for (std::size_t i = 0; i < record_.samples; ++i)
        values[i] = i < samples_ ? std::complex<float>(rest_(at(i), at(row)) * fade_.at(time(i)))
                                 : std::complex<float>(0.0F);
    }
  }

 private:
  static Eigen::Index at(std::size_t i) { return static_cast<Eigen::Index>(i); }
  double time(std::size_t i) const {
    return record_.start + static_cast<double>(i) / record_.sample_rate;
  }

  /// The samples that hold a group's sound, warped or not.
  std::pair<std::size_t, std::size_t> span_of(const Group& group) const {
    const auto sample = [&](double t) {
      return static_cast<std::size_t>(std::clamp((t - record_.start) * record_.sample_rate, 0.0,
                                                 static_cast<double>(samples_)));
    };
    return {sample(group.first), sample(group.last + group.blast->pulse->duration())};
  }

  /// One filter for a whole pulse first; then, blast by blast, filters that change in ever shorter
  /// parts, as long as each lowers what is left by more than noise alone would be.
  void fit_all() {
    for (int round = 0; round < rounds; ++round)
      for (Group& group : groups_) improve(group, 1, false);
    for (Group& group : groups_) improve(group, 1, true);
    std::vector<std::size_t> order;  // the loudest first
    for (const Group& group : groups_)
      if (std::find(order.begin(), order.end(), group.number) == order.end())
        order.push_back(group.number);
    for (const std::size_t b : order) {
      std::vector<Group*> own;
      for (Group& group : groups_)
        if (group.number == b && group.parts > 0) own.push_back(&group);
      int in_vain = 0;
      for (const int parts : parts_tried) {
        if (own.empty()) break;
        std::vector<Group> before;
        double freedom = 0.0;
        for (const Group* group : own) {
          before.push_back(*group);
          freedom -= group->freedom;
        }
        const auto [had, numbers] = left_of(own);
        for (int round = 0; round < rounds; ++round)
          for (Group* group : own) improve(*group, parts, false);
        for (const Group* group : own) freedom += group->freedom;
        const double left = left_of(own).first;
        const double by_chance = std::max(1.0 - 4.0 * freedom / numbers, 0.1);
        if (left < had * by_chance * power_from_db(-worth_db)) {
          in_vain = 0;
          continue;
        }
        for (std::size_t g = 0; g < own.size(); ++g) {
          add(*own[g], 1.0);
          *own[g] = std::move(before[g]);
          add(*own[g], -1.0);
        }
        if (++in_vain == 2) break;  // the next finer one may do it still
      }
    }
  }

  /// Energy of the phones while a blast lasts, and how many independent numbers of each that is.
  std::pair<double, double> left_of(const std::vector<Group*>& groups) const {
    std::size_t begin = samples_, end = 0;
    for (const Group* group : groups) {
      const auto [first, last] = span_of(*group);
      begin = std::min(begin, first);
      end = std::max(end, last);
    }
    double energy = 0.0;
    for (std::size_t i = begin; i < end; ++i) {
      const double trust = fade_.at(time(i));
      energy += trust * trust * rest_.row(at(i)).squaredNorm();
    }
    return {energy, independent(end - begin)};
  }

  /// \param parts  of the pulse   \param ask  whether something is there at all
  void improve(Group& group, int parts, bool ask) {
    const auto [begin, end] = span_of(group);
    if (group.parts < 0 || end < begin + 8 * group.taps.size() || end < begin + 64) {
      group.parts = -1;
      return;
    }
    if (group.model.size() > 0) add(group, 1.0);
    std::vector<Shift> shifts;
    for (std::size_t n = 0; n < phones_; ++n) shifts.emplace_back(*group.blast, group.loudest, n);
    const std::size_t n = end - begin;
    Matrix still(at(n), at(phones_));
    Eigen::VectorXd trust = Eigen::VectorXd::Ones(at(n));
    in_parallel(phones_, [&](std::size_t row) { warp(row, shifts[row], begin, still); });
    for (const Shift& shift : shifts)
      for (std::size_t i = 0; i < n; ++i) {
        const double t = time(begin + i);
        trust[at(i)] = std::min(trust[at(i)], fade_.at(t + shift.at(t)));
      }
    const Fit made = fit(group, parts, begin, still, trust);
    // Noise alone loses its share of what is fitted.
    if (ask && made.left > made.all * (1.0 - 4.0 * made.freedom / independent(n))) {
      group.parts = -1;
      group.model.resize(0, 0);
      return;
    }
    group.parts = parts;
    group.freedom = made.freedom;
    double furthest = 0.0;
    for (const Shift& shift : shifts) furthest = std::max(furthest, shift.furthest());
    const auto room = static_cast<std::size_t>(furthest * record_.sample_rate) + 2;
    group.begin = begin > room ? begin - room : 0;
    group.model.setZero(at(std::min(end + room, samples_) - group.begin), at(phones_));
    in_parallel(phones_,
                [&](std::size_t row) { unwarp(row, shifts[row], begin, made.model, group); });
    add(group, -1.0);
  }

  void add(const Group& group, double sign) {
    rest_.middleRows(at(group.begin), group.model.rows()) += sign * group.model.cast<Complex>();
  }

  double independent(std::size_t samples) const {
    return static_cast<double>(samples) * band_.width / record_.sample_rate;
  }

  void warp(std::size_t row, const Shift& shift, std::size_t begin, Matrix& into) const {
    std::vector<Complex> values(samples_);
    for (std::size_t i = 0; i < samples_; ++i) values[i] = rest_(at(i), at(row));
    const SampledSignal signal(values, record_.start, record_.sample_rate);
    for (Eigen::Index i = 0; i < into.rows(); ++i) {
      const double t = time(begin + static_cast<std::size_t>(i)), late = shift.at(t);
      into(i, at(row)) =
          signal.at(t + late) *
          std::polar(1.0, std::remainder(2.0 * pi * record_.carrier * late, 2.0 * pi));
    }
  }

  void unwarp(std::size_t row, const Shift& shift, std::size_t begin, const Matrix& still,
              Group& into) const {
    std::vector<Complex> values(static_cast<std::size_t>(still.rows()));
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = still(at(i), at(row));
    const SampledSignal signal(values, time(begin), record_.sample_rate);
    const double first = time(begin), last = time(begin + values.size());
    for (Eigen::Index i = 0; i < into.model.rows(); ++i) {
      const double t = time(into.begin + static_cast<std::size_t>(i)), before = shift.without(t);
      if (before < first || before > last) continue;
      into.model(i, at(row)) = std::complex<float>(
          signal.at(before) *
          std::polar(1.0, std::remainder(-2.0 * pi * record_.carrier * (t - before), 2.0 * pi)));
    }
  }

  /// Least squares in half-overlapping parts whose weights add up to one.
  Fit fit(const Group& group, int parts, std::size_t begin, const Matrix& still,
          const Eigen::VectorXd& trust) const {
    const auto n = static_cast<std::size_t>(still.rows());
    const SampledSignal& pulse = pulses_[group.number];
    const double share =
        static_cast<double>(n) / record_.sample_rate / group.blast->pulse->duration();
    const auto pieces = std::max<std::size_t>(
        1, static_cast<std::size_t>(std::lround(std::min(share, 1.0) * parts)));
    const double step = static_cast<double>(n) / static_cast<double>(pieces);
    const std::size_t windows = parts == 1 ? 1 : pieces + 1;
    const std::size_t columns = group.taps.size() * 2;
    // Weight of window j at sample i: cos² of half a step, flat beyond the first and the last.
    const auto weight = [&](std::size_t j, std::size_t i) {
      if (windows == 1) return 1.0;
      const double off = (static_cast<double>(i) + 0.5) / step - static_cast<double>(j);
      return std::abs(off) < 1.0 ? std::pow(std::cos(0.5 * pi * off), 2.0) : 0.0;
    };
    std::vector<Matrix> fitted(windows);
    std::vector<std::size_t> from(windows);
    std::vector<double> freedom(windows, 0.0);
    in_parallel(windows, [&](std::size_t j) {
      const double middle =
          windows == 1 ? 0.5 * static_cast<double>(n) : static_cast<double>(j) * step;
      const double half = windows == 1 ? 0.5 * static_cast<double>(n) : step;
      const auto first = static_cast<std::size_t>(std::max(0.0, std::floor(middle - half)));
      const auto last =
          static_cast<std::size_t>(std::min(static_cast<double>(n), std::ceil(middle + half)));
      const std::size_t count = last - first;
      from[j] = first;
      Matrix a(at(count), at(columns));
      for (std::size_t k = 0; k < group.taps.size(); ++k)
        for (std::size_t i = 0; i < count; ++i) {
          const double u = (static_cast<double>(first + i) + 0.5 - middle) / half;
          const Complex s = pulse.at(time(begin + first + i) - group.taps[k]);
          a(at(i), at(2 * k)) = s;
          a(at(i), at(2 * k + 1)) = u * s;
        }
      Eigen::VectorXd w(at(count));
      for (std::size_t i = 0; i < count; ++i)
        w[at(i)] = weight(j, first + i) * trust[at(first + i)];
      const Matrix weighted = w.asDiagonal() * a;
      Matrix gram = a.adjoint() * weighted;
      const double mean = gram.trace().real() / static_cast<double>(columns);
      if (!(mean > 0.0)) {
        fitted[j] = Matrix::Zero(at(count), still.cols());
        return;
      }
      const Matrix plain = gram;
      gram.diagonal().array() += ridge * mean;
      const Eigen::LLT<Matrix> factor(gram);
      const Matrix right = weighted.adjoint() * still.middleRows(at(first), at(count));
      fitted[j] = a * factor.solve(right);
      freedom[j] = factor.solve(plain).trace().real();
    });
    Fit made{.model = Matrix::Zero(still.rows(), still.cols())};
    for (std::size_t j = 0; j < windows; ++j) {
      for (Eigen::Index i = 0; i < fitted[j].rows(); ++i)
        made.model.row(at(from[j]) + i) +=
            weight(j, from[j] + static_cast<std::size_t>(i)) * fitted[j].row(i);
      made.freedom += windows == 1 ? freedom[j] : 0.5 * freedom[j];  // each is half the others'
    }
    const auto phones = at(phones_);
    made.all = (trust.asDiagonal() * still.leftCols(phones)).squaredNorm();
    made.left =
        (trust.asDiagonal() * (still.leftCols(phones) - made.model.leftCols(phones))).squaredNorm();
    return made;
  }

  void tell(const Eigen::MatrixXcf& all, BlastCancellation& result) const {
    std::vector<bool> found(blasts_.size(), false);
    std::vector<double> blind(blasts_.size(), 0.0);
    result.known = blasts_.size();
    double before = 0.0, after = 0.0, numbers = 0.0;
    std::vector<bool> sounds(samples_, false);
    for (const Group& group : groups_) {
      if (group.parts < 0) continue;
      found[group.number] = true;
      blind[group.number] += group.wide;
      result.parts = std::max(result.parts, group.parts);
      // A filter that changes in n parts of the pulse reaches n cells further.
      const double cell = 1.0 / group.blast->pulse->bandwidth();
      result.beside = std::max(result.beside, (guard_cells + group.parts) * cell);
      result.narrowed = result.narrowed || group.narrowed;
      const auto [begin, end] = span_of(group);
      std::fill(sounds.begin() + static_cast<std::ptrdiff_t>(begin),
                sounds.begin() + static_cast<std::ptrdiff_t>(end), true);
    }
    for (std::size_t i = 0; i < samples_; ++i) {
      if (!sounds[i]) continue;
      const double trust = fade_.at(time(i)), weight = trust * trust;
      before += weight * all.row(at(i)).cast<Complex>().squaredNorm();
      after += weight * rest_.row(at(i)).squaredNorm();
      numbers += weight * static_cast<double>(phones_);
    }
    result.cancelled = static_cast<std::size_t>(std::count(found.begin(), found.end(), true));
    if (result.cancelled == 0) return;
    const auto level = [&](double energy) {
      return db_from_power(0.5 * energy / numbers) - db_from_amplitude(micropascal);
    };
    result.before_db = level(before);
    result.after_db = level(after);
    result.blind = *std::max_element(blind.begin(), blind.end());
    result.faded = fade_.length();
  }

  Baseband& record_;
  ListeningBand band_;
  std::span<const KnownBlast> blasts_;
  std::size_t samples_, phones_;
  Fade fade_;
  std::vector<Group> groups_;
  std::vector<SampledSignal> pulses_;
  std::vector<double> shares_;  // of their energies that the band holds
  Matrix rest_;                 // [samples × phones]
};

}  // namespace

void cancel_blasts(Baseband& record, const ListeningBand& band, std::span<const KnownBlast> blasts,
                   std::span<const std::pair<double, double>> blanked, BlastCancellation& result) {
  result = {};
  if (blasts.empty() || record.channels == 0) return;
  Canceller(record, band, blasts, blanked).run(result);
}

}  // namespace asdic::detail
