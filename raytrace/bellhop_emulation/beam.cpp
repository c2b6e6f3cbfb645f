#include "raytrace/bellhop_emulation/beam.h"

#include <algorithm>
#include <cmath>

#include "raytrace/bellhop_emulation/column_walk.h"
#include "raytrace/bellhop_emulation/depth_line.h"

namespace asdic::detail::bellhop_emulation {
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

/// A beam's way over the receivers.
template <class Shape>
class CartesianLayer {
 public:
  CartesianLayer(const Shape& shape, const Beam& beam, const ReceiverBlock& block, BeamSink& sink)
      : shape_(shape), points_(beam.ray.points), block_(block), sink_(sink) {}

  void operator()() {
    ColumnWalk columns(block_, points_.front().x.x());
    for (std::size_t i = 1; i < points_.size(); ++i) {
      const LiteralPoint &a = points_[i - 1], &b = points_[i];
      caustics_.pass(a.q1);
      if (a.x.x() == b.x.x()) continue;  // a reflection, or a vertical piece
      columns.over(a.x.x(), b.x.x(), [&](std::size_t column) { add_beam(i, column); });
    }
  }

 private:
  /// The segment's contributions to the receivers of a column.
  void add_beam(std::size_t i, std::size_t column) {
    const LiteralPoint &a = points_[i - 1], &b = points_[i];
    const Chord chord(a, b);
    double top = -infinity, bottom = infinity;
    if (const double cosine = std::abs(chord.tangent.x()); cosine > Shape::steep) {
      const double reach = shape_.reach(chord, cosine);
      top = std::min(a.x.y(), b.x.y()) - reach;
      bottom = std::max(a.x.y(), b.x.y()) + reach;
    }
    Contribution c;
    c.segment = i;
    c.end = &b;
    c.column = column;
    c.arrival_declination = std::atan2(chord.tangent.y(), chord.tangent.x());
    for (std::size_t row = block_.row_begin; row < block_.row_end; ++row) {
      const double depth = block_.depth(row, column);
      if (depth < top || depth > bottom) continue;
      const Vec2 off = Vec2(block_.grid.ranges[column], depth) - a.x;
      const double s = off.dot(chord.tangent) / chord.length;  // may lie outside 0..1
      const double n = std::abs(off.dot(chord.normal));
      const double q = a.q1 + s * chord.dq;
      if (!shape_.weigh(chord, q, n, c)) continue;
      c.row = row;
      c.tau = a.tau + s * chord.dtau;
      c.phase = caustics_.at(q, shape_.reflections(chord));
      sink_.take(c);
    }
  }

  Shape shape_;
  const std::vector<LiteralPoint>& points_;
  const ReceiverBlock& block_;
  BeamSink& sink_;
  CausticPhase caustics_;
};

}  // namespace

double Beam::launch_factor() const noexcept {
  return source == SourceKind::point ? std::sqrt(std::abs(std::cos(ray.declination))) : 1.0;
}

void add_cartesian_hat(const Beam& beam, const ReceiverBlock& block, BeamSink& sink) {
  CartesianLayer(Hat{beam.launch_factor(), beam.q0()}, beam, block, sink)();
}

void add_cartesian_gaussian(const Beam& beam, const ReceiverBlock& block, BeamSink& sink) {
  CartesianLayer(Gaussian{beam.launch_factor(), beam.q0(), beam.frequency}, beam, block, sink)();
}

namespace {

/// Along the normals of a ray, without a correction of the delay for a receiver between two normals
/// that are not parallel. `weigh(segment, q, n, c)` says whether a receiver is inside.
void add_beam(const Beam& beam, const ReceiverBlock& block, BeamSink& sink, auto&& weigh) {
  for_each_depth_line(block, [&](double depth, std::size_t row, const ReceiverBlock& line) {
    CausticPhase caustics;
    follow_depth_line(beam.ray, depth, 1.0, line, [&](const LineSegment& s) {
      caustics.pass(s.a.q1);
      Contribution c;
      c.row = row;
      c.segment = s.index;
      c.end = &s.b;
      c.arrival_declination = std::atan2(s.b.t.y(), s.b.t.x());
      s.over_columns([&](std::size_t column, double w) {
        const double n = std::abs(s.na + w * (s.nb - s.na));
        const double q = s.a.q1 + w * (s.b.q1 - s.a.q1);
        if (q == 0.0 || !weigh(s, q, n, c)) return;
        c.column = column;
        c.tau = s.a.tau + w * (s.b.tau - s.a.tau);
        c.phase = caustics.at(q, s.a.phase);
        sink.take(c);
      });
    });
  });
}

}  // namespace

