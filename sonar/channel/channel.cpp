#include "sonar/channel/channel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>

#include "core/error.h"
#include "core/text.h"
#include "raytrace/ocean/depth_function.h"
#include "raytrace/parallel/parallel.h"
#include "sonar/echoes/direct_blast.h"
#include "sonar/echoes/one_leg.h"
#include "sonar/paths/delay_curve.h"
#include "sonar/signal/fft.h"
#include "sonar/signal/sampled_signal.h"

namespace asdic::detail {
namespace {

using Complex = std::complex<double>;

constexpr double not_there = std::numeric_limits<double>::quiet_NaN();
constexpr double least_step = 1e-6;          // between times [s]
constexpr double least_step_of_path = 1e-3;  // where a path begins or ends [s]
constexpr std::size_t most_times = 20000;
constexpr double faintest = 1e-3;  // of the loudest path, that is judged
constexpr double amplitude_error = 1e-3;

/// What tells paths apart as their ends move: history and way up or down; the last number counts
/// those alike.
using History = std::tuple<int, int, int, int, int, int>;

struct PathAt {
  double delay = 0.0, doppler = 1.0;
  Complex amplitude = 0.0;
  double launch = 0.0, arrival = 0.0, bearing = 0.0, length = 0.0;
};
using PathsAt = std::map<History, PathAt>;

/// All phones at one time.
struct Moment {
  double time = 0.0;
  std::vector<PathsAt> phones;
};

/// Where a cubic with these values and slopes is between two places.
double hermite(double x0, double x1, double y0, double y1, double d0, double d1, double x) {
  const double h = x1 - x0, s = (x - x0) / h, r = 1.0 - s;
  return y0 * r * r * (1.0 + 2.0 * s) + y1 * s * s * (1.0 + 2.0 * r) +
         h * s * r * (d0 * r - d1 * s);
}

/// When was sent what is received between two times.
struct ChannelPiece {
  double received0, received1, sent0, sent1, doppler0, doppler1;
  Complex amplitude0, amplitude1;

  [[nodiscard]] double sent_at(double received) const noexcept {
    if (received <= received0) return sent0 + doppler0 * (received - received0);
    if (received >= received1) return sent1 + doppler1 * (received - received1);
    return hermite(received0, received1, sent0, sent1, doppler0, doppler1, received);
  }
  [[nodiscard]] Complex amplitude_at(double sent) const noexcept {
    const double s = std::clamp((sent - sent0) / (sent1 - sent0), 0.0, 1.0);
    return (1.0 - s) * amplitude0 + s * amplitude1;
  }
};

ChannelPiece piece_between(double t0, const PathAt& a, double t1, const PathAt& b) {
  return {t0 + a.delay, t1 + b.delay, t0, t1, a.doppler, b.doppler, a.amplitude, b.amplitude};
}

/// Paths at any time.
class Sounding {
 public:
  Sounding(const PingSimulator& simulator, const ChannelNeed& need)
      : simulator_(simulator),
        need_(need),
        sent_(simulator.transmission(need.ping)),
        projector_(simulator.transmitter(need.ping)),
        frequency_(need.frequency > 0.0 ? need.frequency
                                        : simulator.pulse(sent_.transmitter).centre_frequency()) {}

  [[nodiscard]] double frequency() const noexcept { return frequency_; }
  [[nodiscard]] double start() const noexcept { return sent_.time; }

  [[nodiscard]] Moment at(double time) const {
    Transmission sent = sent_;
    sent.time += time;
    const PingGeometry geometry(simulator_.scenario(), sent, need_.ping);
    const double c = simulator_.paths().speed_at(geometry.source().position);
    const double centre = simulator_.pulse(sent_.transmitter).centre_frequency();
    const BeamPattern pattern(projector_, c / frequency_, c, geometry.source_heading(), c / centre);
    const EchoContext context{.paths = simulator_.paths(),
                              .geometry = geometry,
                              .pattern = pattern,
                              .frequency = frequency_,
                              .array = need_.array};
    Moment moment{time, std::vector<PathsAt>(geometry.array(need_.array).phones.size())};
    in_parallel_chunks(moment.phones.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t n = begin; n < end; ++n)
        moment.phones[n] = paths(context, static_cast<int>(n));
    });
    return moment;
  }

