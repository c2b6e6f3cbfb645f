#include <cmath>

#include "raytrace/bellhop_emulation/column_walk.h"

namespace asdic::detail::bellhop_emulation {

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
