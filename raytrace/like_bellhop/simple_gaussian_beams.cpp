#include <cmath>

#include "raytrace/like_bellhop/column_walk.h"

namespace asdic::like_bellhop {

/// A beam whose weight is exp(−A·θ²) at an angle θ off its ray, seen from the source: A is such
/// that it falls to 0.98 halfway to the next ray, and √(A/π)·dα makes the fan's weights sum to 1.
/// Its spreading is that of uniform water, 1/√s, and s is (number of steps) × STEP: wrong wherever
/// a step was cut, as BELLHOP has it. Only forwards.
void lay_simple_gaussian(const Beam& beam, const ReceiverBlock& block, BeamSink& sink) {
  constexpr double beam_factor = 0.98;
  const double a_exponent = -4.0 * std::log(beam_factor) / (beam.spacing * beam.spacing);
  const double norm = beam.launch_factor() * std::sqrt(a_exponent / pi) * beam.spacing;
  const auto& points = beam.ray.points;
  ColumnWalk columns(block, points.front().x.x());
  CausticPhase caustics;
  for (std::size_t i = 1; i < points.size(); ++i) {
    const LiteralPoint &a = points[i - 1], &b = points[i];
    caustics.pass(a.q1);
    if (b.x.x() <= a.x.x()) continue;
    const Vec2 chord = b.x - a.x;
    Contribution c;
    c.segment = i;
    c.end = &b;
    c.arrival_declination = std::atan2(chord.y(), chord.x());
    columns.over(a.x.x(), b.x.x(), [&](std::size_t column) {
      const double w = (block.grid.ranges[column] - a.x.x()) / chord.x();
      const double z = a.x.y() + w * chord.y(), t_z = a.t.y() + w * (b.t.y() - a.t.y());
      const double q = a.q1 + w * (b.q1 - a.q1);
      const double path = (static_cast<double>(i - 1) + w) * beam.step;
      if (!(path > 0.0)) return;
      const double cosine = std::abs(chord.x()) / chord.norm();
      for (std::size_t row = block.row_begin; row < block.row_end; ++row) {
        const double dz = block.depth(row, column) - z;
        const double theta = std::atan(std::abs(dz) * cosine / path);
        const double weight = norm * std::exp(-a_exponent * theta * theta);
        if (weight < 1e-10) continue;
        c.row = row;
        c.column = column;
        c.amplitude = b.amplitude / std::sqrt(path);
        c.weight = weight;
        c.tau = a.tau + w * (b.tau - a.tau) + t_z * dz;  // the front is plane, across the ray
        c.phase = caustics.at(q, b.phase);
        sink.take(c);
      }
    });
  }
}

}  // namespace asdic::like_bellhop
