#include "raytrace/ocean/sound_speed_section.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/error.h"
#include "raytrace/ocean/number_text.h"
#include "raytrace/ocean/samples.h"

namespace asdic::detail {
namespace {

void check_axis(std::span<const double> axis, const char* name, std::size_t least) {
  check_count(axis.size(), name, least);
  const std::string beyond = "a " + std::string(name) + " beyond";
  for (std::size_t i = 0; i < axis.size(); ++i) check_place(axis, i, name, beyond.c_str());
}

/// c and dc/dz of one profile at a depth, by the line of row j.
struct OnProfile {
  double c, c_z;

  OnProfile(std::span<const double> depth, const double* speed, std::size_t j, double z) {
    c_z = (speed[j + 1] - speed[j]) / (depth[j + 1] - depth[j]);
    // Measured from the nearer end, so that both rows of a grid line give the same speed there.
    c = z < 0.5 * (depth[j] + depth[j + 1]) ? speed[j] + c_z * (z - depth[j])
                                            : speed[j + 1] + c_z * (z - depth[j + 1]);
  }
};

}  // namespace

SoundSpeedSection::SoundSpeedSection(std::span<const double> range, std::span<const double> depth,
                                     std::span<const double> speed)
    : range_(range.begin(), range.end()),
      depth_(depth.begin(), depth.end()),
      speed_(speed.begin(), speed.end()) {
  check_axis(range, "range", 1);
  check_axis(depth, "depth", 2);
  if (speed.size() != range.size() * depth.size())
    throw InputError({.where = "speed",
                      .got = std::to_string(speed.size()) + " values",
                      .expected = std::to_string(range.size()) + " ranges times " +
                                  std::to_string(depth.size()) + " depths"});
  for (std::size_t i = 0; i < speed.size(); ++i)
    check_speed(speed[i],
                element("speed", i / depth.size()) + '[' + std::to_string(i % depth.size()) + ']');
}

SoundSpeedSection::Cell SoundSpeedSection::cell(double range, double depth) const noexcept {
  const auto column = std::upper_bound(range_.begin(), range_.end(), range) - range_.begin();
  // Inner depths divide the rows: as many of them as are not below `depth`.
  const auto first = depth_.begin() + 1, last = depth_.end() - 1;
  const auto row = std::upper_bound(first, last, depth) - first;
  return {.column = static_cast<std::size_t>(column), .row = static_cast<std::size_t>(row)};
}

SoundSpeed2D SoundSpeedSection::at(double range, double depth, Cell cell) const noexcept {
  const std::size_t n = depth_.size(), last = range_.size() - 1;
  const std::size_t left = cell.column == 0 ? 0 : cell.column - 1;
  const OnProfile a(depth_, &speed_[left * n], cell.row, depth);
  if (cell.column == 0 || cell.column > last) return {.c = a.c, .c_z = a.c_z};

  const OnProfile b(depth_, &speed_[cell.column * n], cell.row, depth);
  const double width = range_[cell.column] - range_[left];
  const double share = (range - range_[left]) / width;
  // c(r, z) = c_a(z) + (r − r_a)/Δr·(c_b(z) − c_a(z)): linear in either coordinate.
  return {.c = share < 0.5 ? a.c + share * (b.c - a.c) : b.c + (share - 1.0) * (b.c - a.c),
          .c_r = (b.c - a.c) / width,
          .c_z = a.c_z + share * (b.c_z - a.c_z),
          .c_rz = (b.c_z - a.c_z) / width};
}

}  // namespace asdic::detail
