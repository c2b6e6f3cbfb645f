#include <algorithm>

#include "raytrace/beams/column_sum.h"
#include "raytrace/math/lanes.h"

namespace asdic {

namespace {

/// Hats that reach more rows than these are added one by one.
constexpr std::int32_t most_rows = 12;

}  // namespace

/// Where each crossing's rows begin in the sum, and how many they are; none beyond the last
/// crossing.
void ColumnSum::find_places(const Crossings& x) {
  const std::size_t n = x.size();
  place_.resize(n + lanes), rows_.resize(n + lanes);
  const auto stride = static_cast<std::int32_t>(stride_);
  const std::uint32_t* column = x.column.data();
  const std::int32_t *first = first_.data(), *last = last_.data();
  const float* q = q_.data();
  std::int32_t *place = place_.data(), *rows = rows_.data();
  ASDIC_INDEPENDENT
  for (std::size_t i = 0; i < n; ++i) {
    place[i] = static_cast<std::int32_t>(column[i]) * stride + first[i];
    rows[i] = q[i] == 0.0F ? 0 : last[i] - first[i];
  }
  std::fill_n(rows + n, lanes, 0);
}

/// Puts side by side what add_hats needs of the crossings that reach a few evenly spaced rows:
/// where hats are narrower than rows are apart, half of them reach none. Adds those that reach
/// many. \return how many there are
template <bool coherent>
std::size_t ColumnSum::pack_hats(const Crossings& x) {
  const auto spacing = static_cast<float>(setting_.spacing);
  find_places(x);
  std::size_t n = 0;
  for (std::size_t i = 0; i < x.size(); i += lanes) {
    const WholeLanes rows = load(&rows_[i]);
    const Lanes cosine = load(&cosine_[i]);
    const Lanes alone = to_lanes(rows) - static_cast<float>(most_rows);  // > 0, or widening:
    const Lanes widening = 2.0F * spacing * abs(load(&growth_[i])) - cosine;
    if (any_of(max(alone, widening) > 0.0F)) {
      for (std::size_t l = 0; l < std::min(lanes, x.size() - i); ++l)
        if (rows_[i + l] > most_rows || widening[l] > 0.0F) {
          add_crossing_rows<coherent, true>(x, i + l);
          rows_[i + l] = 0;
        }
    }
    const Packing packing(load(&rows_[i]) > 0);
    for (auto* array : {&amplitude_, &cosine_, &q_, &growth_, &offset_})
      packing.pack(&(*array)[i], &(*array)[n]);
    if constexpr (coherent)
      for (auto* array : {&phase_, &wave_number_}) packing.pack(&(*array)[i], &(*array)[n]);
    for (auto* array : {&place_, &rows_}) packing.pack(&(*array)[i], &(*array)[n]);
    n += packing.count();
  }
  std::fill_n(rows_.begin() + static_cast<std::ptrdiff_t>(n), lanes, 0);
  return n;
}

/// As many crossings at a time as there are lanes, row by row downwards, where the phase turns
/// evenly. A square of rows, real and imaginary parts in turn, is transposed, to add those of each
/// crossing to its column together.
template <bool coherent>
void ColumnSum::add_hats(const Crossings& x) {
  constexpr std::size_t group = coherent ? lanes / 2 : lanes;  // rows of a square
  const std::size_t n = pack_hats<coherent>(x);
  const auto spacing = static_cast<float>(setting_.spacing), per_spacing = 1.0F / spacing;
  const auto row_spacing = static_cast<float>(spacing_);
  float* sum = sum_.data();
  alignas(64) float square[lanes * lanes];
  for (std::size_t i = 0; i < n; i += lanes) {
    const std::size_t used = std::min(lanes, n - i);
    for (std::size_t l = 0; l < used; ++l)
      __builtin_prefetch(sum + static_cast<std::size_t>(place_[i + l]) * (coherent ? 2 : 1), 1);
    const Lanes q0 = load(&q_[i]), growth = load(&growth_[i]), amplitude = load(&amplitude_[i]);
    const Lanes per_width = load(&cosine_[i]) * per_spacing, count = to_lanes(load(&rows_[i]));
    Lanes dz = load(&offset_[i]), c, s, turn_c, turn_s;
    if constexpr (coherent) {
      const Lanes wave_number = load(&wave_number_[i]);
      cos_sin(load(&phase_[i]) + wave_number * dz, c, s);
      cos_sin(wave_number * row_spacing, turn_c, turn_s);
    }
    const auto rows = static_cast<std::size_t>(hmax(count));
    for (std::size_t row = 0; row < rows; row += group) {
      for (std::size_t m = 0; m < group; ++m) {
        const Lanes per_q = 1.0F / max(abs(q0 + growth * dz), Lanes(1e-30F));
        // zero beyond its rows, but for half a hat, which ends at its ray
        const Lanes share = max(Lanes(0.0F), 1.0F - abs(dz) * per_width * per_q);
        Lanes weight = amplitude * share * (coherent ? sqrt(per_q) : per_q);
        if (half_ != Half::both)
          where(count <= static_cast<float>(static_cast<int>(row + m)), weight) = 0.0F;
        if constexpr (coherent) {
          store(weight * c, square + 2 * m * lanes);
          store(weight * s, square + (2 * m + 1) * lanes);
          const Lanes c_next = c * turn_c - s * turn_s;
          s = s * turn_c + c * turn_s;
          c = c_next;
        } else {
          store(weight, square + m * lanes);
        }
        dz += row_spacing;
      }
      transpose(square);
      for (std::size_t l = 0; l < used; ++l) {
        // a column's padding has room for one group that begins at its last row
        if (row > 0 && row >= static_cast<std::size_t>(rows_[i + l])) continue;
        const std::size_t at = static_cast<std::size_t>(place_[i + l]) + row;
        float* to = sum + at * (coherent ? 2 : 1);
        store(load(to) + load(square + l * lanes), to);
      }
    }
  }
}

template void ColumnSum::add_hats<true>(const Crossings&);
template void ColumnSum::add_hats<false>(const Crossings&);

}  // namespace asdic
