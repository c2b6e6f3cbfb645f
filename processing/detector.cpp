#include "processing/detector.h"

#include <oneapi/tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>

#include "core/memory_budget.h"
#include "processing/across_beams.h"
#include "processing/echo_pointing.h"
#include "processing/factor_estimate.h"
#include "processing/peak_cluster.h"
#include "processing/threshold_probes.h"
#include "raytrace/parallel/parallel.h"
#include "raytrace/propagation.h"

namespace asdic::detail {
namespace {

/// Offset of a parabola's top through three values, within half a step.
double top_of(double before, double here, double after) {
  const double bend = before - 2.0 * here + after;
  return bend < 0.0 ? std::clamp(0.5 * (before - after) / bend, -0.5, 0.5) : 0.0;
}

double step_of(const MatchedFilterBank& bank) {
  return bank.filters() > 1 ? bank.doppler(1) - bank.doppler(0) : 0.0;
}

std::vector<Vec3> about(const Vec3& middle, std::span<const Vec3> phones) {
  std::vector<Vec3> moved;
  for (const Vec3& phone : phones) moved.push_back(phone - middle);
  return moved;
}

/// Asks for what all beams and filters take. \throws MemoryError
BeamGrid within_memory(BeamGrid grid, const Baseband& baseband, std::size_t filters,
                       const DetectorSettings& settings) {
  const auto number = [](std::size_t n) { return static_cast<double>(n); };
  const double beams = number(grid.looks.size()), banks = number(filters);
  const double row = 8.0 * number(baseband.samples);
  // Spectra of beams, phones (twice by MVDR, in blocks) and filters; what all cells hold, if beams
  // are compared; maps.
  const double phones =
      number(baseband.channels) * (settings.beamformer == Beamformer::mvdr ? 3.0 : 1.0);
  const double cells = settings.normaliser.across_beams ? 0.5 * beams * banks * row : 0.0;
  MemoryBudget budget = MemoryBudget::without_key();
  budget.take({.where = "receiver",
               .what = std::to_string(grid.looks.size()) + " beams and " + std::to_string(filters) +
                       " Doppler filters of " + std::to_string(baseband.samples) + " samples",
               .bytes = (beams + phones + banks) * row + cells +
                        4.0 * (beams + banks) * number(settings.map_columns),
               .remedy = "a lower max_speed, fewer elevations or phones, or a shorter record"});
  return grid;
}

/// What is left out on either side of a cell because the pulse's own answer goes on there [s].
double guard_of(const Replica& replica, const NormaliserSettings& settings) {
  const double cell = 1.0 / replica.noise_bandwidth();
  return reach_of_answer(replica, settings.guard_cells * cell,
                         (settings.guard_cells + settings.reference_cells) * cell);
}

/// What an echo of power 1 adds to its own background: its side lobes there.
double own_background(const Replica& replica, const NormaliserSettings& settings, double guard,
                      int sub_bands) {
  const double cell = sub_bands / replica.noise_bandwidth();
  const double from = std::max(settings.guard_cells * cell, guard);
  return mean_answer(replica, from, from + settings.reference_cells * cell, sub_bands);
}

/// Beams are steered about the middle of the phones, so that an echo comes at one time in all of
/// them, also on a line that is towed far behind the point that delays refer to.
class Search {
 public:
  Search(const Baseband& baseband, std::span<const Vec3> phones, double sound_speed,
         const Replica& replica, std::span<const double> dopplers, const DetectorSettings& settings)
      : baseband_(baseband),
        sound_speed_(sound_speed),
        replica_(replica),
        settings_(settings),
        wavelength_(sound_speed / replica.centre_frequency()),
        middle_(shape_of(phones, wavelength_).centre),
        phones_(about(middle_, phones)),
        shape_(shape_of(phones_, wavelength_)),
        grid_(within_memory(
            beam_grid(shape_, wavelength_, settings.lowest_elevation, settings.highest_elevation),
            baseband, dopplers.size(), settings)),
        weights_(shading(phones_, settings.shading == Shading::hann)),
        bank_(replica, dopplers, baseband, settings.sub_bands),
        cell_(bank_.sample_rate() / replica.noise_bandwidth() * settings.sub_bands),
        guard_(guard_of(replica, settings.normaliser)),
        own_background_(own_background(replica, settings.normaliser, guard_, settings.sub_bands)),
        estimator_(settings.normaliser, cell_, bank_.sample_rate() * guard_, settings.sub_bands),
        channels_(channel_spectra(baseband)),
        across_(shape_, phones_, weights_, grid_.looks, wavelength_,
                settings.normaliser.across_beams ? bank_.filters() : 0, bank_.samples(), cell_),
        pointing_(baseband, phones_, sound_speed, replica, shape_, weights_, grid_.spacing,
                  dopplers.front(), settings.sub_bands),
        doppler_cell_(doppler_cell(replica, settings.sub_bands)),
        ridge_(-doppler_answer(replica, 1.0 + 0.25 * doppler_cell_, settings.sub_bands).delay /
               (0.25 * doppler_cell_)) {
    if (bank_.filters() < 3) return;
    finder_ =
        FactorFinder(replica, step_of(bank_), bank_.filters(), doppler_cell_, settings.sub_bands);
  }

