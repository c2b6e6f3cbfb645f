#include "sonar/reverberation.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <tuple>

namespace asdic {
namespace {

constexpr std::size_t block = 64;  // rings that one task works through

double ring_area(const ScattererGrid& grid, std::uint32_t ring) noexcept {
  return 2.0 * pi * (ring + 0.5) * grid.spacing * grid.spacing;
}

double sector_bearing(const ScattererGrid& grid, int sector) noexcept {
  return grid.first_bearing + 2.0 * pi * (sector + 0.5) / grid.azimuths;
}

/// The middle of a cell.
Vec2 centre(const ScattererGrid& grid, std::uint32_t ring, int sector) noexcept {
  const double bearing = sector_bearing(grid, sector);
  return grid.anchor + (ring + 0.5) * grid.spacing * Vec2(std::sin(bearing), std::cos(bearing));
}

/// Runs f(ring, scratch, out) over every `step`-th ring in parallel. \return what they put out, in
/// their order
template <class Item, class F>
std::vector<Item> over_rings(std::uint32_t rings, std::uint32_t step, F&& f) {
  const std::size_t visited = (rings + step - 1) / step, blocks = (visited + block - 1) / block;
  std::vector<std::vector<Item>> parts(blocks);
  tbb::parallel_for(std::size_t{0}, blocks, [&](std::size_t b) {
    PathPairs scratch;
    for (std::size_t i = b * block; i < std::min(visited, (b + 1) * block); ++i)
      f(static_cast<std::uint32_t>(i * step), scratch, parts[b]);
  });
  std::size_t total = 0;
  for (const auto& part : parts) total += part.size();
  std::vector<Item> all;
  all.reserve(total);
  for (auto& part : parts) {
    all.insert(all.end(), part.begin(), part.end());
    part = {};
  }
  return all;
}

/// Three normals that belong to a scatterer, held at four standard deviations.
Vec3 own_velocity(double rms, std::uint64_t entity, std::uint64_t seed) {
  if (rms <= 0.0) return Vec3::Zero();
  RandomStream draw(seed, Draw::scatterer_velocity, 0, entity);
  Vec3 velocity;
  for (int i = 0; i < 3; ++i) velocity[i] = rms * std::clamp(draw.normal(), -4.0, 4.0);
  return velocity;
}

}  // namespace

PingReverberation::PingReverberation(const Scenario& scenario, const ReverberationContext& context,
                                     std::vector<ScatteringField> fields)
    : scenario_(scenario), context_(context), fields_(std::move(fields)) {
  find_limits();
  by_sectors_ = expected_returns_ > static_cast<double>(scenario_.reverberation.most_returns);
  blocks_ = by_sectors_ ? sector_blocks() : rings_;
}

/// Not so where a platform has left the anchor behind: then rings around it are not hers.
bool PingReverberation::all_round(const ScatteringField& field) const noexcept {
  const Vec2 source = field.sheet.ends().source.position.head<2>();
  return field.sheet.all_round() && (source - field.grid.anchor).norm() < 0.5 * field.grid.spacing;
}

std::vector<int> PingReverberation::sample_sectors(const ScatteringField& field) const {
  if (all_round(field)) return {0};
  const auto rings = static_cast<int>(std::max(1U, field.grid.rings));
  const int n = std::min(std::clamp(400'000 / rings, 12, 36), field.grid.azimuths);
  std::vector<int> sectors;
  for (int i = 0; i < n; ++i) sectors.push_back(i * field.grid.azimuths / n);
  return sectors;
}

/// Rings so near each other are sampled only once that eight still lie within a stretch.
std::uint32_t PingReverberation::sample_step(const ScatteringField& field) const {
  constexpr double slow_sea = 1400.0, samples = 8.0;
  const double delay = 2.0 * field.grid.spacing / slow_sea;  // from ring to ring, at most
  return static_cast<std::uint32_t>(std::clamp(limits_.stretch / (samples * delay), 1.0, 1e6));
}

void PingReverberation::find_limits() {
  constexpr double left_out = 1e-5;  // of the power in a stretch
  constexpr double faintest = 1e-8;  // of the loudest pair of a place
  limits_.stretch = 0.25 * context_.pulse.duration();
  struct Found {
    Sample sample;
    double ring_power, share;  // of a whole ring like this place; how much of it that stands for
    double scatterers;         // of that ring
  };
  std::vector<Found> all;
  std::uint32_t first_place = 0;
  for (const ScatteringField& field : fields_) {
    const std::vector<int> sectors = sample_sectors(field);
    const auto count = static_cast<std::uint32_t>(sectors.size());
    const std::uint32_t step = sample_step(field);
    const auto found = over_rings<Found>(
        field.grid.rings, step, [&](std::uint32_t ring, PathPairs& pairs, std::vector<Found>& out) {
          const std::uint32_t stands_for = std::min(step, field.grid.rings - ring);
          for (std::uint32_t i = 0; i < count; ++i) {
            field.sheet.pairs_at(centre(field.grid, ring, sectors[i]), pairs);
            const double share = double(stands_for) / count, area = ring_area(field.grid, ring);
            double loudest = 0.0;
            for (const PathPair& pair : pairs.found) loudest = std::max(loudest, pair.power);
            for (const PathPair& pair : pairs.found) {
              if (pair.power < faintest * loudest) continue;
              out.push_back({{.place = first_place + ring * count + i,
                              .delay = pair.delay,
                              .amplitude = pair.amplitude * std::sqrt(pair.area * area * share)},
                             pair.power * area,
                             share,
                             double(field.grid.azimuths) * copies_of(field, ring, sectors[i])});
            }
          }
        });
    first_place += field.grid.rings * count;
    all.insert(all.end(), found.begin(), found.end());
  }
  struct Entry {
    std::uint32_t stretch;
    double power, share;
  };
  std::vector<Entry> entries;
  entries.reserve(all.size());
  for (const Found& f : all)
    entries.push_back(
        {static_cast<std::uint32_t>(f.sample.delay / limits_.stretch), f.ring_power, f.share});
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
    return std::tie(a.stretch, a.power, a.share) < std::tie(b.stretch, b.power, b.share);
  });
  for (std::size_t begin = 0, end = 0; begin < entries.size(); begin = end) {
    double total = 0.0;
    for (end = begin; end < entries.size() && entries[end].stretch == entries[begin].stretch; ++end)
      total += entries[end].power * entries[end].share;
    std::size_t first = begin;
    for (double dropped = 0.0; first < end; ++first) {
      dropped += entries[first].power * entries[first].share;
      if (dropped > left_out * total) break;
    }
    limits_.least.resize(entries[begin].stretch + 1, 0.0);
    // The loudest of those left out. Not the faintest of those kept: a scatterer of the next ring
    // that lies a little nearer than its middle would be left out of this stretch for it.
    limits_.least.back() = first > begin ? entries[first - 1].power : 0.0;
  }
  std::vector<double> of_ring;  // returns of the field in hand
  std::size_t next = 0;
  first_place = 0;
  for (std::size_t field = 0; field < fields_.size(); ++field) {
    const std::uint32_t rings = fields_[field].grid.rings;
    const auto count = static_cast<std::uint32_t>(sample_sectors(fields_[field]).size());
    of_ring.assign(rings, 0.0);
    for (; next < all.size() && all[next].sample.place < first_place + rings * count; ++next) {
      const Found& f = all[next];
      if (f.ring_power <= limits_.at(f.sample.delay)) continue;
      samples_.push_back(f.sample);
      of_ring[(f.sample.place - first_place) / count] += f.share * f.scatterers;
    }
    // What was found at one ring belongs to those that it stands for.
    const std::uint32_t step = sample_step(fields_[field]);
    for (std::uint32_t ring = 0; ring < rings; ++ring)
      if (ring % step == 0)
        of_ring[ring] /= std::min(step, rings - ring);
      else
        of_ring[ring] = of_ring[ring - ring % step];
    first_place += rings * count;
    cut_into_blocks(field, of_ring);
  }
}

void PingReverberation::cut_into_blocks(std::size_t field, const std::vector<double>& of_ring) {
  constexpr double most = 4096.0;  // returns
  double held = 0.0;
  for (std::uint32_t ring = 0; ring < of_ring.size(); ++ring) {
    if (ring == 0 || held + of_ring[ring] > most) {
      rings_.push_back({.field = field, .begin = ring});
      held = 0.0;
    }
    held += of_ring[ring];
    rings_.back().end = ring + 1;
    rings_.back().expected = static_cast<std::size_t>(std::ceil(held));
    expected_returns_ += of_ring[ring];
  }
}

std::uint32_t PingReverberation::copies_of(const ScatteringField& field, std::uint32_t ring,
                                           int sector) const {
  // A cell is seen from source and receiver under no more than twice the angle of a sector: near
  // them, far from the anchor, it is divided.
  auto copies = static_cast<std::uint32_t>(field.grid.per_cell);
  const double range = (ring + 0.5) * field.grid.spacing;
  if (range >= field.divided_below) return copies;
  const double nearest = field.sheet.nearest_end(centre(field.grid, ring, sector), field.depth);
  for (double width = range; width > 2.0 * nearest && copies < 4096; width *= 0.5) copies *= 2;
  return copies;
}

PingReverberation::Met PingReverberation::meet(const ScatteringField& field,
                                               const ScattererKey& key, std::uint64_t entity,
                                               PathPairs& pairs) const {
  const ScattererMotion& motion = field.field.motion;
  const Scatterer scatterer = place_scatterer(field.grid, key, entity, scenario_.seed);
  field.sheet.pairs_at(scatterer.place, pairs, &limits_, ring_area(field.grid, key.ring),
                       (scatterer.depth_share - 0.5) * field.thickness);
  Met met;
  if (pairs.found.empty()) return met;
  const Vec2 in_water = scatterer.place - motion.current * context_.time;
  met.strength =
      std::sqrt(scatterer.area * pairs.found.front().area) *
      texture_amplitude(field.field.statistics, in_water, field.boundary, scenario_.seed);
  met.velocity = {motion.current.x(), motion.current.y(), 0.0};
  if (motion.kind == ScattererMotion::Kind::bragg)
    met.bragg = scatterer.fate < motion.receding_share ? -1.0 : 1.0;
  else if (motion.kind == ScattererMotion::Kind::spread)
    met.velocity += own_velocity(motion.speed_rms, entity, scenario_.seed);
  return met;
}

void PingReverberation::hear(const ScatteringField& field, const PathPairs& pairs,
                             const PathPair& pair, const Met& met, std::complex<double> weight,
                             ReturnBlock& into) const {
  const std::complex<double> strength = met.strength * weight;
  into.returns.push_back({.delay = pair.delay,
                          .amplitude = pair.amplitude * strength,
                          .doppler = field.sheet.doppler(pair, met.velocity, met.bragg),
                          .slowness = field.sheet.arriving(pair)});
  const std::size_t points = context_.band.size();
  const auto first = static_cast<std::size_t>(&pair - pairs.found.data()) * points;
  for (std::size_t k = 0; k < points; ++k)
    into.colours.emplace_back(pairs.colours[first + k] * strength);
}

void PingReverberation::add_rings(const ScatteringField& field, std::uint32_t begin,
                                  std::uint32_t end, ReturnBlock& into) const {
  const ScattererWeights weights(field.field.statistics, field.weights, scenario_.seed,
                                 context_.time, context_.ping);
  PathPairs pairs;
  for (std::uint32_t ring = begin; ring < end; ++ring)
    for (int sector = 0; sector < field.grid.azimuths; ++sector)
      for_each_scatterer(field, ring, sector, pairs,
                         [&](const ScattererKey& /*key*/, std::uint64_t entity, const Met& met) {
                           const std::complex<double> weight = weights(entity);
                           for (const PathPair& pair : pairs.found)
                             hear(field, pairs, pair, met, weight, into);
                         });
}

void PingReverberation::make(std::size_t block, ReturnBlock& into) const {
  const Block& b = blocks_[block];
  const ScatteringField& field = fields_[b.field];
  if (!by_sectors_) return add_rings(field, b.begin, b.end, into);
  for (std::uint32_t sector = b.begin; sector < b.end; ++sector)
    add_sector(field, static_cast<int>(sector), into);
}

std::vector<DopplerSpan> PingReverberation::dopplers() const {
  std::vector<DopplerSpan> spans;
  for (const ScatteringField& field : fields_)
    for (const DopplerSpan& span : field.sheet.dopplers(field.field.motion)) spans.push_back(span);
  return spans;
}

Returns PingReverberation::collect(const std::vector<Block>& blocks, bool sectors) const {
  std::vector<ReturnBlock> parts(blocks.size());
  tbb::parallel_for(std::size_t{0}, blocks.size(), [&](std::size_t i) {
    const Block& b = blocks[i];
    if (!sectors) return add_rings(fields_[b.field], b.begin, b.end, parts[i]);
    for (std::uint32_t sector = b.begin; sector < b.end; ++sector)
      add_sector(fields_[b.field], static_cast<int>(sector), parts[i]);
  });
  Returns all;
  for (const ReturnBlock& part : parts)
    all.insert(all.end(), part.returns.begin(), part.returns.end());
  return all;
}

Returns PingReverberation::plain_returns() const { return collect(rings_, false); }
Returns PingReverberation::sector_returns() const { return collect(sector_blocks(), true); }
Returns PingReverberation::returns() const { return collect(blocks_, by_sectors_); }

double PingReverberation::expected_db(double t) const {
  const Pulse& pulse = context_.pulse;
  double power = 0.0;
  std::complex<double> sum = 0.0;
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    const double since = t - samples_[i].delay;
    if (since >= 0.0 && since <= pulse.duration())
      sum += samples_[i].amplitude * pulse.analytic(since);
    if (i + 1 == samples_.size() || samples_[i + 1].place != samples_[i].place) {
      power += std::norm(sum);
      sum = 0.0;
    }
  }
  return scenario_.transmitters[static_cast<std::size_t>(context_.transmitter)].source_level_db +
         db_from_power(power);
}

