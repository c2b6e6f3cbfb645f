#include "reverb/fields/scattering_field.h"

#include <algorithm>
#include <cmath>

namespace asdic::detail {

double ScatteringField::ring_area(std::uint32_t ring) const noexcept {
  return 2.0 * pi * (ring + 0.5) * grid.spacing * grid.spacing;
}

double ScatteringField::bearing(int sector) const noexcept {
  return grid.first_bearing + 2.0 * pi * (sector + 0.5) / grid.azimuths;
}

Vec2 ScatteringField::centre(std::uint32_t ring, int sector) const noexcept {
  const double towards = bearing(sector);
  return grid.anchor + (ring + 0.5) * grid.spacing * Vec2(std::sin(towards), std::cos(towards));
}

bool ScatteringField::azimuthally_symmetric() const noexcept {
  const Vec2 source = sheet.ends().source.position.head<2>();
  return sheet.azimuthally_symmetric() && (source - grid.anchor).norm() < 0.5 * grid.spacing;
}

std::uint32_t ScatteringField::copies_of(std::uint32_t ring, int sector) const {
  auto copies = static_cast<std::uint32_t>(grid.per_cell);
  const double range = (ring + 0.5) * grid.spacing;
  if (range >= divided_below) return copies;
  const double nearest = sheet.nearest_end(centre(ring, sector), depth);
  for (double width = range; width > 2.0 * nearest && copies < 4096; width *= 0.5) copies *= 2;
  return copies;
}

int ScatteringField::sector_of_ring(int sample, std::size_t count,
                                    std::uint32_t ring) const noexcept {
  if (!sheet.unlike_all_round()) return sample;
  // By the golden ratio, so that any few rings tell of bearings that are spread evenly.
  const double turn = 0.6180339887498949 * ring;
  const int stride = std::max(1, grid.azimuths / static_cast<int>(count));
  return (sample + static_cast<int>((turn - std::floor(turn)) * stride)) % grid.azimuths;
}

std::vector<int> ScatteringField::sample_sectors() const {
  // All round one sector is enough, unless each tells of one choice out of many paths.
  if (azimuthally_symmetric() && sheet.bundled())
    return {0, grid.azimuths / 4, grid.azimuths / 2, 3 * grid.azimuths / 4};
  if (azimuthally_symmetric()) return {0};
  const auto rings = static_cast<int>(std::max(1U, grid.rings));
  const int n = std::min(std::clamp(400'000 / rings, 12, 36), grid.azimuths);
  std::vector<int> sectors;
  sectors.reserve(static_cast<std::size_t>(n));
  for (int i = 0; i < n; ++i) sectors.push_back(i * grid.azimuths / n);
  return sectors;
}

}  // namespace asdic::detail
