#pragma once
#include <vector>

#include "raytrace/tracing/cell.h"
#include "raytrace/tracing/course.h"
#include "raytrace/tracing/ray_tracer.h"

namespace asdic::detail {

namespace tracing {

/// A facet of a shaped boundary, ready to be met.
struct Facet {
  double begin = 0.0, end = 0.0;  ///< ranges [m], ∓infinity for the outer ones
  double extreme = 0.0;           ///< how far it reaches into the water at most: a depth [m]
  double slope = 0.0;             ///< of its line
  Line line;                      ///< through its ends, the normal pointing into the water
};

/// A shaped boundary, facet by facet; empty for a flat one.
struct Wall {
  std::vector<Facet> facets;
  bool straight = true;   ///< the facets are their lines
  double steepest = 0.0;  ///< no facet's slope is greater anywhere

  Wall(const Boundary& boundary, BoundaryKind kind);
};

}  // namespace tracing

/// The environment prepared for marching: rows, columns and losses looked up once.
struct RayTracer::Ocean {
  Ocean(const Environment& environment, double frequency, Reflection reflection);

  /// The cell of a row and a column. Valid as long as the ocean.
  [[nodiscard]] const tracing::Cell& cell(std::size_t row, std::size_t column) const noexcept {
    return cells[row * columns + column];
  }
  /// The row that holds a depth; on a line between two rows the lower one.
  [[nodiscard]] std::size_t row(double depth) const noexcept;
  [[nodiscard]] std::size_t column(double range) const noexcept;
  /// Where a column of the section begins and ends; ∓1e300 without a section.
  [[nodiscard]] double column_begin(std::size_t column) const noexcept;
  [[nodiscard]] double column_end(std::size_t column) const noexcept;

  Environment environment;
  double frequency;  ///< [Hz]
  Reflection reflection;
  std::vector<tracing::Row> rows;    ///< from top to bottom, without gaps
  std::vector<tracing::Cell> cells;  ///< [rows × columns]
  std::size_t columns = 1;
  tracing::Wall surface, bottom;

 private:
  [[nodiscard]] tracing::Cell make_cell(std::size_t row, std::size_t column) const noexcept;
};

}  // namespace asdic::detail
