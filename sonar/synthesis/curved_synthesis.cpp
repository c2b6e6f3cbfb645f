// Part of Synthesizer: returns whose delay curves over the pulse.
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "core/rotate_back.h"
#include "core/units.h"
#include "raytrace/parallel/parallel.h"
#include "sonar/synthesis/rotating_phase.h"
#include "sonar/synthesis/synthesis.h"
#include "sonar/synthesis/synthesis_plan.h"

namespace asdic::detail {
namespace {

constexpr double left_out = 3e-5;                        // of an echo, −90 dB
constexpr std::size_t most_kept = std::size_t{8} << 20;  // bytes of waveforms at one time

std::complex<float> rotated(double cycles) {
  const auto rotation = static_cast<float>(2.0 * pi * (cycles - std::nearbyint(cycles)));
  return {std::cos(rotation), std::sin(rotation)};
}

/// A curved return on the baseband's grid: samples begin … end.
struct GridSpan {
  std::ptrdiff_t begin = 0, end = 0;
  [[nodiscard]] std::size_t size() const { return static_cast<std::size_t>(end - begin); }
};

/// A return of amplitude 1, sample by sample.
using Shape = std::vector<std::complex<float>>;

/// A return as it is received at a few lags about the array's reference point,
/// g(t − λ_k), g(τ) = A·c(u(τ))·e^{i2π(f·u(τ) − f_c·τ)}: between Chebyshev points λ_k of the
/// phones' lags the band-limited g is a polynomial.
struct Waveforms {
  GridSpan span;
  double lowest = 0.0, highest = 0.0;       // lags [s]
  std::vector<double> lags, barycentric;    // [nodes] λ_k and their weights
  std::vector<std::complex<float>> values;  // [nodes × samples]
};

}  // namespace

/// p₊(t)·e^{−i2πf_c t} at one phone = A·c(u)·e^{i2π(f·u − f_c·t)}, u = u(t') − T/2 from the pulse's
/// middle.
class CurvedSynthesis {
 public:
  CurvedSynthesis(const Synthesizer::Plan& plan, std::span<const Vec3> phones, Baseband& baseband,
                  PropagationMemory* memory)
      : plan_(plan),
        memory_(memory),
        pulse_(plan.pulses.front()),
        phones_(phones),
        baseband_(baseband),
        start_(plan.recording.start),
        half_band_(static_cast<double>(plan.highest_bin) * plan.recording.sample_rate /
                   static_cast<double>(plan.passband_length)) {}

  void add(std::span<const CurvedReturn> returns) {
    for (std::size_t begin = 0, end = 0; begin < returns.size(); begin = end) {
      std::vector<Waveforms> shared;
      for (std::size_t bytes = 0; end < returns.size() && (end == begin || bytes < most_kept);
           ++end) {
        shared.push_back(for_array(returns[end]));
        bytes += shared.back().lags.size() * shared.back().span.size() * sizeof(float) * 2;
      }
      const auto batch = returns.subspan(begin, end - begin);
      in_parallel(batch.size(), [&](std::size_t i) { evaluate(batch[i], shared[i]); });
      in_parallel(phones_.size(), [&](std::size_t channel) {
        for (std::size_t i = 0; i < batch.size(); ++i) {
          const int own = batch[i].straight.channel;
          if (own != Return::all_channels && own != static_cast<int>(channel)) continue;
          if (shared[i].lags.empty())
            add_alone(batch[i], channel, own != Return::all_channels);
          else
            add_shared(batch[i], shared[i], channel);
        }
      });
    }
  }

 private:
  [[nodiscard]] double time(std::ptrdiff_t i) const {
    return start_ + static_cast<double>(i) / plan_.rate;
  }
  [[nodiscard]] std::size_t place(std::ptrdiff_t i) const {
    const auto period = static_cast<std::ptrdiff_t>(plan_.length);
    return static_cast<std::size_t>((i % period + period) % period);
  }

  /// Where a return is received with lags between two; empty if nothing of it reaches the record.
  [[nodiscard]] GridSpan span(const CurvedReturn& r, double lowest, double highest) const {
    const double longest = pulse_.half_duration() / (1.0 - plan_.max_doppler);
    const double ringing =
        (pulse_.half_duration() - 0.5 * plan_.pulse_duration) / (1.0 - plan_.max_doppler);
    const double from = r.curve.first_received() + lowest - ringing,
                 to = r.curve.last_received() + highest + ringing, middle = 0.5 * (from + to);
    const double record_end =
        start_ + static_cast<double>(plan_.recording.samples) / plan_.recording.sample_rate;
    if (middle < start_ - longest || middle > record_end + longest) return {};
    return {.begin = static_cast<std::ptrdiff_t>(std::ceil((from - start_) * plan_.rate)),
            .end = static_cast<std::ptrdiff_t>(std::floor((to - start_) * plan_.rate)) + 1};
  }

