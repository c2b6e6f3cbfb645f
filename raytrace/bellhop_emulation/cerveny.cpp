#include "raytrace/bellhop_emulation/cerveny.h"

#include <cmath>

#include "raytrace/bellhop_emulation/column_walk.h"
#include "raytrace/bellhop_emulation/depth_line.h"

namespace asdic::detail::bellhop_emulation {

using Complex = std::complex<double>;

Complex beam_epsilon(const Beam& beam, const CervenyBeams& kind) noexcept {
  const double omega = beam.omega(), c = beam.source_speed;
  Complex epsilon;
  if (kind.width == CervenyBeams::Width::wkb) {
    const double sine = std::sin(beam.ray.declination), cosine = std::cos(beam.ray.declination);
    const double c_z = beam.ray.points.front().gradient.y();
    epsilon = c_z == 0.0 ? 1e10 : -sine / (cosine * cosine) * c * c / c_z;
  } else {
    const double space_filling = 2.0 * c / (omega * beam.spacing);
    const double square = kind.width == CervenyBeams::Width::minimum
                              ? 2.0 * c * kind.loop_range / omega
                              : space_filling * space_filling;
    epsilon = Complex(0.0, 0.5 * omega * square);
  }
  return kind.width_multiplier * epsilon;
}

double taper(double distance, double wavelength) noexcept {
  const double x = (distance / wavelength - 50.0) / 50.0;
  if (x <= 0.0) return 1.0;
  if (x >= 1.0) return 0.0;
  return (1.0 + 2.0 * x) * (1.0 - x) * (1.0 - x);
}

Image image_of(const Beam& beam, double depth, int k) noexcept {
  if (k == 1) return {2.0 * beam.surface_depth - depth, -1.0};
  if (k == 2) return {2.0 * beam.bottom_depth - depth, 1.0};
  return {depth, 1.0};
}

namespace {

/// ∂²τ/∂z² beside the ray at constant range, out of the curvature M = p/q of the front and the
/// gradient of c along (s) and across (n) the ray:
///   c²·(M·t_r² − 2(c_n/c²)·t_r·t_z − (c_s/c²)·t_z²), t scaled.
Complex vertical_curvature(const LiteralPoint& y, Complex epsilon) noexcept {
  const Vec2 e = y.c * y.t, n(-e.y(), e.x());
  const double c_s = y.gradient.dot(e), c_n = y.gradient.dot(n);
  const Complex m = (y.p1 + epsilon * y.p2) / (y.q1 + epsilon * y.q2);
  return m * e.x() * e.x() - (2.0 * c_n * e.x() * e.y() + c_s * e.y() * e.y()) / (y.c * y.c);
}

}  // namespace

void add_cerveny_cartesian(const Beam& beam, const CervenyBeams& kind, const ReceiverBlock& block,
                           BeamSink& sink) {
  const auto& points = beam.ray.points;
  const double omega = beam.omega(), factor = beam.launch_factor();
  const Complex epsilon = beam_epsilon(beam, kind);
  const double window = static_cast<double>(kind.window) * kind.window;
  const auto q_of = [&](const LiteralPoint& y) { return y.q1 + epsilon * y.q2; };
  const double wavelength = beam.source_speed / beam.frequency;
  ColumnWalk columns(block, points.front().x.x());
  double branch = 1.0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    const LiteralPoint &a = points[i - 1], &b = points[i];
    const Complex qa = q_of(a), qb = q_of(b);
    if (i > 1) branch = next_branch(branch, q_of(points[i - 2]), qa);
    if (a.x.x() == b.x.x()) continue;
    const Complex ha = vertical_curvature(a, epsilon), hb = vertical_curvature(b, epsilon);
    columns.over(a.x.x(), b.x.x(), [&](std::size_t column) {
      // BELLHOP leaves out the first of several ranges, and the last (all but a few beams there).
      const std::size_t last = block.grid.ranges.size() - 1;
      if (last > 0 && (column == 0 || column == last)) return;
      const double w = (block.grid.ranges[column] - a.x.x()) / (b.x.x() - a.x.x());
      const double z = a.x.y() + w * (b.x.y() - a.x.y());
      const double t_z = a.t.y() + w * (b.t.y() - a.t.y());
      const double c = a.c + w * (b.c - a.c);
      const Complex q = qa + w * (qb - qa), tau = a.tau + w * (b.tau - a.tau);
      const Complex h = ha + w * (hb - ha);
      if (h.imag() > 0.0) return;  // it would grow away from the ray
      const Complex amplitude =
          factor * b.amplitude * next_branch(branch, qa, q) * std::sqrt(c * std::abs(epsilon) / q);
      for (std::size_t row = block.row_begin; row < block.row_end; ++row) {
        Complex sum = 0.0;
        for (int k = 0; k < kind.images; ++k) {
          const Image image = image_of(beam, block.depth(row, column), k);
          const double dz = image.depth - z;
          if (-0.5 * omega * h.imag() * dz * dz >= window) continue;
          const Complex phase = omega * (tau + t_z * dz + 0.5 * h * dz * dz) - a.phase;
          sum += image.sign * component(kind, b.t, k) * taper(std::abs(dz), wavelength) *
                 amplitude * std::exp(Complex(0.0, -1.0) * phase);
        }
        if (sum != 0.0) sink.take_pressure(row, column, sum, 1.0);
      }
    });
  }
}