 private:
  static PathsAt paths(const EchoContext& context, int phone) {
    PathsAt found;
    const BlastPaths blast = blast_paths(context, phone);
    for (const MetPath& met : blast.met) {
      const Return received = received_along(context, context.geometry.source(), met).received;
      const Arrival& path = met.path;
      const bool turns =
          path.surface_bounces + path.bottom_bounces + path.upper_turns + path.lower_turns > 0;
      History history{path.surface_bounces,
                      path.bottom_bounces,
                      path.upper_turns,
                      path.lower_turns,
                      turns && path.launch_elevation > 0.0 ? 1 : 0,
                      0};
      while (found.contains(history)) ++std::get<5>(history);
      found[history] = {.delay = received.delay,
                        .doppler = received.doppler,
                        .amplitude = received.amplitude,
                        .launch = path.launch_elevation,
                        .arrival = path.arrival_elevation,
                        .bearing = arrival_bearing(path, met.way.leg.bearing),
                        .length = path.path_length};
    }
    return found;
  }

  const PingSimulator& simulator_;
  const ChannelNeed& need_;
  Transmission sent_;
  Transmitter projector_;
  double frequency_;
};

/// Whether cubics between two moments tell of the one amid them.
enum class Fit { good, off, other_paths };
Fit fit(const Moment& a, const Moment& amid, const Moment& b, double frequency) {
  Fit worst = Fit::good;
  for (std::size_t n = 0; n < amid.phones.size(); ++n) {
    double loudest = 0.0;
    for (const auto& [history, path] : amid.phones[n])
      loudest = std::max(loudest, std::abs(path.amplitude));
    for (const auto& [history, path] : amid.phones[n]) {
      if (std::abs(path.amplitude) < faintest * loudest) continue;
      const auto before = a.phones[n].find(history), after = b.phones[n].find(history);
      if (before == a.phones[n].end() || after == b.phones[n].end()) {
        worst = std::max(worst, Fit::other_paths);
        continue;
      }
      const ChannelPiece all = piece_between(a.time, before->second, b.time, after->second);
      const double sent = all.sent_at(amid.time + path.delay);
      if (2.0 * pi * frequency * std::abs(sent - amid.time) > negligible_phase ||
          std::abs(all.amplitude_at(amid.time) - path.amplitude) > amplitude_error * loudest)
        return Fit::off;
    }
  }
  return worst;
}

/// Adds what lies between two moments, and the second.
void follow(const Sounding& sounding, const Moment& a, Moment b, std::vector<Moment>& found,
            bool& gave_up) {
  const double width = b.time - a.time;
  Moment amid = sounding.at(0.5 * (a.time + b.time));
  const Fit how = fit(a, amid, b, sounding.frequency());
  const bool split =
      how == Fit::off ? width > least_step : how == Fit::other_paths && width > least_step_of_path;
  if (split && found.size() < most_times) {
    follow(sounding, a, amid, found, gave_up);
    follow(sounding, amid, std::move(b), found, gave_up);
    return;
  }
  if (how == Fit::off && width > least_step) gave_up = true;
  found.push_back(std::move(amid));
  found.push_back(std::move(b));
}

ChannelPath nowhere(const History& history, std::size_t times) {
  ChannelPath path;
  std::tie(path.surface_bounces, path.bottom_bounces, path.upper_turns, path.lower_turns,
           std::ignore, std::ignore) = history;
  for (auto* values : {&path.delay, &path.doppler, &path.launch_elevation, &path.arrival_elevation,
                       &path.arrival_bearing, &path.length})
    values->assign(times, not_there);
  path.amplitude.assign(times, {not_there, not_there});
  return path;
}

/// The amplitude that it begins with, wherever it is.
void hold(ChannelPath& path) {
  const auto there = [](const Complex& amplitude) { return !std::isnan(amplitude.real()); };
  const Complex first = *std::find_if(path.amplitude.begin(), path.amplitude.end(), there);
  std::replace_if(path.amplitude.begin(), path.amplitude.end(), there, first);
}