void add_ray_centred_hat(const Beam& beam, const ReceiverBlock& block, BeamSink& sink) {
  const double factor = beam.launch_factor(), q0 = beam.q0();
  add_beam(beam, block, sink, [=](const LineSegment& s, double q, double n, Contribution& c) {
    const double width = std::abs(q) / q0;
    if (n >= width) return false;
    c.amplitude = factor * std::sqrt(s.b.c / std::abs(q)) * s.b.amplitude;
    c.weight = (width - n) / width;
    return true;
  });
}

void add_ray_centred_gaussian(const Beam& beam, const ReceiverBlock& block, BeamSink& sink) {
  const double factor = beam.launch_factor(), q0 = beam.q0(), frequency = beam.frequency;
  add_beam(beam, block, sink, [=](const LineSegment& s, double q, double n, Contribution& c) {
    const double spacing = std::abs(q) / q0;
    const double least = std::min(0.2 * frequency * s.b.tau.real(), pi * s.a.c / frequency);
    const double sigma = std::max(spacing, least), x = n / sigma;
    if (x >= 4.0) return false;
    c.amplitude = factor / std::sqrt(2.0 * pi) * std::sqrt(s.b.c / std::abs(q)) * s.b.amplitude;
    c.weight = std::exp(-0.5 * x * x) * spacing / sigma;
    c.intensity_factor = std::sqrt(2.0 * pi);
    return true;
  });
}

/// A beam whose weight is exp(−A·θ²) at an angle θ off its ray, seen from the source: A is such
/// that it falls to 0.98 halfway to the next ray, and √(A/π)·dα makes the fan's weights sum to 1.
/// Its spreading is that of uniform water, 1/√s, s to the foot of the receiver's normal, as if that
/// always lay beyond the receiver's range. To that range s is (number of steps) × STEP: wrong
/// wherever a step was cut, and one step too long, as BELLHOP has it. Where intensities are summed
/// the weight is not squared. q is taken to fall to 0 at the source: a quarter of a turn more.
/// Arrivals are those of receivers within 50 wavelengths above or below the ray. Only forwards.
void add_simple_gaussian(const Beam& beam, const ReceiverBlock& block, BeamSink& sink) {
  constexpr double beam_factor = 0.98F;    // a literal of single precision
  constexpr double widest_arrival = 50.0;  // [wavelengths]
  const double a_exponent = -4.0 * std::log(beam_factor) / (beam.spacing * beam.spacing);
  const double norm = beam.launch_factor() * std::sqrt(a_exponent / pi) * beam.spacing;
  const double reach = beam.apart ? widest_arrival * beam.source_speed / beam.frequency : infinity;
  const auto& points = beam.ray.points;
  ColumnWalk columns(block, points.front().x.x());
  CausticPhase caustics(1.0);
  for (std::size_t i = 1; i < points.size(); ++i) {
    const LiteralPoint &a = points[i - 1], &b = points[i];
    caustics.pass(a.q1);
    if (b.x.x() <= a.x.x()) continue;
    const Vec2 chord = b.x - a.x;
    Contribution c;
    c.segment = i;
    c.end = &b;
    c.arrival_declination = std::atan2(b.t.y(), b.t.x());
    columns.over(a.x.x(), b.x.x(), [&](std::size_t column) {
      const double w = (block.grid.ranges[column] - a.x.x()) / chord.x();
      const double z = a.x.y() + w * chord.y(), t_z = a.t.y() + w * (b.t.y() - a.t.y());
      const double q = a.q1 + w * (b.q1 - a.q1);
      const double to_column = (static_cast<double>(i) + w) * beam.step;
      const double cosine = chord.x() / chord.norm(), sine = std::abs(chord.y()) / chord.norm();
      for (std::size_t row = block.row_begin; row < block.row_end; ++row) {
        const double dz = block.depth(row, column) - z;
        if (std::abs(dz) >= reach) continue;
        const double path = to_column + std::abs(dz) * sine;
        const double theta = std::atan(std::abs(dz) * cosine / path);
        c.row = row;
        c.column = column;
        c.amplitude = norm * b.amplitude / std::sqrt(path);
        c.weight = std::exp(-a_exponent * theta * theta);
        c.tau = a.tau + w * (b.tau - a.tau) + t_z * dz;  // the front is plane, across the ray
        c.phase = b.phase + caustics.at(q);
        sink.take(c);
      }
    });
  }
}

}  // namespace asdic::detail::bellhop_emulation
