#include <algorithm>
#include <cmath>

#include "raytrace/like_bellhop/beam.h"

namespace asdic::like_bellhop {
namespace {

constexpr double cut_in_widths = 4.0;  // a Gaussian beam ends at 4σ

/// A straight piece of a ray, in whose coordinates receivers are found.
struct Chord {
  const LiteralPoint &a, &b;
  Vec2 tangent, normal;
  double length, dq;
  std::complex<double> dtau;

  Chord(const LiteralPoint& begin, const LiteralPoint& end) noexcept
      : a(begin), b(end), dq(end.q1 - begin.q1), dtau(end.tau - begin.tau) {
    const Vec2 d = b.x - a.x;
    length = d.norm();
    tangent = d / length;
    normal = Vec2(-tangent.y(), tangent.x());
  }
};

struct Hat {
  static constexpr double steep = 0.5;  // |cos| of a chord above which depths are preselected
  double factor, q0;

  double reach(const Chord& k, double cosine) const noexcept {
    return std::max(std::abs(k.a.q1), std::abs(k.b.q1)) / q0 / cosine;
  }
  /// \return whether the receiver, n off the axis where q is as given, is inside
  bool weigh(const Chord& k, double q, double n, Contribution& out) const noexcept {
    const double width = std::abs(q) / q0;
    if (n >= width) return false;
    out.amplitude = factor * std::sqrt(k.b.c / std::abs(q)) * k.b.amplitude;
    out.weight = (width - n) / width;
    return true;
  }
  double reflections(const Chord& k) const noexcept { return k.a.phase; }
};

struct Gaussian {
  static constexpr double steep = 0.50001;
  double factor, q0, frequency;

  /// σ is never less than a few wavelengths, but near the source, where time has not come to that.
  double least(const Chord& k) const noexcept {
    const double wavelength = k.a.c / frequency;
    return std::min(0.2 * frequency * k.b.tau.real(), pi * wavelength);
  }
  double reach(const Chord& k, double cosine) const noexcept {  // the least width is not slanted
    return cut_in_widths *
           std::max(std::max(std::abs(k.a.q1), std::abs(k.b.q1)) / q0 / cosine, least(k));
  }
  bool weigh(const Chord& k, double q, double n, Contribution& out) const noexcept {
    const double spacing = std::abs(q) / q0;
    const double sigma = std::max(spacing, least(k));
    if (n >= cut_in_widths * sigma || spacing == 0.0) return false;
    const double x = n / sigma;
    out.amplitude = factor / std::sqrt(2.0 * pi) * std::sqrt(k.b.c / std::abs(q)) * k.b.amplitude;
    out.weight = std::exp(-0.5 * x * x) * spacing / sigma;
    out.intensity_factor = std::sqrt(2.0 * pi);
    return true;
  }
  double reflections(const Chord& k) const noexcept { return k.b.phase; }
};

template <class Shape>
void lay(const Shape& shape, const Beam& beam, const ReceiverBlock& block, BeamSink& sink) {
  const auto& points = beam.ray.points;
  const auto& ranges = block.grid.ranges;
  CausticPhase caustics;
  for (std::size_t i = 1; i < points.size(); ++i) {
    const LiteralPoint &a = points[i - 1], &b = points[i];
    caustics.pass(a.q1);
    if (a.x.x() == b.x.x()) continue;  // a reflection, or a vertical piece: no range is inside
    const double low = std::min(a.x.x(), b.x.x()), high = std::max(a.x.x(), b.x.x());
    std::size_t column = std::max(first_at_or_beyond(block.grid, low), block.column_begin);
    // Forwards the segment's beginning belongs to it; backwards neither of its ends does.
    if (b.x.x() < a.x.x() && column < block.column_end && ranges[column] == low) ++column;
    if (column >= block.column_end || ranges[column] >= high) continue;

    const Chord chord(a, b);
    double top = -infinity, bottom = infinity;
    if (const double cosine = std::abs(chord.tangent.x()); cosine > Shape::steep) {
      const double reach = shape.reach(chord, cosine);
      top = std::min(a.x.y(), b.x.y()) - reach;
      bottom = std::max(a.x.y(), b.x.y()) + reach;
    }
    Contribution c;
    c.segment = i;
    c.end = &b;
    c.arrival_declination = std::atan2(chord.tangent.y(), chord.tangent.x());
    for (; column < block.column_end && ranges[column] < high; ++column) {
      for (std::size_t row = block.row_begin; row < block.row_end; ++row) {
        const double depth = block.depth(row, column);
        if (depth < top || depth > bottom) continue;
        const Vec2 off = Vec2(ranges[column], depth) - a.x;
        const double s = off.dot(chord.tangent) / chord.length;  // may lie outside 0..1
        const double n = std::abs(off.dot(chord.normal));
        const double q = a.q1 + s * chord.dq;
        if (!shape.weigh(chord, q, n, c)) continue;
        c.row = row;
        c.column = column;
        c.tau = a.tau + s * chord.dtau;
        c.phase = caustics.at(q, shape.reflections(chord));
        sink.take(c);
      }
    }
  }
}

}  // namespace

double Beam::launch_factor() const noexcept {
  return source == SourceKind::point ? std::sqrt(std::abs(std::cos(ray.declination))) : 1.0;
}

std::size_t first_at_or_beyond(const ReceiverGrid& grid, double range) noexcept {
  return static_cast<std::size_t>(
      std::lower_bound(grid.ranges.begin(), grid.ranges.end(), range) - grid.ranges.begin());
}

void lay_cartesian_hat(const Beam& beam, const ReceiverBlock& block, BeamSink& sink) {
  lay(Hat{beam.launch_factor(), beam.q0()}, beam, block, sink);
}

void lay_cartesian_gaussian(const Beam& beam, const ReceiverBlock& block, BeamSink& sink) {
  lay(Gaussian{beam.launch_factor(), beam.q0(), beam.frequency}, beam, block, sink);
}

}  // namespace asdic::like_bellhop