/// The analytic signal, shifted down by a quarter of its rate, where SampledSignal is at its best.
SampledSignal shifted(std::span<const double> signal, double rate, std::size_t zeros) {
  const std::size_t length = fast_fft_length(signal.size() + 2 * zeros);
  const ComplexFft<double> fft(length);
  FftBuffer<Complex> x(length);
  for (std::size_t i = 0; i < signal.size(); ++i) x[i + zeros] = signal[i];
  fft.forward(x.data());
  for (std::size_t k = 0; k < length; ++k) {
    const bool half = k == 0 || 2 * k == length;
    x[k] *= (2 * k > length ? 0.0 : half ? 1.0 : 2.0) / static_cast<double>(length);
  }
  fft.inverse(x.data());
  std::vector<Complex> samples(length);
  constexpr std::array<Complex, 4> quarter = {Complex(1, 0), Complex(0, -1), Complex(-1, 0),
                                              Complex(0, 1)};
  for (std::size_t i = 0; i < length; ++i) samples[i] = x[i] * quarter[i % 4];
  return {samples, -static_cast<double>(zeros) / rate, rate};
}

}  // namespace

Channel channel(const PingSimulator& simulator, const ChannelNeed& need) {
  const Sounding sounding(simulator, need);
  const auto steps = std::max<std::size_t>(
      1, static_cast<std::size_t>(std::ceil(need.duration / need.step - 1e-9)));
  std::vector<Moment> moments{sounding.at(0.0)};
  bool gave_up = false;
  for (std::size_t i = 1; i <= steps; ++i) {
    const Moment last = moments.back();
    follow(sounding, last,
           sounding.at(need.duration * static_cast<double>(i) / static_cast<double>(steps)),
           moments, gave_up);
  }
  Channel made{.frequency = sounding.frequency(), .sent = sounding.start()};
  for (const Moment& moment : moments) made.times.push_back(moment.time);
  const std::size_t times = moments.size();
  for (std::size_t n = 0; n < moments.front().phones.size(); ++n) {
    std::map<History, ChannelPath> paths;
    for (std::size_t i = 0; i < times; ++i)
      for (const auto& [history, at] : moments[i].phones[n]) {
        ChannelPath& path = paths.try_emplace(history, nowhere(history, times)).first->second;
        path.delay[i] = at.delay;
        path.doppler[i] = at.doppler;
        path.amplitude[i] = at.amplitude;
        path.launch_elevation[i] = at.launch;
        path.arrival_elevation[i] = at.arrival;
        path.arrival_bearing[i] = at.bearing;
        path.length[i] = at.length;
      }
    std::vector<ChannelPath>& to = made.phones.emplace_back();
    for (auto& [history, path] : paths) {
      if (need.held) hold(path);
      to.push_back(std::move(path));
    }
    const auto first = [](const ChannelPath& path) {
      return *std::find_if(path.delay.begin(), path.delay.end(),
                           [](double delay) { return !std::isnan(delay); });
    };
    std::stable_sort(to.begin(), to.end(),
                     [&](const auto& a, const auto& b) { return first(a) < first(b); });
  }
  if (gave_up)
    made.warnings.push_back("channel: delays change faster than " + std::to_string(most_times) +
                            " times tell; ask for a shorter one");
  const Environment& ocean = simulator.scenario().environment;
  if (!ocean.surface.roughness.smooth() || !ocean.bottom.roughness.smooth())
    made.warnings.push_back(
        "channel: what rough boundaries scatter about their mirrored paths is left out; a ping's "
        "pressure has it");
  return made;
}

