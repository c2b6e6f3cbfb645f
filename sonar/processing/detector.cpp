#include "sonar/processing/detector.h"

#include <oneapi/tbb/enumerable_thread_specific.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>

#include "raytrace/propagation.h"
#include "sonar/processing/peak_cluster.h"

namespace asdic {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

/// Offset of a parabola's top through three logarithms of power, within half a step.
double top_of(double before, double here, double after) {
  const double bend = before - 2.0 * here + after;
  return bend < 0.0 ? std::clamp(0.5 * (before - after) / bend, -0.5, 0.5) : 0.0;
}

double log_power(std::complex<float> x) {
  return std::log(static_cast<double>(std::norm(x)) + std::numeric_limits<double>::min());
}

class Search {
 public:
  Search(const Baseband& baseband, std::span<const Vec3> phones, double sound_speed,
         const Replica& replica, std::span<const double> dopplers, const DetectorSettings& settings)
      : baseband_(baseband),
        phones_(phones),
        sound_speed_(sound_speed),
        replica_(replica),
        settings_(settings),
        wavelength_(sound_speed / replica.centre_frequency()),
        shape_(shape_of(phones, wavelength_)),
        grid_(
            beam_grid(shape_, wavelength_, settings.lowest_elevation, settings.highest_elevation)),
        weights_(shading(phones, settings.hann_shading)),
        bank_(replica, dopplers, baseband),
        estimator_(settings.normaliser, bank_.sample_rate() / replica.noise_bandwidth()),
        channels_(channel_spectra(baseband)),
        cut_(fast_fft_length(static_cast<std::size_t>(
            std::ceil(1.5 * replica.duration() / dopplers.front() * baseband.sample_rate) + 64))) {}

  DetectorResult run(std::span<const Probe> probes, const std::function<bool()>& proceed) {
    const BeamSpectra beams =
        settings_.beamformer == Beamformer::mvdr && shape_.kind != ArrayKind::point
            ? mvdr_beams(baseband_, phones_, grid_.looks, sound_speed_, settings_.mvdr)
            : conventional_beams(channels_, baseband_, phones_, grid_.looks, sound_speed_,
                                 weights_);
    DetectorResult result;
    prepare_maps(result.maps);
    place_probes(probes);
    const std::vector<Peak> peaks = find_peaks(beams, proceed, result.maps);
    result.peaks = peaks.size();
    for (const PlacedProbe& probe : probes_)
      result.thresholds_db.push_back(std::isfinite(probe.threshold) ? level_of(probe.threshold)
                                                                    : infinity);
    const LeakTable leaks(replica_, bank_);
    // Of one echo's paths the pattern of the loudest is known; the others' fill its zeros, to about
    // the level of far side lobes, 1/N².
    const double k = 2.0 * pi / wavelength_, least = 1.0 / std::pow(phones_.size(), 2.0);
    std::map<std::size_t, Vec3> look;  // of kept peaks
    std::map<std::pair<std::size_t, std::size_t>, double> known;
    const auto keep = [&](std::size_t i) {
      result.detections.push_back(refine(peaks[i], beams));
      look[i] = result.detections.back().look;
    };
    const auto beam_leak = [&](std::size_t kept, std::size_t beam) {
      const auto [at, fresh] = known.try_emplace({kept, beam}, 0.0);
      if (fresh) {
        // Phones that stray a little from their line or plane hear its other side a little
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
                                        settings_.most_detections));
    std::sort(result.detections.begin(), result.detections.end(),
              [](const Detection& a, const Detection& b) {
                return std::tuple(a.time, a.doppler, a.level_db) <
                       std::tuple(b.time, b.doppler, b.level_db);
              });
    result.grid = grid_;
    for (std::size_t f = 0; f < bank_.filters(); ++f) result.dopplers.push_back(bank_.doppler(f));
    result.time_cell = 1.0 / replica_.noise_bandwidth();
    result.doppler_cell = doppler_cell(replica_);
    const double off = 0.25 * result.doppler_cell;
    result.delay_per_doppler = -doppler_answer(replica_, 1.0 + off).delay / off;
    return result;
  }

 private:
  struct Work {
    FftBuffer<std::complex<float>> out;
    std::vector<float> power, background, threshold;
    BackgroundEstimator::Scratch scratch;
    std::vector<float> doppler_time;  // [filters × columns]
  };

  struct PlacedProbe {
    std::size_t beam = 0, filter = 0, sample = 0;
    bool inside = false;
    double threshold = infinity;  // |y|²
  };

  /// \return level of an echo of power |y|² [dB re 1 µPa]
  static double level_of(double power) {
    return db_from_power(0.5 * power) - db_from_amplitude(micropascal);
  }

