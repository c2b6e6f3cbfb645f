#pragma once
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "raytrace/ocean/environment.h"

namespace asdic::detail::support {

/// Rays by fourth-order Runge–Kutta steps of a fixed, small length, for any ocean: simple, slow and
/// independent of raytrace/tracing. Boundaries, and lines where the gradient of the speed jumps,
/// are met by halving the step; a ray that touches a line and comes back within one step is not
/// seen to.
class PlainRays {
 public:
  PlainRays(const Environment& ocean, double step) : ocean_(ocean), step_(step) {}

  /// A crossing of a column, upward or downward in range.
  struct Crossing {
    std::size_t column = 0;
    double depth = 0.0, time = 0.0;
    int bounces = 0;
    std::uint64_t history = 0;  ///< of boundaries and facets met
  };

  /// \param columns  ranges [m] \return crossings in order
  std::vector<Crossing> trace(double source_depth, double elevation, double max_range,
                              int max_bounces, const std::vector<double>& columns) const {
    const double c0 = sound_speed(ocean_, 0.0, source_depth).c;
    State y = {0.0, source_depth, std::cos(elevation) / c0, -std::sin(elevation) / c0, 0.0};
    std::vector<Crossing> found;
    int bounces = 0;
    std::uint64_t history = 0;
    for (int i = 0; i < 1'000'000 && std::abs(y[0]) < max_range && bounces <= max_bounces; ++i) {
      double step = step_;
      State next = advance(y, step);
      if (!(cell(next) == cell(y))) {  // just beyond the line
        double low = 0.0;
        for (int k = 0; k < 60; ++k) {
          const double middle = 0.5 * (low + step);
          (cell(advance(y, middle)) == cell(y) ? low : step) = middle;
        }
        next = advance(y, step);
      }
      int side = outside(next);
      if (side != 0) {  // meet the boundary
        double low = 0.0, high = step;
        for (int k = 0; k < 60; ++k) {
          const double middle = 0.5 * (low + high);
          (outside(advance(y, middle)) != 0 ? high : low) = middle;
        }
        next = advance(y, low);
        side = outside(advance(y, high));
      }
      for (std::size_t k = 0; k < columns.size(); ++k) {
        const double before = y[0] - columns[k], after = next[0] - columns[k];
        if ((before < 0.0) == (after < 0.0)) continue;
        const State there = advance(y, at_range(y, columns[k]));
        found.push_back({k, there[1], there[4], bounces, history});
      }
      y = next;
      if (side != 0) {
        const Boundary& wall = side < 0 ? ocean_.surface : ocean_.bottom;
        double slope = 0.0;
        std::uint64_t facet = 0;
        if (wall.shape) {
          slope = wall.shape->at(y[0]).slope;
          if (wall.shape->interpolation() == ShapeInterpolation::piecewise_linear)
            facet = wall.shape->facet(y[0]);
        }
        const double turn = 2.0 * std::atan(slope);  // t → 2(t·u)u − t
        const double xi = y[2], zeta = y[3];
        y[2] = xi * std::cos(turn) + zeta * std::sin(turn);
        y[3] = xi * std::sin(turn) - zeta * std::cos(turn);
        ++bounces;
        history = history * 1000003U + 2 * facet + (side < 0 ? 1 : 2);
      }
    }
    return found;
  }

 private:
  using State = std::array<double, 5>;  // r, z, ξ, ζ, τ

  [[nodiscard]] int outside(const State& y) const {
    return y[1] < ocean_.surface.depth_at(y[0]) ? -1 : y[1] > ocean_.bottom.depth_at(y[0]) ? 1 : 0;
  }

  /// Where one law of the speed holds.
  struct Cell {
    SoundSpeedSection::Cell of_section;
    std::size_t interval = 0;
    bool operator==(const Cell& o) const {
      return interval == o.interval && of_section.row == o.of_section.row &&
             of_section.column == o.of_section.column;
    }
  };
  [[nodiscard]] Cell cell(const State& y) const {
    if (ocean_.section) return {ocean_.section->cell(y[0], y[1]), 0};
    return {{}, ocean_.water.munk_parameters() ? 0 : ocean_.water.interval(y[1])};
  }
  [[nodiscard]] SoundSpeed2D speed(const State& y, const Cell& in) const {
    if (ocean_.section) return ocean_.section->at(y[0], y[1], in.of_section);
    if (ocean_.water.munk_parameters()) return sound_speed(ocean_, y[0], y[1]);
    const SoundSpeed w = ocean_.water.at(y[1], in.interval);
    return {.c = w.c, .c_z = w.dc_dz};
  }

  [[nodiscard]] State derivative(const State& y, const Cell& in) const {
    const SoundSpeed2D w = speed(y, in);
    const double c2 = w.c * w.c;
    return {w.c * y[2], w.c * y[3], -w.c_r / c2, -w.c_z / c2, 1.0 / w.c};
  }

  /// By the law that holds where the step begins.
  [[nodiscard]] State advance(const State& y, double h) const {
    const Cell in = cell(y);
    const auto plus = [](const State& a, double f, const State& b) {
      State sum = a;
      for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += f * b[i];
      return sum;
    };
    const State k1 = derivative(y, in);
    const State k2 = derivative(plus(y, 0.5 * h, k1), in);
    const State k3 = derivative(plus(y, 0.5 * h, k2), in);
    const State k4 = derivative(plus(y, h, k3), in);
    State next = y;
    for (std::size_t i = 0; i < next.size(); ++i)
      next[i] += h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
    return next;
  }

  /// The step that ends at a range, by the secant rule.
  [[nodiscard]] double at_range(const State& y, double range) const {
    double h = (range - y[0]) / derivative(y, cell(y))[0];
    for (int i = 0; i < 4; ++i) {
      const State there = advance(y, h);
      h += (range - there[0]) / derivative(there, cell(y))[0];
    }
    return h;
  }

  const Environment& ocean_;
  double step_;
};

}  // namespace asdic::detail::support
