#include "processing/coverage/turned_sum.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace asdic::detail {
namespace {

constexpr double nothing = 18.0;             // turned²: e⁻⁹
constexpr double furthest = 4.242640687119;  // its root [rad]
constexpr double step = 0.25;                // of the grid [rad]
constexpr int taps = 17;                     // on either side: step·taps > furthest
constexpr std::size_t fields = 5;            // of a node: two complex pressures and a power

using Sound = TurnedSum::Sound;

struct Span {
  double low, high;
  [[nodiscard]] double width() const noexcept { return high - low; }
};
Span span_of(const std::vector<Sound>& sounds, double Sound::*phase) {
  Span span{.low = sounds.front().*phase, .high = sounds.front().*phase};
  for (const Sound& s : sounds) {
    span.low = std::min(span.low, s.*phase);
    span.high = std::max(span.high, s.*phase);
  }
  return span;
}

/// Nodes of a line of phases: two beyond either end, which cubics need.
std::size_t nodes_of(const Span& span) { return static_cast<std::size_t>(span.width() / step) + 5; }

/// Lagrange's cubic weights of the four nodes about a place t ∈ [0, 1) between the middle two.
std::array<double, 4> cubic_weights(double t) noexcept {
  return {-t * (t - 1.0) * (t - 2.0) / 6.0, (t + 1.0) * (t - 1.0) * (t - 2.0) / 2.0,
          -(t + 1.0) * t * (t - 2.0) / 2.0, (t + 1.0) * t * (t - 1.0) / 6.0};
}

/// Weights e^{−½·sharp·(k·step)²}, k from 0 to `taps`.
std::array<double, taps + 1> gaussian(double sharp) {
  std::array<double, taps + 1> weights{};
  for (int k = 0; k <= taps; ++k) weights[k] = std::exp(-0.5 * sharp * k * step * k * step);
  return weights;
}

/// out += Σ_k w_|k|·in moved by k·stride, both of n values.
void blur(const double* in, double* out, std::ptrdiff_t n, std::ptrdiff_t stride,
          const std::array<double, taps + 1>& weights) {
  for (int k = -taps; k <= taps; ++k) {
    const double weight = weights[static_cast<std::size_t>(std::abs(k))];
    const std::ptrdiff_t shift = k * stride;
    const std::ptrdiff_t begin = std::max<std::ptrdiff_t>(0, -shift), end = std::min(n, n - shift);
    for (std::ptrdiff_t i = begin; i < end; ++i) out[i] += weight * in[i + shift];
  }
}

}  // namespace

TurnedSum::Sums TurnedSum::one_by_one(std::vector<Sound>& sounds) {
  Sums sums;
  const bool by_along =
      span_of(sounds, &Sound::along).width() > span_of(sounds, &Sound::across).width();
  double Sound::*const phase = by_along ? &Sound::along : &Sound::across;
  std::sort(sounds.begin(), sounds.end(),
            [&](const Sound& a, const Sound& b) { return a.*phase < b.*phase; });
  std::size_t first = 0;
  for (std::size_t i = 0; i < sounds.size(); ++i) {
    const Sound& a = sounds[i];
    sums.power += a.power;
    sums.open += std::norm(a.open);
    sums.kept += a.power * a.power;
    while (a.*phase - sounds[first].*phase > furthest) ++first;
    for (std::size_t j = first; j < i; ++j) {
      const Sound& b = sounds[j];
      const double x = a.along - b.along, y = a.across - b.across, turned = x * x + y * y;
      if (turned > nothing) continue;
      const double kept = std::exp(-0.5 * turned);
      sums.power += 2.0 * kept * std::real(a.pressure * std::conj(b.pressure));
      sums.open += 2.0 * kept * std::real(a.open * std::conj(b.open));
      sums.kept += 2.0 * kept * kept * a.power * b.power;
    }
  }
  return sums;
}

TurnedSum::Sums TurnedSum::on_grid(const std::vector<Sound>& sounds) {
  double Sound::*longer = &Sound::along;
  double Sound::*shorter = &Sound::across;
  if (span_of(sounds, longer).width() < span_of(sounds, shorter).width())
    std::swap(longer, shorter);
  const Span in_row = span_of(sounds, longer), of_rows = span_of(sounds, shorter);
  const std::size_t columns = nodes_of(in_row), rows = nodes_of(of_rows), nodes = rows * columns;
  grid_.assign(fields * nodes, 0.0);
  for (const Sound& s : sounds) {
    const double x = (s.*longer - in_row.low) / step + 1.0,
                 y = (s.*shorter - of_rows.low) / step + 1.0;
    const auto column = static_cast<std::size_t>(x), row = static_cast<std::size_t>(y);
    const auto to_column = cubic_weights(x - static_cast<double>(column)),
               to_row = cubic_weights(y - static_cast<double>(row));
    const std::array<double, fields> values{s.pressure.real(), s.pressure.imag(), s.open.real(),
                                            s.open.imag(), s.power};
    for (std::size_t f = 0; f < fields; ++f)
      for (std::size_t j = 0; j < 4; ++j) {
        double* const at = &grid_[f * nodes + (row - 1 + j) * columns + column - 1];
        const double value = values[f] * to_row[j];
        for (std::size_t i = 0; i < 4; ++i) at[i] += value * to_column[i];
      }
  }
  std::array<double, fields> sums{};
  const auto size = static_cast<std::ptrdiff_t>(nodes),
             width = static_cast<std::ptrdiff_t>(columns);
  for (std::size_t f = 0; f < fields; ++f) {
    const auto weights = gaussian(f + 1 == fields ? 2.0 : 1.0);  // K² of powers
    const double* const in = &grid_[f * nodes];
    along_.assign(nodes, 0.0);
    for (std::ptrdiff_t first = 0; first < size; first += width)
      blur(in + first, &along_[static_cast<std::size_t>(first)], width, 1, weights);
    blurred_.assign(nodes, 0.0);
    blur(along_.data(), blurred_.data(), size, width, weights);
    for (std::size_t i = 0; i < nodes; ++i) sums[f] += in[i] * blurred_[i];
  }
  return {.power = sums[0] + sums[1], .open = sums[2] + sums[3], .kept = sums[4]};
}

TurnedSum::Sums TurnedSum::operator()(std::vector<Sound>& sounds) {
  if (sounds.empty()) return {};
  const Span along = span_of(sounds, &Sound::along), across = span_of(sounds, &Sound::across);
  const double widest = std::max(along.width(), across.width());
  // In multiplications, about: an exponential and two products; taps of all fields, both ways.
  const auto n = static_cast<double>(sounds.size());
  const double each = 25.0 * 0.5 * n * n * std::min(1.0, 2.0 * furthest / std::max(widest, 1e-9)),
               nodes = (along.width() / step + 5.0) * (across.width() / step + 5.0),
               grid = 0.5 * fields * 2.0 * (2.0 * taps + 1.0) * nodes + 16.0 * fields * n;
  constexpr double most_nodes = 1 << 20;
  return each < grid || nodes > most_nodes ? one_by_one(sounds) : on_grid(sounds);
}

}  // namespace asdic::detail