ChannelOutput through(const Channel& channel, std::span<const double> signal, double rate) {
  constexpr std::size_t zeros = 4096;  // Hilbert's kernel is −80 dB there
  const double duration = static_cast<double>(signal.size()) / rate;
  if (!(channel.times.back() >= duration - 1.5 / rate))
    throw InputError(
        {.where = "signal",
         .got = to_text(duration) + " s",
         .expected = "no longer than the channel, " + to_text(channel.times.back()) + " s"});
  double first = infinity, last = 0.0;
  for (const auto& phone : channel.phones)
    for (const ChannelPath& path : phone)
      for (std::size_t i = 0; i < path.delay.size(); ++i)
        if (!std::isnan(path.delay[i])) {
          first = std::min(first, channel.times[i] + path.delay[i]);
          last = std::max(last, channel.times[i] + path.delay[i]);
        }
  ChannelOutput out;
  if (!(first <= last)) return out;
  constexpr double margin = 64.0;
  const double begin = std::floor(first * rate - margin);
  out.start = begin / rate;
  out.samples = static_cast<std::size_t>(std::ceil(last * rate + margin) - begin);
  out.pressure.assign(out.samples * channel.phones.size(), 0.0F);
  const SampledSignal sent = shifted(signal, rate, zeros);
  in_parallel_chunks(channel.phones.size(), 1, [&](std::size_t from, std::size_t to) {
    std::vector<double> sum(out.samples);
    for (std::size_t n = from; n < to; ++n) {
      std::fill(sum.begin(), sum.end(), 0.0);
      for (const ChannelPath& path : channel.phones[n]) {
        const auto there = [&](std::size_t i) {
          return i < path.delay.size() && !std::isnan(path.delay[i]);
        };
        const auto at = [&](std::size_t i) {
          return PathAt{
              .delay = path.delay[i], .doppler = path.doppler[i], .amplitude = path.amplitude[i]};
        };
        for (std::size_t i = 0; i + 1 < channel.times.size(); ++i) {
          if (!there(i) || !there(i + 1)) continue;
          const ChannelPiece piece =
              piece_between(channel.times[i], at(i), channel.times[i + 1], at(i + 1));
          // Before the first and after the last it goes on, for what the sampling spreads.
          const double early = i == 0 ? margin : 0.0,
                       late = i + 2 == channel.times.size() ? margin : 0.0;
          const double low = std::ceil(piece.received0 * rate - early),
                       high = std::ceil(piece.received1 * rate + late);
          for (double k = std::max(low, begin); k < high; ++k) {
            const auto index = static_cast<std::size_t>(k - begin);
            if (index >= out.samples) break;
            const double u = piece.sent_at(k / rate);
            const Complex s = sent.at(u) * std::polar(1.0, 0.5 * pi * rate * u);
            sum[index] += (piece.amplitude_at(u) * s).real();
          }
        }
      }
      std::transform(sum.begin(), sum.end(),
                     out.pressure.begin() + static_cast<std::ptrdiff_t>(n * out.samples),
                     [](double p) { return static_cast<float>(p); });
    }
  });
  return out;
}

SignalBand band_of(std::span<const double> signal, double rate) {
  const std::size_t length = fast_fft_length(signal.size()) + fast_fft_length(signal.size()) % 2;
  const std::size_t even = fast_fft_length(length % 2 == 0 ? length : length + 1);
  const ComplexFft<double> fft(even);
  FftBuffer<Complex> x(even);
  std::copy(signal.begin(), signal.end(), x.data());
  fft.forward(x.data());
  double all = 0.0;
  for (std::size_t k = 0; 2 * k <= even; ++k) all += std::norm(x[k]);
  SignalBand band{.low = 0.0, .high = 0.5 * rate};
  double sum = 0.0;
  bool begun = false;
  for (std::size_t k = 0; 2 * k <= even; ++k) {
    sum += std::norm(x[k]);
    const double f = static_cast<double>(k) * rate / static_cast<double>(even);
    if (!begun && sum >= 0.005 * all) band.low = f, begun = true;
    if (sum >= 0.995 * all) {
      band.high = f;
      break;
    }
  }
  return band;
}

double absorption_error_db(const Channel& channel, const Environment& ocean,
                           const SignalBand& band) {
  double loudest = 0.0, longest = 0.0;
  for (const auto& phone : channel.phones)
    for (const ChannelPath& path : phone)
      for (const Complex& amplitude : path.amplitude)
        if (!std::isnan(amplitude.real())) loudest = std::max(loudest, std::abs(amplitude));
  for (const auto& phone : channel.phones)
    for (const ChannelPath& path : phone)
      for (std::size_t i = 0; i < path.length.size(); ++i)
        if (std::abs(path.amplitude[i]) > 0.01 * loudest)
          longest = std::max(longest, path.length[i]);
  const double depth = 0.5 * (ocean.surface.depth + ocean.bottom.depth);
  const auto loss = [&](double f) {
    return f > 0.0 ? attenuation_np_per_m(ocean, f).at(depth) * longest : 0.0;
  };
  const double centre = loss(channel.frequency);
  return db_from_amplitude(
      std::exp(std::max(std::abs(loss(band.low) - centre), std::abs(loss(band.high) - centre))));
}

}  // namespace asdic::detail
