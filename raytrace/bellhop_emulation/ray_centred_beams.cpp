#include <algorithm>
#include <cmath>

#include "raytrace/bellhop_emulation/depth_line.h"

namespace asdic::detail::bellhop_emulation {
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

}  // namespace asdic::detail::bellhop_emulation
