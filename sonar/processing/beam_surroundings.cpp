#include "sonar/processing/beam_surroundings.h"

#include <algorithm>
#include <cmath>

namespace asdic {
namespace {

constexpr double nearest = 2.0, furthest = 6.0;  // resolution cells
constexpr std::size_t fewest = 8;

}  // namespace

BeamSurroundings::BeamSurroundings(const ArrayShape& shape, std::span<const Vec3> looks,
                                   double wavelength) {
  first_.push_back(0);
  const bool told = shape.kind != ArrayKind::point;
  for (const Vec3& look : looks) {
    const std::size_t before = around_.size();
    for (std::size_t other = 0; told && other < looks.size(); ++other) {
      const Vec3 way = looks[other] - look;
      if (way.squaredNorm() > 1.0) continue;  // within 60°: not through the array on its other side
      // Directions differ for an array by what it is long along its axes.
      double apart = std::pow(way.dot(shape.axis) * shape.length, 2.0);
      if (shape.kind != ArrayKind::line)
        apart += std::pow(way.dot(shape.across) * shape.width, 2.0);
      if (shape.kind == ArrayKind::volume) apart += std::pow(way.z() * shape.height, 2.0);
      const double cells = std::sqrt(apart) / wavelength;
      if (cells >= nearest && cells <= furthest)
        around_.push_back(static_cast<std::uint32_t>(other));
    }
    if (around_.size() - before < fewest) around_.resize(before);
    first_.push_back(around_.size());
  }
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

float CellPowers::near(std::size_t filter, std::size_t beam, std::size_t sample) const noexcept {
  const float* const row = mean_.data() + (filter * beams_ + beam) * cells_;
  const std::size_t cell =
      std::min(cells_ - 1, static_cast<std::size_t>(static_cast<double>(sample) / cell_));
  const std::size_t begin = cell > 0 ? cell - 1 : 0, end = std::min(cells_, cell + 2);
  float sum = 0.0F;
  for (std::size_t i = begin; i < end; ++i) sum += row[i];
  return sum / static_cast<float>(end - begin);
}

float CellPowers::background(const BeamSurroundings& around, std::size_t filter, std::size_t beam,
                             std::size_t sample, std::vector<float>& scratch) const {
  const auto beams = around.of(beam);
  if (beams.empty()) return 0.0F;
  scratch.clear();
  for (const std::uint32_t other : beams) scratch.push_back(near(filter, other, sample));
  const auto middle = scratch.begin() + std::ssize(scratch) / 2;
  std::nth_element(scratch.begin(), middle, scratch.end());
  return *middle;
}

}  // namespace asdic