PatchRows PingReverberation::rows(std::size_t most) const {
  PathPairs pairs;
  const double source_level =
      scenario_.transmitters[static_cast<std::size_t>(context_.transmitter)].source_level_db;
  const auto add = [&](const ScatteringField& field, std::uint32_t ring, int sector, double share,
                       std::vector<PatchRow>& rows) {
    const ScattererGrid& grid = field.grid;
    const double ring_of = ring_area(grid, ring);
    field.sheet.pairs_at(centre(grid, ring, sector), pairs, &limits_, ring_of);
    for (const PathPair& pair : pairs.found)
      rows.push_back({.ground = field.thickness > 0.0 ? PatchRow::Ground::volume
                                : field.boundary == 1 ? PatchRow::Ground::bottom
                                                      : PatchRow::Ground::surface,
                      .bearing = all_round(field) ? std::nan("") : sector_bearing(grid, sector),
                      .range = (ring + 0.5) * grid.spacing,
                      .area = share * ring_of * pair.area,
                      .delay = pair.delay,
                      .grazing_in = pair.grazing_in,
                      .grazing_out = pair.grazing_out,
                      .launch_elevation = pair.out->launch_elevation,
                      .arrival_elevation = -pair.back->launch_elevation,
                      .scattering_strength_db = db_from_power(pair.cross_section),
                      .level_db = source_level + db_from_power(std::norm(pair.amplitude) * share *
                                                               ring_of * pair.area)});
  };
  // Every how many rings: from the number of pairs of one ring in 32.
  std::vector<PatchRow> counted;
  for (const ScatteringField& field : fields_) {
    const auto sectors = sample_sectors(field);
    for (std::uint32_t ring = 0; ring < field.grid.rings; ring += 32)
      for (const int sector : sectors) add(field, ring, sector, 1.0, counted);
  }
  PatchRows result;
  const std::size_t all = 32 * counted.size();
  result.every = static_cast<int>(std::max<std::size_t>(1, (all + most - 1) / most));
  for (const ScatteringField& field : fields_) {
    const auto sectors = sample_sectors(field);
    const double share = 1.0 / static_cast<double>(sectors.size());
    for (std::uint32_t ring = 0; ring < field.grid.rings;
         ring += static_cast<std::uint32_t>(result.every))
      for (const int sector : sectors) add(field, ring, sector, share, result.rows);
  }
  if (result.rows.size() > most) result.rows.resize(most);
  return result;
}

}  // namespace asdic