  DetectorResult run(std::span<const Probe> probes, const std::function<bool()>& proceed) {
    const BeamSpectra beams =
        settings_.beamformer == Beamformer::mvdr && shape_.kind != ArrayKind::point
            ? mvdr_beams(baseband_, phones_, grid_.looks, sound_speed_, settings_.mvdr)
            : conventional_beams(channels_, baseband_, phones_, grid_.looks, sound_speed_,
                                 weights_);
    DetectorResult result;
    prepare_maps(result.maps);
    std::vector<Probe> at_middle(probes.begin(), probes.end());
    for (Probe& probe : at_middle) probe.time -= lead(probe.look);
    probes_ = place_probes(at_middle, bank_, doppler_cell_, grid_, phones_, weights_,
                           2.0 * pi / wavelength_);
    std::vector<Peak> peaks = find_peaks(beams, proceed, result.maps);
    if (settings_.normaliser.across_beams) compare_across_beams(peaks);
    result.peaks = peaks.size();
    for (const PlacedProbe& probe : probes_)
      result.thresholds_db.push_back(std::isfinite(probe.threshold) ? level_of(probe.threshold)
                                                                    : infinity);
    const LeakTable leaks(replica_, bank_, finder_.late());
    // Of one echo's paths the pattern of the loudest is known; the others' fill its zeros, to about
    // the level of far side lobes, 1/N².
    const double k = 2.0 * pi / wavelength_, least = 1.0 / std::pow(phones_.size(), 2.0);
    std::map<std::size_t, Vec3> look;  // of kept peaks
    std::map<std::pair<std::size_t, std::size_t>, double> known;
    const auto keep = [&](std::size_t i) {
      Detection& kept = result.detections.emplace_back(refine(peaks[i], beams));
      look[i] = kept.look;
      kept.time += lead(kept.look);
    };
    const auto beam_leak = [&](std::size_t kept, std::size_t beam) {
      const auto [at, fresh] = known.try_emplace({kept, beam}, 0.0);
      if (fresh) {
        // Phones that stray a little from their line or plane receive its other side a little
        // otherwise.
        const Vec3& to = grid_.looks[beam];
        at->second =
            std::max({beam_pattern(phones_, weights_, to, look[kept], k),
                      beam_pattern(phones_, weights_, to, mirrored(shape_, look[kept]), k), least});
      }
      return at->second;
    };
    static_cast<void>(independent_peaks(peaks, leaks, keep, beam_leak,
                                        power_from_db(settings_.leak_margin_db),
                                        settings_.most_detections, guard_ > 0.0));
    std::sort(result.detections.begin(), result.detections.end(),
              [](const Detection& a, const Detection& b) {
                return std::tuple(a.time, a.doppler, a.level_db) <
                       std::tuple(b.time, b.doppler, b.level_db);
              });
    result.grid = grid_;
    for (std::size_t f = 0; f < bank_.filters(); ++f) result.dopplers.push_back(bank_.doppler(f));
    result.time_cell = settings_.sub_bands / replica_.noise_bandwidth();
    result.doppler_cell = doppler_cell_;
    result.delay_per_doppler = ridge_;
    const double from = std::max(settings_.first_time.value_or(-infinity), bank_.time(0.0)),
                 to = std::min(settings_.last_time.value_or(infinity),
                               bank_.time(static_cast<double>(bank_.samples())));
    result.cells = static_cast<double>(grid_.looks.size() * bank_.filters()) *
                   std::max(0.0, to - from) / result.time_cell;
    result.false_alarm_probability = settings_.normaliser.false_alarm_probability;
    constexpr double wide = 10.0;  // the −40 dB width over 1/B: 4 of a Hann tone
    result.shaded = settings_.shading != Shading::none;
    result.sub_bands = settings_.sub_bands;
    result.rough = replica_.bandwidth() > wide * replica_.noise_bandwidth();
    return result;
  }