  /// Lags and nodes that serve all phones; none where phone by phone is no dearer.
  [[nodiscard]] Waveforms for_array(const CurvedReturn& r) const {
    Waveforms w;
    if (r.straight.channel != Return::all_channels) return w;
    const auto& pieces = r.curve.pieces();
    const Vec3 middle = 0.5 * (pieces.front().first_slowness + pieces.back().last_slowness);
    w.lowest = infinity;
    w.highest = -infinity;
    double rotated_by = 0.0;  // a lag is this far from that by the middle slowness, at most [s]
    for (const Vec3& x : phones_) {
      w.lowest = std::min(w.lowest, middle.dot(x));
      w.highest = std::max(w.highest, middle.dot(x));
      for (const DelayCurve::Piece& piece : pieces)
        for (const Vec3& s : {piece.first_slowness, piece.last_slowness})
          rotated_by = std::max(rotated_by, std::abs((s - middle).dot(x)));
    }
    // That is neglected in g, whose phase turns by 2π·half_band a second, not in e^{−i2πf_c λ}.
    if (!(2.0 * pi * half_band_ * rotated_by < left_out)) return w;
    // e^{izx} through N Chebyshev points errs by about 4(z/2)^N/N! (doppler_expansion.h).
    const double z = pi * half_band_ * (w.highest - w.lowest);
    std::size_t nodes = 1;
    double error = 2.0 * z;
    while (error > left_out) {
      if (2 * ++nodes > phones_.size()) return w;
      error *= 0.5 * z / static_cast<double>(nodes);
    }
    for (std::size_t k = 0; k < nodes; ++k) {
      const double theta = pi * (static_cast<double>(k) + 0.5) / static_cast<double>(nodes);
      w.lags.push_back(0.5 * (w.lowest + w.highest) -
                       0.5 * (w.highest - w.lowest) * std::cos(theta));
      w.barycentric.push_back(k % 2 == 0 ? std::sin(theta) : -std::sin(theta));
    }
    w.span = span(r, w.lowest - rotated_by, w.highest + rotated_by);
    return w;
  }

  /// c(u)·e^{i2π(f·u − f_c·τ)} of one sample after the other, lag by lag.
  [[nodiscard]] Shape shape(const DelayCurve& curve, const Waveforms& w) const {
    Shape found;
    found.reserve(w.lags.size() * w.span.size());
    std::array<double, RotatingPhase::block> received, since, cycles, re,
        im;  // since: from the pulse's middle, u
    for (const double lag : w.lags)
      for (std::ptrdiff_t i = w.span.begin; i < w.span.end;) {
        const auto count = static_cast<std::size_t>(std::min<std::ptrdiff_t>(
            w.span.end - i, static_cast<std::ptrdiff_t>(RotatingPhase::block)));
        for (std::size_t j = 0; j < count; ++j)
          received[j] = time(i + static_cast<std::ptrdiff_t>(j)) - lag;
        curve.sent_at({received.data(), count}, {since.data(), count});
        for (std::size_t j = 0; j < count; ++j) {
          since[j] -= 0.5 * plan_.pulse_duration;
          cycles[j] = plan_.carrier * received[j] - pulse_.centre_frequency() * since[j];
        }
        pulse_.at({since.data(), count}, {re.data(), count}, {im.data(), count});
        for (std::size_t j = 0; j < count; ++j) rotate_back(cycles[j], re[j], im[j]);
        for (std::size_t j = 0; j < count; ++j)
          found.emplace_back(static_cast<float>(re[j]), static_cast<float>(im[j]));
        i += static_cast<std::ptrdiff_t>(count);
      }
    return found;
  }

  /// The same, out of what is kept for that curve and those lags.
  [[nodiscard]] std::shared_ptr<const Shape> recalled(const DelayCurve& curve,
                                                      const Waveforms& w) const {
    const auto made = [&] { return std::make_shared<Shape>(shape(curve, w)); };
    if (memory_ == nullptr) return made();
    ExactKey key(Kept::waveform, plan_.identity, w.span.begin, w.span.end, w.lags);
    for (const DelayCurve::Piece& piece : curve.pieces()) key.add_all(piece.received, piece.sent);
    return memory_->remember(key, made, [](const Shape& values) {
      return values.capacity() * sizeof(Shape::value_type);
    });
  }

  void evaluate(const CurvedReturn& r, Waveforms& w) const {
    w.values.resize(w.lags.size() * w.span.size());
    if (w.values.empty()) return;
    const auto kept = recalled(r.curve, w);
    const float re = static_cast<float>(r.straight.amplitude.real()),
                im = static_cast<float>(r.straight.amplitude.imag());
    const float* from = reinterpret_cast<const float*>(kept->data());
    float* to = reinterpret_cast<float*>(w.values.data());
    for (std::size_t i = 0; i < 2 * kept->size(); i += 2) {
      to[i] = re * from[i] - im * from[i + 1];
      to[i + 1] = re * from[i + 1] + im * from[i];
    }
  }