  void place_probes(std::span<const Probe> probes) {
    const double last = static_cast<double>(bank_.samples()) - 1.0;
    for (const Probe& probe : probes) {
      PlacedProbe placed;
      const double sample = std::round((probe.time - bank_.time(0.0)) * bank_.sample_rate());
      placed.inside = sample >= 0.0 && sample <= last;
      if (placed.inside) placed.sample = static_cast<std::size_t>(sample);
      double most = -1.0, least = infinity;
      for (std::size_t b = 0; b < grid_.looks.size(); ++b) {
        const double heard =
            beam_pattern(phones_, weights_, grid_.looks[b], probe.look, wavenumber(1.0));
        if (heard > most) most = heard, placed.beam = b;
      }
      for (std::size_t f = 0; f < bank_.filters(); ++f)
        if (const double off = std::abs(bank_.doppler(f) - probe.doppler); off < least)
          least = off, placed.filter = f;
      // Beyond the bank's last filter as far as that still answers.
      const double step = bank_.filters() > 1 ? bank_.doppler(1) - bank_.doppler(0) : 0.0;
      placed.inside = placed.inside && least <= 0.5 * step + doppler_cell(replica_);
      probes_.push_back(placed);
    }
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
    tbb::parallel_for(std::size_t{0}, beams.beams, [&](std::size_t b) {
      if (proceed && !proceed()) throw Interrupted();
      Work& work = works.local();
      work.out.reserve(bank_.work());
      work.power.resize(n);
      work.background.resize(n);
      work.threshold.resize(n);
      work.doppler_time.resize(bank_.filters() * columns, 0.0F);
      for (std::size_t f = 0; f < bank_.filters(); ++f) {
        bank_.filter(f, beams.beam(b), work.out.data());
        for (std::size_t i = 0; i < n; ++i) work.power[i] = std::norm(work.out[i]);
        estimator_(work.power, work.background, work.threshold, work.scratch);
        pick(b, f, work, found[b]);
        for (PlacedProbe& probe : probes_)  // each has one beam and one filter
          if (probe.inside && probe.beam == b && probe.filter == f)
            probe.threshold = work.threshold[probe.sample];
        for (std::size_t column = 0; column < columns; ++column) {
          float most = 0.0F;
          for (std::size_t i = column * n / columns; i < (column + 1) * n / columns; ++i)
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

  void pick(std::size_t beam, std::size_t filter, const Work& work, std::vector<Peak>& into) const {
    const std::size_t n = work.power.size();
    for (std::size_t i = 0; i < n; ++i) {
      const float p = work.power[i];
      if (!(p > work.threshold[i])) continue;
      if ((i > 0 && work.power[i - 1] > p) || (i + 1 < n && work.power[i + 1] >= p)) continue;
      const double time = bank_.time(static_cast<double>(i));
      if (time < settings_.first_time || time > settings_.last_time) continue;
      into.push_back({.beam = beam,
                      .filter = filter,
                      .sample = i,
                      .power = p,
                      .background = work.background[i],
                      .threshold = work.threshold[i]});
    }
  }

  /// Between the samples, filters and beams.
  Detection refine(const Peak& peak, const BeamSpectra& beams) const {
    FftBuffer<std::complex<float>> out(bank_.work());
    const std::size_t i = peak.sample, last = bank_.filters() - 1;
    const auto filtered = [&](std::size_t f) {
      bank_.filter(f, beams.beam(peak.beam), out.data());
      return out[i];
    };
    double filter_offset = 0.0;
    if (peak.filter > 0 && peak.filter < last) {
      const double before = log_power(filtered(peak.filter - 1));
      const double after = log_power(filtered(peak.filter + 1));
      filter_offset = top_of(before, log_power(filtered(peak.filter)), after);
    } else {
      static_cast<void>(filtered(peak.filter));
    }
    double sample_offset = 0.0;
    if (i > 0 && i + 1 < bank_.samples())
      sample_offset = top_of(log_power(out[i - 1]), log_power(out[i]), log_power(out[i + 1]));
    Detection d;
    d.time = bank_.time(static_cast<double>(i) + sample_offset);
    const double step = last > 0 ? bank_.doppler(1) - bank_.doppler(0) : 0.0;
    d.doppler = bank_.doppler(peak.filter) + filter_offset * step;
    point(d, grid_.looks[peak.beam]);
    const double power = std::max(static_cast<double>(peak.power), power_at(d));
    d.snr_db = db_from_power(power / static_cast<double>(peak.background));
    d.excess_db = db_from_power(power / static_cast<double>(peak.threshold));
    d.level_db = level_of(power);
    return d;
  }

  /// The phones' own outputs at a time and factor, delays taken out as the beam does. Only the
  /// stretch of the record that the replica covers is transformed: the rest would add nothing.
  std::vector<std::complex<double>> snapshot(double time, double doppler, const Vec3& look) const {
    const double rate = baseband_.sample_rate, spacing = rate / static_cast<double>(cut_);
    // The cut begins an eighth of its length before the echo, as far as the record goes.
    const double before = 0.125 * static_cast<double>(cut_);
    const auto wanted = std::lround((time - baseband_.start) * rate - before);
    const auto first_sample = static_cast<std::ptrdiff_t>(wanted);
    const auto half = static_cast<std::ptrdiff_t>(cut_ / 2);
    const double room = 0.25 * replica_.bandwidth();
    const auto bin = [&](double f) {
      return static_cast<std::ptrdiff_t>(std::floor((f * doppler - baseband_.carrier) / spacing));
    };
    const std::ptrdiff_t first = std::max(bin(replica_.lowest_frequency() - room), 1 - half);
    const std::ptrdiff_t last = std::min(bin(replica_.highest_frequency() + room), half - 1);
    std::vector<std::complex<double>> weights;
    for (std::ptrdiff_t k = first; k <= last; ++k)
      weights.push_back(std::conj(
          replica_.spectrum(baseband_.carrier + static_cast<double>(k) * spacing, doppler)));
    const double scale = doppler / (replica_.energy() * static_cast<double>(cut_));
    const ComplexFft<float> fft(cut_);
    FftBuffer<std::complex<float>> work(cut_);
    std::vector<std::complex<double>> sums;
    for (std::size_t n = 0; n < phones_.size(); ++n) {
      const auto row = baseband_.channel(n);
      for (std::size_t i = 0; i < cut_; ++i) {
        const std::ptrdiff_t at = first_sample + static_cast<std::ptrdiff_t>(i);
        work[i] = at >= 0 && at < std::ssize(row) ? row[static_cast<std::size_t>(at)]
                                                  : std::complex<float>(0.0F);
      }
      fft.forward(work.data());
      // From bin to bin the phase of the delay turns by a constant step.
      const double lag = time - baseband_.start - static_cast<double>(first_sample) / rate -
                         look.dot(phones_[n]) / sound_speed_;  // [s]
      const double turns = spacing * lag;
      const std::complex<double> step = std::polar(1.0, 2.0 * pi * turns);
      std::complex<double> turn =
          std::polar(1.0, 2.0 * pi * std::remainder(turns * static_cast<double>(first), 1.0));
      std::complex<double> sum = 0.0;
      for (std::ptrdiff_t k = first; k <= last; ++k) {
        const auto at = static_cast<std::size_t>(k < 0 ? k + static_cast<std::ptrdiff_t>(cut_) : k);
        sum += weights[static_cast<std::size_t>(k - first)] * std::complex<double>(work[at]) * turn;
        turn *= step;
      }
      sums.push_back(sum * scale);
    }
    return sums;
  }

  [[nodiscard]] double wavenumber(double doppler) const { return 2.0 * pi / wavelength_ * doppler; }

  /// Power of the conventional beam exactly there.
  double power_at(const Detection& d) const {
    const auto x = snapshot(d.time, d.doppler, d.look);
    std::complex<double> sum = 0.0;
    for (std::size_t n = 0; n < phones_.size(); ++n)
      sum += weights_[n] * x[n] *
             std::polar(1.0, -2.0 * pi * baseband_.carrier * d.look.dot(phones_[n]) / sound_speed_);
    return std::norm(sum);
  }

  void point(Detection& d, const Vec3& beam) const {
    d.cosine = none;
    d.bearing = none;
    d.elevation = none;
    d.look = beam;
    if (shape_.kind == ArrayKind::point) return;
    auto x = snapshot(d.time, d.doppler, beam);
    // The envelopes are aligned by the beam's delays; the carrier's phases are still the wave's.
    // What is left of the delays' differences turns at the pulse's frequency.
    const double k = wavenumber(d.doppler), carrier = 2.0 * pi * baseband_.carrier / sound_speed_;
    for (std::size_t n = 0; n < phones_.size(); ++n)
      x[n] *= std::polar(1.0, (k - carrier) * beam.dot(phones_[n] - shape_.centre));
    d.look = refine_direction(x, phones_, shape_, weights_, beam, grid_.spacing, k);
    const double elevation = std::asin(std::clamp(-d.look.z(), -1.0, 1.0));
    const double bearing = std::atan2(d.look.x(), d.look.y());
    if (shape_.kind == ArrayKind::line) {
      d.cosine = d.look.dot(shape_.axis);
      if (shape_.upright())
        d.elevation =
            std::asin(std::clamp(shape_.axis.z() < 0.0 ? d.cosine : -d.cosine, -1.0, 1.0));
      else
        d.bearing = bearing;
      return;
    }
    d.bearing = bearing;
    if (shape_.bent)
      d.cosine = d.look.dot(shape_.axis);
    else
      d.elevation = elevation;
  }

  const Baseband& baseband_;
  std::span<const Vec3> phones_;
  double sound_speed_;
  const Replica& replica_;
  const DetectorSettings& settings_;
  double wavelength_;
  ArrayShape shape_;
  BeamGrid grid_;
  std::vector<double> weights_;
  MatchedFilterBank bank_;
  BackgroundEstimator estimator_;
  BeamSpectra channels_;
  std::vector<PlacedProbe> probes_;
  std::size_t cut_;  // samples of baseband that a snapshot looks at
};

}  // namespace

DetectorResult detect(const Baseband& baseband, std::span<const Vec3> phones, double sound_speed,
                      const Replica& replica, std::span<const double> dopplers,
                      const DetectorSettings& settings, std::span<const Probe> probes,
                      const std::function<bool()>& proceed) {
  return Search(baseband, phones, sound_speed, replica, dopplers, settings).run(probes, proceed);
}

}  // namespace asdic