 private:
  struct Work {
    FftBuffer<std::complex<float>> out;
    std::vector<float> power, background, threshold;
    BackgroundEstimator::Scratch scratch;
    std::vector<float> doppler_time;  // [filters × columns]
  };

  /// By how much the middle receives what comes from there before the point that delays refer to
  /// [s]
  double lead(const Vec3& look) const { return look.dot(middle_) / sound_speed_; }

  /// \return level of an echo of power |y|² [dB re 1 µPa]
  static double level_of(double power) {
    return db_from_power(0.5 * power) - db_from_amplitude(micropascal);
  }

  void prepare_maps(DetectionMaps& maps) const {
    const std::size_t columns = std::min(settings_.map_columns, bank_.samples());
    maps.time.resize(columns);
    for (std::size_t i = 0; i < columns; ++i)
      maps.time[i] =
          bank_.time((static_cast<double>(i) + 0.5) * static_cast<double>(bank_.samples()) /
                     static_cast<double>(columns));
    maps.beam_time.assign(grid_.looks.size() * columns, 0.0F);
    maps.doppler_time.assign(bank_.filters() * columns, 0.0F);
  }

  std::vector<Peak> find_peaks(const BeamSpectra& beams, const std::function<bool()>& proceed,
                               DetectionMaps& maps) {
    const std::size_t n = bank_.samples(), columns = maps.time.size();
    std::vector<std::vector<Peak>> found(beams.beams);
    tbb::enumerable_thread_specific<Work> works;
    in_parallel(beams.beams, [&](std::size_t b) {
      if (proceed && !proceed()) throw Interrupted();
      Work& work = works.local();
      work.out.reserve(bank_.work());
      work.power.resize(n);
      work.background.resize(n);
      work.threshold.resize(n);
      work.doppler_time.resize(bank_.filters() * columns, 0.0F);
      for (std::size_t f = 0; f < bank_.filters(); ++f) {
        bank_.power(f, beams.beam(b), work.out.data(), work.power.data());
        compare_over_time(grid_.looks[b], work);
        pick(b, f, work, found[b]);
        if (settings_.normaliser.across_beams) across_.set(f, b, work.power);
        for (PlacedProbe& probe : probes_)  // each has one beam and one filter
          if (probe.inside && probe.beam == b && probe.filter == f) {
            probe.power = work.power[probe.sample];
            probe.background = work.background[probe.sample];
            probe.threshold = work.threshold[probe.sample];
          }
        const auto early =
            static_cast<std::ptrdiff_t>(std::lround(lead(grid_.looks[b]) * bank_.sample_rate()));
        const auto at_middle = [&](std::size_t i) {  // the sample there of one at the reference
          return static_cast<std::size_t>(std::clamp(static_cast<std::ptrdiff_t>(i) - early,
                                                     std::ptrdiff_t{0},
                                                     static_cast<std::ptrdiff_t>(n)));
        };
        for (std::size_t column = 0; column < columns; ++column) {
          float most = 0.0F;
          for (std::size_t i = at_middle(column * n / columns),
                           end = at_middle((column + 1) * n / columns);
               i < end; ++i)
            if (work.background[i] > 0.0F)
              most = std::max(most, work.power[i] / work.background[i]);
          float& by_beam = maps.beam_time[b * columns + column];
          by_beam = std::max(by_beam, most);
          float& by_doppler = work.doppler_time[f * columns + column];
          by_doppler = std::max(by_doppler, most);
        }
      }
    });
    for (const Work& work : works)  // a maximum: in any order
      for (std::size_t i = 0; i < work.doppler_time.size(); ++i)
        maps.doppler_time[i] = std::max(maps.doppler_time[i], work.doppler_time[i]);
    std::vector<Peak> peaks;
    for (const auto& of_beam : found) peaks.insert(peaks.end(), of_beam.begin(), of_beam.end());
    return peaks;
  }