  /// ℓ_k(λ): Lagrange's polynomials in barycentric form.
  [[nodiscard]] static std::vector<float> weights(const Waveforms& w, double lag) {
    std::vector<float> weight(w.lags.size(), 0.0F);
    double sum = 0.0;
    for (std::size_t k = 0; k < w.lags.size(); ++k) {
      const double distance = lag - w.lags[k];
      if (std::abs(distance) < 1e-15 || w.lags.size() == 1) {  // on the node
        std::fill(weight.begin(), weight.end(), 0.0F);
        weight[k] = 1.0F;
        return weight;
      }
      sum += w.barycentric[k] / distance;
    }
    for (std::size_t k = 0; k < w.lags.size(); ++k)
      weight[k] = static_cast<float>(w.barycentric[k] / ((lag - w.lags[k]) * sum));
    return weight;
  }

  /// g(t − λ)·e^{−i2πf_c λ(t)}, λ(t) straight in every segment of the curve.
  void add_shared(const CurvedReturn& r, const Waveforms& w, std::size_t channel) {
    const Vec3& x = phones_[channel];
    const auto& pieces = r.curve.pieces();
    const std::vector<float> weight =
        weights(w, 0.5 * (pieces.front().first_slowness + pieces.back().last_slowness).dot(x));
    std::complex<float>* row = baseband_.values.data() + channel * plan_.length;
    std::size_t at = place(w.span.begin);
    std::ptrdiff_t i = w.span.begin;
    for (std::size_t p = 0; p < pieces.size() && i < w.span.end; ++p) {
      const DelayCurve::Piece& piece = pieces[p];
      const double first_lag = piece.first_slowness.dot(x), last_lag = piece.last_slowness.dot(x);
      const auto end =
          p + 1 == pieces.size()
              ? w.span.end
              : std::min(w.span.end,
                         static_cast<std::ptrdiff_t>(
                             std::floor((piece.received.back() + last_lag - start_) * plan_.rate)) +
                             1);
      const double slope =
          (last_lag - first_lag) / (piece.received.back() - piece.received.front());  // dλ/dt
      const double cycles =
          plan_.carrier * (first_lag + slope * (time(i) - piece.received.front()));
      const double per_sample = plan_.carrier * slope / plan_.rate;  // cycles
      RotatingPhase rotating(-cycles, -per_sample);
      while (i < end) {
        const auto count = static_cast<std::size_t>(
            std::min<std::ptrdiff_t>(end - i, static_cast<std::ptrdiff_t>(RotatingPhase::block)));
        std::array<float, 2 * RotatingPhase::block> sum{};
        for (std::size_t k = 0; k < weight.size(); ++k) {
          const float* value = reinterpret_cast<const float*>(
              w.values.data() + k * w.span.size() + static_cast<std::size_t>(i - w.span.begin));
          for (std::size_t j = 0; j < 2 * count; ++j) sum[j] += weight[k] * value[j];
        }
        rotating.rotation(sum);
        for (std::size_t j = 0; j < count;) {  // up to where the period begins again
          const std::size_t until = std::min(count, j + plan_.length - at);
          float* out = reinterpret_cast<float*>(row + at);
          at += until - j;
          for (std::size_t k = 2 * j; k < 2 * until; ++k) *out++ += sum[k];
          if (at == plan_.length) at = 0;
          j = until;
        }
        i += static_cast<std::ptrdiff_t>(count);
      }
    }
  }

  void add_alone(const CurvedReturn& r, std::size_t channel, bool own) {
    const Vec3 x = own ? Vec3(Vec3::Zero()) : phones_[channel];
    const auto& pieces = r.curve.pieces();
    const GridSpan received =
        span(r, pieces.front().first_slowness.dot(x), pieces.back().last_slowness.dot(x));
    std::complex<float>* row = baseband_.values.data() + channel * plan_.length;
    std::size_t at = place(received.begin);
    for (std::ptrdiff_t i = received.begin; i < received.end; ++i) {
      const double t = time(i);
      const double u = r.curve.sent_at(t, x) - 0.5 * plan_.pulse_duration;
      row[at] += std::complex<float>(r.straight.amplitude * pulse_.at(u)) *
                 rotated(pulse_.centre_frequency() * u - plan_.carrier * t);
      if (++at == plan_.length) at = 0;
    }
  }

  const Synthesizer::Plan& plan_;
  PropagationMemory* memory_;  // of shapes; null: none
  const BandLimitedPulse& pulse_;
  std::span<const Vec3> phones_;
  Baseband& baseband_;
  double start_, half_band_;
};

void Synthesizer::add_curved(std::span<const CurvedReturn> returns, std::span<const Vec3> phones,
                             Baseband& baseband) const {
  assert(baseband.channels == phones.size() && baseband.samples == plan_->length);
  CurvedSynthesis(*plan_, phones, baseband, memory_).add(returns);
}

}  // namespace asdic::detail
