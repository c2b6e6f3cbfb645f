#include "processing/beam_surroundings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

namespace asdic::detail {
namespace {

struct Cells {
  double nearest, furthest;  // resolution cells
  std::size_t fewest;        // beams
};
constexpr Cells beside_cells{.nearest = 2.0, .furthest = 6.0, .fewest = 8};
constexpr Cells side_cells{.nearest = 1.5, .furthest = 4.0, .fewest = 4};
/// Of time, before and after; with the ones beside from 1 to 5: an echo fills the first.
constexpr std::size_t off = 3;

/// \param values  any order, and in another one afterwards   \return 0 of none
template <typename Number>
Number median_of(std::vector<Number>& values) {
  if (values.empty()) return Number{};
  const auto middle = values.begin() + std::ssize(values) / 2;
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

BeamSurroundings::BeamSurroundings(const ArrayShape& shape, std::span<const Vec3> looks,
                                   double wavelength) {
  const bool told = shape.kind != ArrayKind::point;
  for (const Vec3& look : looks) {
    for (std::size_t other = 0; told && other < looks.size(); ++other) {
      const Vec3 way = looks[other] - look;
      if (way.squaredNorm() > 1.0) continue;  // within 60°: not through the array on its other side
      // Directions differ for an array by what it is long along its axes.
      double apart = std::pow(way.dot(shape.axis) * shape.length, 2.0);
      if (shape.kind != ArrayKind::line)
        apart += std::pow(way.dot(shape.across) * shape.width, 2.0);
      if (shape.kind == ArrayKind::volume) apart += std::pow(way.z() * shape.height, 2.0);
      const double cells = std::sqrt(apart) / wavelength;
      const auto among = [&](const Cells& meant) {
        return cells > meant.nearest - 1e-9 && cells < meant.furthest + 1e-9;
      };
      const auto number = static_cast<std::uint32_t>(other);
      if (among(beside_cells)) beside_.beams.push_back(number);
      if (among(side_cells)) sides_[way.dot(shape.axis) > 0.0 ? 1 : 0].beams.push_back(number);
    }
    beside_.end_beam(beside_cells.fewest);
    for (Lists& side : sides_) side.end_beam(side_cells.fewest);
  }
}

/// Too few say nothing. Of the thousands that an array in a curve has over bearing and elevation
/// some, evenly, tell the median as well: to a tenth.
void BeamSurroundings::Lists::end_beam(std::size_t fewest) {
  constexpr std::size_t most = 64;
  const std::size_t begin = first.back(), found = beams.size() - begin;
  if (found < fewest) beams.resize(begin);
  if (found > most) {
    for (std::size_t i = 0; i < most; ++i) beams[begin + i] = beams[begin + i * found / most];
    beams.resize(begin + most);
  }
  first.push_back(beams.size());
}

OwnLeak::OwnLeak(const BeamSurroundings& around, std::size_t beam,
                 const std::function<double(std::size_t)>& pattern) {
  std::vector<double> powers;
  const auto median = [&](std::span<const std::uint32_t> beams) {
    powers.clear();
    for (const std::uint32_t other : beams) powers.push_back(pattern(other));
    return median_of(powers);
  };
  beside = median(around.beside(beam));
  for (const std::size_t s : {0, 1}) side[s] = median(around.on_side(s, beam));
}

CellPowers::CellPowers(std::size_t filters, std::size_t beams, std::size_t samples, double cell)
    : beams_(beams),
      samples_(samples),
      cells_(std::max<std::size_t>(
          1, static_cast<std::size_t>(static_cast<double>(samples) / std::max(1.0, cell)))),
      cell_(static_cast<double>(samples) / static_cast<double>(cells_)),
      mean_(filters * beams * cells_, 0.0F) {}

void CellPowers::set(std::size_t filter, std::size_t beam, std::span<const float> power) noexcept {
  float* const row = mean_.data() + (filter * beams_ + beam) * cells_;
  for (std::size_t cell = 0; cell < cells_; ++cell) {
    const auto begin = static_cast<std::size_t>(static_cast<double>(cell) * cell_),
               end = std::min(samples_, static_cast<std::size_t>(
                                            std::ceil(static_cast<double>(cell + 1) * cell_)));
    float sum = 0.0F;
    for (std::size_t i = begin; i < end; ++i) sum += power[i];
    row[cell] = end > begin ? sum / static_cast<float>(end - begin) : 0.0F;
  }
}

float CellPowers::mean(std::size_t filter, std::size_t beam, std::size_t cell) const noexcept {
  const float* const row = mean_.data() + (filter * beams_ + beam) * cells_;
  const std::size_t begin = cell > 0 ? cell - 1 : 0, end = std::min(cells_, cell + 2);
  float sum = 0.0F;
  for (std::size_t i = begin; i < end; ++i) sum += row[i];
  return sum / static_cast<float>(end - begin);
}

float CellPowers::background(const BeamSurroundings& surroundings, std::size_t filter,
                             std::size_t beam, std::size_t sample, double power,
                             const OwnLeak& leak, std::vector<float>& scratch) const {
  const auto median = [&](std::span<const std::uint32_t> beams, std::size_t cell) {
    scratch.clear();
    for (const std::uint32_t other : beams) scratch.push_back(mean(filter, other, cell));
    return median_of(scratch);
  };
  const std::size_t cell =
      std::min(cells_ - 1, static_cast<std::size_t>(static_cast<double>(sample) / cell_));
  std::array<float, 6> received{};
  auto* next = received.begin();
  for (const std::size_t side : {0, 1}) {
    const auto beams = surroundings.on_side(side, beam);
    *next++ = median(beams, cell) - static_cast<float>(leak.side[side] * power);
    *next++ = cell >= off ? median(beams, cell - off) : 0.0F;
    *next++ = cell + off < cells_ ? median(beams, cell + off) : 0.0F;
  }
  std::nth_element(received.begin(), received.begin() + 1, received.end(), std::greater<>());
  const float beside =
      median(surroundings.beside(beam), cell) - static_cast<float>(leak.beside * power);
  return std::max({beside, received[1], 0.0F});
}

}  // namespace asdic::detail