  /// Background and threshold of the samples that a look receives with all phones: one at x
  /// receives u·x/c before the middle, so that the ends of a long line begin and end their record
  /// too late or too early. Elsewhere there is no background, and nothing to find.
  void compare_over_time(const Vec3& look, Work& work) const {
    const auto samples = static_cast<double>(work.power.size());
    double first = 0.0, end = samples;
    for (const Vec3& phone : phones_) {
      const double early = look.dot(phone) / sound_speed_ * bank_.sample_rate();
      first = std::max(first, std::ceil(early));
      end = std::min(end, samples + std::floor(early));
    }
    const auto i = static_cast<std::size_t>(std::min(first, samples));
    const auto count = static_cast<std::size_t>(std::max(end - static_cast<double>(i), 0.0));
    std::fill(work.background.begin(), work.background.end(),
              std::numeric_limits<float>::infinity());
    std::fill(work.threshold.begin(), work.threshold.end(), std::numeric_limits<float>::infinity());
    estimator_(std::span(work.power).subspan(i, count),
               std::span(work.background).subspan(i, count),
               std::span(work.threshold).subspan(i, count), work.scratch);
  }

  void pick(std::size_t beam, std::size_t filter, const Work& work, std::vector<Peak>& into) const {
    const std::size_t n = work.power.size();
    const double first = settings_.first_time.value_or(0.0),
                 last = settings_.last_time.value_or(infinity);
    for (std::size_t i = 0; i < n; ++i) {
      const float p = work.power[i];
      if (!(p > work.threshold[i])) continue;
      if ((i > 0 && work.power[i - 1] > p) || (i + 1 < n && work.power[i + 1] >= p)) continue;
      const double time = bank_.time(static_cast<double>(i)) + lead(grid_.looks[beam]);
      if (time < first || time > last) continue;
      into.push_back({.beam = beam,
                      .filter = filter,
                      .sample = i,
                      .power = p,
                      .background = work.background[i],
                      .threshold = work.threshold[i]});
    }
  }

  void compare_across_beams(std::vector<Peak>& peaks) {
    for (Peak& peak : peaks) across_.correct(peak);
    for (PlacedProbe& probe : probes_)
      if (probe.inside) across_.correct(probe);
    std::erase_if(peaks, [](const Peak& peak) { return !(peak.power > peak.threshold); });
  }

