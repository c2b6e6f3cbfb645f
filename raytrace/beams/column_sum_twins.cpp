#include <algorithm>
#include <cmath>

#include "raytrace/beams/column_sum.h"
#include "raytrace/beams/geometric.h"

// Receivers on the boundaries, which every beam serves once more by its twin (boundary_rows.h).
namespace asdic {

/// Of the beam, or the half of one, that was added last: where it reaches a boundary's row.
void ColumnSum::add_twins(const Crossings& x, const BoundaryRows& walls) {
  const bool is_hat = setting_.kind == BeamKind::hat;
  const float steep = (is_hat ? 2.0F : 8.0F) * static_cast<float>(setting_.spacing);
  for (const BoundaryKind kind : {BoundaryKind::surface, BoundaryKind::bottom}) {
    if (!walls.heard(kind)) continue;
    const std::int32_t same = walls.row_of_all(kind);
    for (std::size_t i = 0; i < x.size(); i += lanes) {
      if (same >= 0) {  // mostly no beam of several
        const auto reached = load(&first_[i]) <= same && load(&last_[i]) > same;
        if (none_of(reached) && none_of(load(&cosine_[i]) < steep * abs(load(&growth_[i]))))
          continue;
      }
      const std::size_t end = std::min(i + lanes, x.size());
      for (std::size_t k = i; k < end; ++k) {
        const std::int32_t row = walls.row(kind, x.column[k]);
        if (row < 0 || walls.silent(kind, x.column[k])) continue;
        if ((row >= first_[k] && row < last_[k]) || way(k) == Way::plain)
          add_twin(x, k, kind, static_cast<std::size_t>(row), walls);
      }
    }
  }
}

void ColumnSum::add_twin(const Crossings& x, std::size_t i, BoundaryKind kind, std::size_t row,
                         const BoundaryRows& walls) {
  Crossing there = crossing_at(x, i);
  there.loss *= walls.twin(kind, x.column[i], there);
  const std::size_t at = x.column[i] * stride_ + row;
  beams::add_crossing(setting_, launch_, launched_, x.source_speed, there, depths_.subspan(row, 1),
                      [&](std::size_t, std::complex<double> p) { add_number(at, p); });
}

void ColumnSum::silence(const BoundaryRows& walls) {
  const std::size_t columns = real_.size() / stride_;
  for (const BoundaryKind kind : {BoundaryKind::surface, BoundaryKind::bottom})
    for (std::size_t j = 0; j < columns; ++j)
      if (const std::int32_t row = walls.row(kind, j); row >= 0 && walls.silent(kind, j)) {
        const std::size_t at = j * stride_ + static_cast<std::size_t>(row);
        if (paired_)
          sum_[2 * at] = sum_[2 * at + 1] = 0.0F;
        else if (setting_.coherent)
          real_[at] = imaginary_[at] = 0.0F;
        else
          real_[at] = 0.0F;
      }
}

}  // namespace asdic
