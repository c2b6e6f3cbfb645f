#include "reverb/power/patch_rows.h"

#include <algorithm>
#include <cmath>

namespace asdic::detail {

PatchRows patch_rows(std::span<const ScatteringField> fields, const AudibleLimits& limits,
                     double source_level_db, std::size_t most) {
  PathPairs pairs;
  const auto add = [&](const ScatteringField& field, std::uint32_t ring, int sector, double share,
                       std::vector<PatchRow>& rows) {
    const double ring_of = field.ring_area(ring);
    const bool ring_alone = field.azimuthally_symmetric();
    const Vec2 centre = field.centre(ring, sector);
    field.sheet.pairs_at(centre, pairs, &limits, ring_of);
    for (const PathPair& pair : pairs.found)
      rows.push_back({.ground = field.thickness > 0.0 ? PatchRow::Ground::volume
                                : field.boundary == 1 ? PatchRow::Ground::bottom
                                                      : PatchRow::Ground::surface,
                      .bearing = ring_alone ? std::nan("") : field.bearing(sector),
                      .range = (ring + 0.5) * field.grid.spacing,
                      .place = ring_alone ? Vec2::Constant(std::nan("")) : centre,
                      .area = share * ring_of * pair.area,
                      .delay = pair.delay,
                      .grazing_in = pair.grazing_in,
                      .grazing_out = pair.grazing_out,
                      .launch_elevation = pair.out->launch_elevation,
                      .arrival_elevation = -pair.back->launch_elevation,
                      .scattering_strength_db = db_from_power(pair.cross_section),
                      .level_db = source_level_db + db_from_power(std::norm(pair.amplitude) *
                                                                  share * ring_of * pair.area)});
  };
  // Of a boundary whose sea is that of several anchors: the nearest one's rings tell all of it.
  const auto nearest_anchors = [&](const ScatteringField& field) {
    return &field == fields.data() || (&field - 1)->boundary != field.boundary;
  };
  // Every how many rings: from the number of pairs of one ring in 32.
  std::vector<PatchRow> counted;
  for (const ScatteringField& field : fields) {
    if (!nearest_anchors(field)) continue;
    const auto sectors = field.sample_sectors();
    for (std::uint32_t ring = 0; ring < field.grid.rings; ring += 32)
      for (const int sector : sectors) add(field, ring, sector, 1.0, counted);
  }
  PatchRows result;
  const std::size_t all = 32 * counted.size();
  result.every = static_cast<int>(std::max<std::size_t>(1, (all + most - 1) / most));
  for (const ScatteringField& field : fields) {
    if (!nearest_anchors(field)) continue;
    const auto sectors = field.sample_sectors();
    const double share = 1.0 / static_cast<double>(sectors.size());
    for (std::uint32_t ring = 0; ring < field.grid.rings;
         ring += static_cast<std::uint32_t>(result.every))
      for (const int sample : sectors)
        add(field, ring, field.sector_of_ring(sample, sectors.size(), ring), share, result.rows);
  }
  if (result.rows.size() > most) result.rows.resize(most);
  return result;
}

}  // namespace asdic::detail