  /// A filter's largest power near a sample, between the samples.
  struct Top {
    double power = 0.0, sample = 0.0;
  };
  Top top_near(std::span<const float> power, double sample) const {
    const auto n = static_cast<std::ptrdiff_t>(power.size());
    const auto middle = static_cast<std::ptrdiff_t>(std::lround(sample));
    const auto reach = static_cast<std::ptrdiff_t>(std::ceil(0.5 * cell_));
    const auto within = [&](std::ptrdiff_t i) { return std::clamp<std::ptrdiff_t>(i, 0, n - 1); };
    const auto i = std::max_element(power.begin() + within(middle - reach),
                                    power.begin() + within(middle + reach) + 1) -
                   power.begin();
    constexpr int parts = 8;  // of a sample
    Top top{.power = static_cast<double>(power[static_cast<std::size_t>(i)]),
            .sample = static_cast<double>(i)};
    std::array<double, 2 * parts + 1> fine{};
    for (int k = -parts; k <= parts; ++k)
      fine[static_cast<std::size_t>(k + parts)] =
          interpolated(power, static_cast<double>(i) + static_cast<double>(k) / parts);
    const auto best = std::max_element(fine.begin() + 1, fine.end() - 1) - fine.begin();
    const auto at = [&](std::ptrdiff_t k) { return fine[static_cast<std::size_t>(k)]; };
    if (!(at(best) >= top.power)) return top;
    const double before = at(best - 1), after = at(best + 1);
    const double offset = top_of(before, at(best), after);
    top.power = at(best) + 0.25 * (after - before) * offset;
    top.sample += (static_cast<double>(best - parts) + offset) / parts;
    return top;
  }

  /// The filter's power is sampled at twice the pulse's band, its own: a windowed sinc.
  static double interpolated(std::span<const float> power, double sample) {
    constexpr std::ptrdiff_t taps = 12;  // to either side
    const auto n = static_cast<std::ptrdiff_t>(power.size());
    const auto from = static_cast<std::ptrdiff_t>(std::floor(sample)) - taps + 1;
    double sum = 0.0;
    for (std::ptrdiff_t k = std::max<std::ptrdiff_t>(from, 0);
         k < std::min<std::ptrdiff_t>(from + 2 * taps, n); ++k) {
      const double x = sample - static_cast<double>(k), c = std::cos(0.5 * pi * x / taps);
      const double sinc = x == 0.0 ? 1.0 : std::sin(pi * x) / (pi * x);
      sum += static_cast<double>(power[static_cast<std::size_t>(k)]) * sinc * c * c;
    }
    return sum;
  }

  /// Between the samples, filters and beams. Filters are compared where each answers most: a
  /// sweep's echo comes at another time in each of them, along its ridge.
  Detection refine(const Peak& peak, const BeamSpectra& beams) const {
    FftBuffer<std::complex<float>> work(bank_.work());
    std::vector<float> out(bank_.samples());
    const std::size_t last = bank_.filters() - 1;
    const auto answer = [&](std::size_t f, double sample) {
      bank_.power(f, beams.beam(peak.beam), work.data(), out.data());
      return top_near(out, sample);
    };
    std::size_t middle = peak.filter;
    Top here = answer(middle, static_cast<double>(peak.sample));
    const auto of_here = [&](std::size_t f) {  // in another filter
      const double later = finder_.late()(bank_.doppler(middle), bank_.doppler(f));
      return answer(f, here.sample + later * bank_.sample_rate());
    };
    const FactorFound factor = finder_.find(middle, last, [&](std::size_t f, std::size_t from) {
      if (from != middle) {
        here = of_here(from);
        middle = from;
      }
      return std::log((of_here(f).power + std::numeric_limits<double>::min()) / bank_.doppler(f));
    });
    const double offset = factor.offset;
    Detection d;
    d.doppler = bank_.doppler(middle) + offset;
    d.time = bank_.time(here.sample) + ridge_ * offset;
    pointing_.point(d, grid_.looks[peak.beam]);
    const double power = std::max(static_cast<double>(peak.power), pointing_.power_at(d));
    d.snr_db = db_from_power(power / static_cast<double>(peak.background));
    d.excess_db = db_from_power(power / static_cast<double>(peak.threshold));
    d.level_db = level_of(power);
    // Over the noise alone, without the echo's own side lobes in the background.
    const double noise = static_cast<double>(peak.background) - own_background_ * power;
    if (factor.estimate != nullptr)
      d.doppler_sigma = factor.estimate->sigma(
          power / std::max(noise, 0.4 * static_cast<double>(peak.background)));
    else  // one filter, or the bank's end: any factor that it answers to
      d.doppler_sigma = doppler_cell_ / std::sqrt(3.0);
    const double centre = 0.5 * (bank_.doppler(0) + bank_.doppler(last)),
                 half_span = bank_.doppler(last) - centre;
    if (half_span > 0.0 && half_span <= doppler_cell_) {
      const double known_before = half_span / std::sqrt(3.0);  // evenly likely all over the bank
      d.doppler_sigma = std::min(d.doppler_sigma, known_before);
      if (peak.filter == 0 || peak.filter == last) {  // no maximum: along the ridge to the middle
        d.time -= ridge_ * (d.doppler - centre);
        d.doppler = centre;
        d.doppler_sigma = known_before;
      }
    }
    return d;
  }

