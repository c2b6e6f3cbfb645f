#include <cmath>

#include "raytrace/bellhop_emulation/cerveny.h"
#include "raytrace/bellhop_emulation/depth_line.h"

namespace asdic::detail::bellhop_emulation {

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