using Complex = std::complex<double>;

void add_cerveny_ray_centred(const Beam& beam, const CervenyBeams& kind, const ReceiverBlock& block,
                             BeamSink& sink) {
  const double omega = beam.omega(), factor = beam.launch_factor();
  const double wavelength = beam.source_speed / beam.frequency;
  const Complex epsilon = beam_epsilon(beam, kind);
  const double window = static_cast<double>(kind.window) * kind.window;
  const auto q_of = [&](const LiteralPoint& y) { return y.q1 + epsilon * y.q2; };
  const auto curvature_of = [&](const LiteralPoint& y) {  // M = p/q of the front
    return (y.p1 + epsilon * y.p2) / q_of(y);
  };
  for_each_depth_line(block, [&](double depth, std::size_t row, const ReceiverBlock& line) {
    for (int k = 0; k < kind.images; ++k) {
      const Image image = image_of(beam, depth, k);
      // Seen from below the bottom the normals lean as those of the ray's own mirror image would,
      // which is BELLHOP's, and an error: its foot is on the wrong side of the ray.
      const double side = k == 2 ? -1.0 : 1.0;
      double branch = 1.0;
      follow_depth_line(beam.ray, image.depth, side, line, [&](const LineSegment& s) {
        const Complex qa = q_of(s.a), qb = q_of(s.b);
        const Complex ma = curvature_of(s.a), mb = curvature_of(s.b);
        s.over_columns([&](std::size_t column, double w) {
          const Complex q = qa + w * (qb - qa), m = ma + w * (mb - ma);
          const Complex tau = s.a.tau + w * (s.b.tau - s.a.tau);
          const double n = s.na + w * (s.nb - s.na), c = s.a.c;
          if (m.imag() > 0.0 || -0.5 * omega * m.imag() * n * n >= window) return;
          const Complex phase = omega * (tau + 0.5 * m * n * n) - s.a.phase;
          sink.take_pressure(row, column,
                             image.sign * component(kind, s.b.t, k) * factor * s.b.amplitude *
                                 next_branch(branch, qa, q) * std::sqrt(c * std::abs(epsilon) / q) *
                                 std::exp(Complex(0.0, -1.0) * phase),
                             taper(std::abs(n), wavelength));
        });
        branch = next_branch(branch, qa, qb);
      });
    }
  });
}

}  // namespace asdic::detail::bellhop_emulation