  const Baseband& baseband_;
  double sound_speed_;
  const Replica& replica_;
  const DetectorSettings& settings_;
  double wavelength_;
  Vec3 middle_;
  std::vector<Vec3> phones_;  // from there
  ArrayShape shape_;
  BeamGrid grid_;
  std::vector<double> weights_;
  MatchedFilterBank bank_;
  double cell_;   // samples of its output
  double guard_;  // what a pulse of a long answer leaves out [s]; 0 of others
  double own_background_;
  BackgroundEstimator estimator_;
  BeamSpectra channels_;
  AcrossBeams across_;
  EchoPointing pointing_;
  double doppler_cell_, ridge_;  // delay_per_doppler
  FactorFinder finder_;
  std::vector<PlacedProbe> probes_;
};

}  // namespace

double sigma_of(double cell, double snr) {
  return cell * std::max(0.1, 0.5 / std::sqrt(2.0 * snr));
}

ExpectedAlarms expected_alarms(const DetectorResult& of) noexcept {
  const double set = of.cells * of.false_alarm_probability;
  const bool one = of.dopplers.size() == 1;
  const bool several = of.sub_bands > 1;  // a longer cell has more samples
  // A peak that a louder one explains, in any filter, is not a detection of its own. If x cells
  // exceed the threshold in the reach of a peak on average, a share (1 − e⁻ˣ)/x of them is loudest.
  const auto left = [&](double explained) {
    const double x =
        explained * of.false_alarm_probability * static_cast<double>(of.dopplers.size());
    return x > 1e-6 ? -std::expm1(-x) / x : 1.0;
  };
  const double least = (one || several ? 1.4 : 0.65 * left(160.0)) * (of.shaded ? 0.6 : 1.0),
               most = of.rough  ? 6.0
                      : several ? 5.0
                      : one     ? 2.0
                                : 1.6 * left(40.0);
  return {.least = least * set, .most = most * set};
}

double trusted_sigma(const Detection& detection, const DetectorResult& of) {
  const double known = 0.5 * (of.dopplers.back() - of.dopplers.front()) / std::sqrt(3.0);
  const double floor = 0.2 * of.doppler_cell;
  return std::max(detection.doppler_sigma, known > 0.0 ? std::min(floor, known) : floor);
}

DetectorResult detect(const Baseband& baseband, std::span<const Vec3> phones, double sound_speed,
                      const Replica& replica, std::span<const double> dopplers,
                      const DetectorSettings& settings, std::span<const Probe> probes,
                      const std::function<bool()>& proceed) {
  return Search(baseband, phones, sound_speed, replica, dopplers, settings).run(probes, proceed);
}

}  // namespace asdic::detail
