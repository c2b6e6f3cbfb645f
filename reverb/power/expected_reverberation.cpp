#include "reverb/power/expected_reverberation.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "core/mixed_bits.h"
#include "raytrace/parallel/parallel.h"
#include "reverb/power/delay_bins.h"
#include "reverb/power/path_interference.h"

namespace asdic::detail {
namespace {

constexpr std::size_t rings_together = 64;  // rings that one task works through

/// Runs f(ring, scratch, out) over every `step`-th ring in parallel. \return what they put out, in
/// their order
template <class Item, class F>
std::vector<std::vector<Item>> over_rings(std::uint32_t rings, std::uint32_t step, F&& f) {
  const std::size_t visited = (rings + step - 1) / step;
  std::vector<std::vector<Item>> parts((visited + rings_together - 1) / rings_together);
  in_parallel(parts.size(), [&](std::size_t b) {
    PathPairs scratch;
    for (std::size_t i = b * rings_together; i < std::min(visited, (b + 1) * rings_together); ++i)
      f(static_cast<std::uint32_t>(i * step), scratch, parts[b]);
  });
  return parts;
}

/// Rings so near each other are sampled only once that eight still lie within a segment.
std::uint32_t sample_step(const ScatteringField& field, double segment) {
  constexpr double samples = 8.0;
  const double delay = 2.0 * field.grid.spacing / slowest_sea;  // from ring to ring, at most
  return static_cast<std::uint32_t>(std::clamp(segment / (samples * delay), 1.0, 1e6));
}

/// A pair through the middle of a cell.
struct Found {
  ExpectedReverberation::Sample sample;
  double ring_power, share;  // of a whole ring like this place; how much of it that stands for
  double scatterers;         // of that ring
};

/// How far a pair's phase turns over it.
std::array<float, 3> phases_of(const PathPair& pair, const GroundPiece& piece,
                               const PiecePhases& phases) noexcept {
  const Vec2 beside(-piece.outward.y(), piece.outward.x());
  return {static_cast<float>(phases.along * steepness(pair, piece.outward)),
          static_cast<float>(phases.across * steepness(pair, beside)),
          static_cast<float>(phases.through * (pair.out_ends->down + pair.back_ends->down))};
}

/// Extent of a pair's delay over a piece of ground and its depth [s].
float extent_of(const PathPair& pair, const GroundPiece& piece) noexcept {
  return static_cast<float>(std::abs(steepness(pair, piece.outward)) * piece.length +
                            std::abs(pair.out_ends->down + pair.back_ends->down) * piece.thickness);
}

/// Difference of two sounds' phases over a piece beyond which their interference is nothing, e⁻⁹.
constexpr float out_of_phase = 4.2426407F;

/// exp(−½|Δ|²), Δ the difference of two sounds' phases over their piece; 0 where it is below e⁻⁹.
float in_phase(const std::array<float, 3>& one, const std::array<float, 3>& other) noexcept {
  float phases = 0.0F;
  for (std::size_t k = 0; k < 3; ++k) phases += (one[k] - other[k]) * (one[k] - other[k]);
  return phases < out_of_phase * out_of_phase ? std::exp(-0.5F * phases) : 0.0F;
}

/// A sound of a place at a time.
struct SoundNow {
  std::complex<double> pressure;
  std::array<float, 3> phases;
};

/// Mean over the place's piece of |Σp|².
double power_of(std::span<const SoundNow> sounds) noexcept {
  double power = 0.0;
  for (std::size_t i = 0; i < sounds.size(); ++i) {
    const SoundNow& a = sounds[i];
    power += std::norm(a.pressure);
    for (const SoundNow& b : sounds.subspan(i + 1))
      if (const float together = in_phase(a.phases, b.phases); together > 0.0F)
        power += 2.0 * double(together) *
                 (a.pressure.real() * b.pressure.real() + a.pressure.imag() * b.pressure.imag());
  }
  return std::max(0.0, power);
}

/// The places of a field at which pairs are looked at: the middles of cells of a few sectors.
struct Middles {
  const ScatteringField& field;
  std::uint32_t first_place;
  std::vector<int> sectors = field.sample_sectors();
  std::uint32_t step;

  Middles(const ScatteringField& f, std::uint32_t first, double segment)
      : field(f), first_place(first), step(sample_step(f, segment)) {}

  [[nodiscard]] std::uint32_t count() const noexcept {
    return static_cast<std::uint32_t>(sectors.size());
  }
  /// Adds the pairs of a ring. No piece is longer than a quarter of its distance from source and
  /// receiver, nor wider than that distance, nor larger than ScatteringSheet::largest_piece().
  void find(std::uint32_t ring, PathPairs& pairs, std::vector<Found>& out) const {
    const std::uint32_t stride = sectors_for_one(ring), looked_at = count() / stride;
    for (std::uint32_t i = 0; i < count(); i += stride) {
      Piece whole{.ring = ring,
                  .sector = i,
                  .bearing = field.bearing(field.sector_of_ring(sectors[i], count(), ring)),
                  .stands_for = std::min(step, field.grid.rings - ring),
                  .share = 1.0 / looked_at};
      std::uint16_t parts = 0;
      divide(whole, parts, pairs, out);
    }
  }

 private:
  /// Number of sectors that one stands for. Far from source and receiver, as far apart as they are,
  /// what is received changes with the bearing like its cosine, and the mean over twelve is exact.
  [[nodiscard]] std::uint32_t sectors_for_one(std::uint32_t ring) const noexcept {
    constexpr std::uint32_t enough = 12;
    constexpr double far = 10.0;
    if (!field.sheet.depends_on_range_alone() || count() % enough != 0) return 1;
    const SheetEnds& ends = field.sheet.ends();
    const auto away = [&](const Vec3& end) { return (end.head<2>() - field.grid.anchor).norm(); };
    const double apart = std::max(away(ends.source.position), away(ends.receiver.position));
    return (ring + 0.5) * field.grid.spacing > far * apart ? count() / enough : 1;
  }
  /// A piece of ground, or of a layer.
  struct Piece {
    std::uint32_t ring = 0, sector = 0;
    double bearing = 0.0;
    std::uint32_t stands_for = 1;  // rings
    double share = 0.0;            // of a whole turn
  };
  /// A part of it, with the pairs through its middle.
  struct Part {
    std::uint32_t ring = 0, sector = 0;
    std::uint16_t part = 0;
    double range = 0.0, bearing = 0.0;
    double length = 0.0, width = 0.0;  // outward and beside that [m]
    double share = 0.0;                // of its ring's area
  };

  /// Halves a piece until its middle stands for all of its width: a wide sector may hold the place
  /// above a receiver though its middle is far away.
  void divide(const Piece& piece, std::uint16_t& parts, PathPairs& pairs,
              std::vector<Found>& out) const {
    constexpr double narrowest = 1.0 / 2304.0;  // of a turn
    const double spacing = field.grid.spacing, middle = (piece.ring + 0.5) * spacing,
                 width = 2.0 * pi * piece.share * middle;
    const Vec2 place =
        field.grid.anchor + middle * Vec2(std::sin(piece.bearing), std::cos(piece.bearing));
    const double nearest = field.sheet.nearest_end(place, field.depth);
    const auto largest = [&](double size, double share) {
      return std::min(share * nearest, field.sheet.largest_piece(place, field.depth, size));
    };
    if (!field.azimuthally_symmetric() && piece.share > narrowest && width > largest(width, 1.0)) {
      Piece half = piece;
      half.share = 0.5 * piece.share;
      for (const double side : {-0.5, 0.5}) {
        half.bearing = piece.bearing + 2.0 * pi * side * half.share;
        divide(half, parts, pairs, out);
      }
      return;
    }
    constexpr double most = 32.0;
    const auto along =
        static_cast<int>(std::clamp(std::ceil(spacing / largest(spacing, 0.25)), 1.0, most));
    const double length = piece.stands_for * spacing / along;
    for (int j = 0; j < along; ++j) {
      const double range = along == 1 ? middle : piece.ring * spacing + (j + 0.5) * length;
      at({.ring = piece.ring,
          .sector = piece.sector,
          .part = parts++,
          .range = range,
          .bearing = piece.bearing,
          .length = length,
          .width = 2.0 * pi * range * piece.share,
          .share = range / middle * piece.stands_for * piece.share / along},
         pairs, out);
    }
  }

  void at(const Part& piece, PathPairs& pairs, std::vector<Found>& out) const {
    constexpr double faintest = 1e-8;  // of the loudest pair of a place
    const GroundPiece ground{.outward = {std::sin(piece.bearing), std::cos(piece.bearing)},
                             .length = piece.length,
                             .width = piece.width,
                             .thickness = field.thickness};
    const Vec2 place = field.grid.anchor + piece.range * ground.outward;
    field.sheet.pairs_at(place, pairs, nullptr, 0.0, 0.0,
                         piece.part == 0 ? mixed(piece.ring, piece.sector)
                                         : mixed(mixed(piece.ring, piece.sector), piece.part));
    const PiecePhases phases(ground, field.sheet.ends().frequency);
    const double area = field.received_area(piece.ring);
    double loudest = 0.0;
    for (const PathPair& pair : pairs.found) loudest = std::max(loudest, pair.power);
    for (const PathPair& pair : pairs.found) {
      if (pair.power < faintest * loudest) continue;
      out.push_back(
          {{.place = first_place + piece.ring * count() + piece.sector,
            .part = piece.part,
            .by_itself = pair.of_many,
            .delay = pair.delay,
            .amplitude =
                pair.amplitude * std::sqrt(pair.area * area * piece.share * pair.reciprocal),
            .phases = phases_of(pair, ground, phases),
            .extent = extent_of(pair, ground)},
           pair.power * area,
           piece.share,
           double(field.grid.azimuths) * field.copies_of(piece.ring, sectors[piece.sector])});
    }
  }
};

/// Pairs of one field, some rings together. They are millions, so they are not copied.
using FoundPairs = std::vector<std::vector<Found>>;

std::vector<FoundPairs> pairs_at_middles(std::span<const ScatteringField> fields, double segment) {
  std::vector<FoundPairs> all;
  std::uint32_t first_place = 0;
  for (const ScatteringField& field : fields) {
    const Middles middles(field, first_place, segment);
    all.push_back(
        over_rings<Found>(field.grid.rings, middles.step,
                          [&](std::uint32_t ring, PathPairs& pairs, std::vector<Found>& out) {
                            middles.find(ring, pairs, out);
                          }));
    first_place += field.grid.rings * middles.count();
  }
  return all;
}

template <class Visit>
void for_each_pair(const std::vector<FoundPairs>& all, const Visit& visit) {
  for (const FoundPairs& of_field : all)
    for (const std::vector<Found>& part : of_field)
      for (const Found& found : part) visit(found);
}

/// Below which all that is left out of a segment is a hundred-thousandth of its power.
std::vector<double> least_power(const std::vector<FoundPairs>& all, double segment) {
  constexpr double left_out = 1e-5;
  struct Entry {
    double power, share;
  };
  const auto segment_of = [&](const Found& f) {
    return static_cast<std::size_t>(f.sample.delay / segment);
  };
  std::vector<std::size_t> counts;
  for_each_pair(all, [&](const Found& f) {
    if (segment_of(f) >= counts.size()) counts.resize(segment_of(f) + 1, 0);
    ++counts[segment_of(f)];
  });
  std::vector<std::vector<Entry>> by_segment(counts.size());
  for (std::size_t s = 0; s < counts.size(); ++s) by_segment[s].reserve(counts[s]);
  for_each_pair(all, [&](const Found& f) {
    by_segment[segment_of(f)].push_back({f.ring_power, f.share});
  });
  std::vector<double> least(counts.size(), 0.0);
  for (std::size_t s = 0; s < least.size(); ++s) {
    std::vector<Entry>& here = by_segment[s];
    std::sort(here.begin(), here.end(), [](const Entry& a, const Entry& b) {
      return std::tie(a.power, a.share) < std::tie(b.power, b.share);
    });
    double total = 0.0, dropped = 0.0;
    for (const Entry& e : here) total += e.power * e.share;
    // The loudest of those left out. Not the faintest of those kept: a scatterer of the next ring
    // that lies a little nearer than its middle would be left out of this segment for it.
    for (const Entry& e : here) {
      dropped += e.power * e.share;
      if (dropped > left_out * total) break;
      least[s] = e.power;
    }
    here = {};
  }
  return least;
}

/// About how many pairs pairs_at_middles() finds, by those at a few rings of each field.
double count_pairs(std::span<const ScatteringField> fields, double segment, std::uint32_t at) {
  double pairs = 0.0;
  for (const ScatteringField& field : fields) {
    const Middles middles(field, 0, segment);
    const std::uint32_t visited = (field.grid.rings + middles.step - 1) / middles.step;
    const std::uint32_t every = std::max(1U, visited / at);
    const FoundPairs counted =
        over_rings<Found>(field.grid.rings, every * middles.step,
                          [&](std::uint32_t ring, PathPairs& found, std::vector<Found>& out) {
                            middles.find(ring, found, out);
                          });
    for (const std::vector<Found>& part : counted)
      pairs += double(every) * static_cast<double>(part.size());
  }
  return pairs;
}

}  // namespace

MemoryNeed ExpectedReverberation::need(std::span<const ScatteringField> fields,
                                       double pulse_duration) {
  // Beside them are the powers in their segments and, later, those that are kept.
  constexpr double a_pair = sizeof(Found) + sizeof(Sample);
  constexpr double little = 100e6;               // [bytes]
  constexpr std::uint32_t few = 4, enough = 64;  // rings looked at
  const double segment = 0.25 * pulse_duration;
  double pairs = count_pairs(fields, segment, few);
  if (pairs * a_pair > little) pairs = count_pairs(fields, segment, enough);
  return {.where = "reverberation.ground_spacing",
          .what = std::to_string(std::llround(pairs)) + " pairs of paths to and from scatterers",
          .bytes = pairs * a_pair,
          .remedy =
              "a larger spacing, fewer bounces (propagation.max_surface_bounces, "
              "max_bottom_bounces) or fewer sheets of a layer"};
}

ExpectedReverberation::ExpectedReverberation(std::span<const ScatteringField> fields,
                                             double pulse_duration) {
  limits.segment = 0.25 * pulse_duration;
  std::vector<FoundPairs> all = pairs_at_middles(fields, limits.segment);
  limits.least = least_power(all, limits.segment);
  const auto counts = [&](const Found& f) { return f.ring_power > limits.at(f.sample.delay); };
  std::size_t kept = 0;
  for_each_pair(all, [&](const Found& f) { kept += counts(f) ? 1 : 0; });
  samples.reserve(kept);
  std::vector<double> of_ring;  // returns of the field in hand
  std::uint32_t first_place = 0;
  for (std::size_t field = 0; field < fields.size(); ++field) {
    const std::uint32_t rings = fields[field].grid.rings;
    const auto count = static_cast<std::uint32_t>(fields[field].sample_sectors().size());
    of_ring.assign(rings, 0.0);
    for (std::vector<Found>& part : all[field]) {
      for (const Found& f : part) {
        if (!counts(f)) continue;
        samples.push_back(f.sample);
        of_ring[(f.sample.place - first_place) / count] += f.share * f.scatterers;
      }
      part = {};
    }
    // What was found at one ring belongs to those that it stands for.
    const std::uint32_t step = sample_step(fields[field], limits.segment);
    for (std::uint32_t ring = 0; ring < rings; ++ring)
      if (ring % step == 0)
        of_ring[ring] /= std::min(step, rings - ring);
      else
        of_ring[ring] = of_ring[ring - ring % step];
    first_place += rings * count;
    cut_into_blocks(field, of_ring);
  }
}

void ExpectedReverberation::cut_into_blocks(std::size_t field, const std::vector<double>& of_ring) {
  constexpr double most = 4096.0;  // returns
  double held = 0.0;
  for (std::uint32_t ring = 0; ring < of_ring.size(); ++ring) {
    if (ring == 0 || held + of_ring[ring] > most) {
      blocks.push_back({.field = field, .begin = ring});
      held = 0.0;
    }
    held += of_ring[ring];
    blocks.back().end = ring + 1;
    blocks.back().expected = static_cast<std::size_t>(std::ceil(held));
    returns += of_ring[ring];
  }
}

std::optional<ExactKey> ExpectedReverberation::key(std::span<const ScatteringField> fields,
                                                   double pulse_duration, Kept kind) {
  ExactKey key(kind, 0);
  key.add_all(pulse_duration, fields.size());
  for (const ScatteringField& f : fields) {
    // All but motion, statistics and draws' keys.
    const auto& [sheet, grid, field, weights, boundary, depth, thickness, received_by, bearings,
                 divided_below, bounces, drawn_anew, stays, share] = f;
    const auto& [anchor, identity, spacing, azimuths, per_cell, first_bearing, rings] = grid;
    if (!sheet.add_to(key)) return std::nullopt;
    key.add_all(anchor, spacing, azimuths, per_cell, first_bearing, rings, depth, bearings,
                divided_below, thickness, share);
  }
  return key;
}

std::size_t ExpectedReverberation::bytes() const noexcept {
  return sizeof *this + limits.least.capacity() * sizeof(double) +
         samples.capacity() * sizeof(Sample) + blocks.capacity() * sizeof(Block);
}

double ExpectedReverberation::returns_of(std::size_t field) const noexcept {
  double sum = 0.0;
  for (const Block& block : blocks)
    if (block.field == field) sum += static_cast<double>(block.expected);
  return sum;
}

double ExpectedReverberation::power(const std::function<std::complex<double>(double)>& sent,
                                    double duration, double t) const {
  double power = 0.0;
  std::vector<SoundNow> here;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double since = t - samples[i].delay;
    if (since >= 0.0 && since <= duration) {
      const std::complex<double> received = samples[i].amplitude * sent(since);
      if (samples[i].by_itself)
        power += std::norm(received);
      else
        here.push_back({received, samples[i].phases});
    }
    if (i + 1 == samples.size() || samples[i + 1].place != samples[i].place ||
        samples[i + 1].part != samples[i].part) {
      power += power_of(here);
      here.clear();
    }
  }
  return power;
}

namespace {

/// A sound received from a place. Its pressure includes the carrier's phase at its delay.
struct PlacedSound {
  std::complex<double> pressure;
  double delay, extent;
  const std::array<float, 3>* phases;
  bool by_itself;
};

/// Energy received in even steps of time.
struct EnergySteps {
  double first, step;
  std::vector<double> energy;

  /// Adds an energy that arrives as a trapezoid of time: evenly over the pulse's duration, from a
  /// place whose delay is spread evenly over an extent.
  void add(double energy_of, double delay, double extent, double duration) noexcept {
    const double lasts = std::max(extent, 1e-3 * duration);
    const double begin = delay - 0.5 * lasts;
    const auto ramp = [](double t) { return t > 0.0 ? 0.5 * t * t : 0.0; };
    const auto until = [&](double t) {
      return (ramp(t - begin) - ramp(t - begin - duration) - ramp(t - begin - lasts) +
              ramp(t - begin - lasts - duration)) /
             (duration * lasts);
    };
    const double from = (begin - first) / step, to = (begin + lasts + duration - first) / step;
    if (!(to > 0.0) || from >= static_cast<double>(energy.size())) return;
    const auto last = std::min(energy.size(), static_cast<std::size_t>(to) + 1);
    auto i = static_cast<std::size_t>(std::max(0.0, from));
    double before = until(first + static_cast<double>(i) * step);
    for (; i < last; ++i) {
      const double after = until(first + static_cast<double>(i + 1) * step);
      energy[i] += energy_of * (after - before);
      before = after;
    }
  }
};

/// Energy by the delay of its leading edge, in even bins, each a fraction of a step: the pulse is
/// spread over the steps once for each bin.
class EnergyByDelay {
 public:
  EnergyByDelay(const EnergySteps& steps, std::size_t count, double duration)
      : bin_(steps.step / finer),
        begin_(steps.first - duration - bin_),
        bins_(static_cast<std::size_t>(
            std::ceil((static_cast<double>(count) * steps.step + duration) / bin_) + 2.0)) {}

  /// Adds energy that arrives evenly over an extent of delay, of a bin at least.
  void add(double energy, double delay, double extent) noexcept {
    const double half = 0.5 * std::max(1.0, extent / bin_), middle = (delay - begin_) / bin_;
    const double all = static_cast<double>(bins_.size());
    const double from = std::max(0.0, middle - half), to = std::min(all, middle + half);
    if (from < to) spread(energy * (to - from) / (2.0 * half), from, to, std::span(bins_));
  }
  void receive(double duration, EnergySteps& steps) const noexcept {
    for (std::size_t i = 0; i < bins_.size(); ++i)
      if (bins_[i] != 0.0)
        steps.add(bins_[i], begin_ + (static_cast<double>(i) + 0.5) * bin_, bin_, duration);
  }

 private:
  static constexpr double finer = 16.0;
  double bin_, begin_;  // [s]
  std::vector<double> bins_;
};

}  // namespace

std::vector<double> ExpectedReverberation::mean_power(const SentPulse& pulse, double first,
                                                      double step, std::size_t count) const {
  constexpr std::size_t most_tasks = 16;
  std::vector<std::size_t> cuts;  // first samples of tasks
  for (std::size_t task = 0; task <= most_tasks; ++task) {
    std::size_t at = samples.size() * task / most_tasks;
    while (at > 0 && at < samples.size() && samples[at].place == samples[at - 1].place) ++at;
    cuts.push_back(at);
  }
  std::vector<EnergySteps> parts(most_tasks, {first, step, {}});
  const double omega = 2.0 * pi * pulse.frequency;
  in_parallel(most_tasks, [&](std::size_t task) {
    EnergySteps& steps = parts[task];
    steps.energy.assign(count, 0.0);
    EnergyByDelay arriving(steps, count, pulse.duration);
    std::vector<PlacedSound> here;
    for (std::size_t i = cuts[task]; i < cuts[task + 1]; ++i) {
      const Sample& sample = samples[i];
      const double turn = std::fmod(omega * sample.delay, 2.0 * pi);
      here.push_back({sample.amplitude * std::polar(1.0, -turn), sample.delay,
                      double(sample.extent), &sample.phases, sample.by_itself});
      if (i + 1 < cuts[task + 1] && samples[i + 1].place == sample.place &&
          samples[i + 1].part == sample.part)
        continue;
      // Few are in phase with one another over their piece: those of almost one steepness.
      std::sort(here.begin(), here.end(), [](const PlacedSound& a, const PlacedSound& b) {
        return std::tie((*a.phases)[0], a.delay) < std::tie((*b.phases)[0], b.delay);
      });
      for (std::size_t a = 0; a < here.size(); ++a) {
        const PlacedSound& one = here[a];
        arriving.add(pulse.energy * std::norm(one.pressure), one.delay, one.extent);
        for (std::size_t b = a + 1; b < here.size() && !one.by_itself; ++b) {
          const PlacedSound& other = here[b];
          if ((*other.phases)[0] - (*one.phases)[0] >= out_of_phase) break;
          const double later = other.delay - one.delay;
          if (other.by_itself || std::abs(later) >= pulse.duration) continue;
          const auto together = double(in_phase(*one.phases, *other.phases));
          if (!(together > 0.0)) continue;
          const std::complex<double> coherence = pulse.coherence(std::abs(later));
          const double both = 2.0 * together *
                              (one.pressure * std::conj(other.pressure) *
                               (later < 0.0 ? std::conj(coherence) : coherence))
                                  .real();
          arriving.add(pulse.energy * both, 0.5 * (one.delay + other.delay),
                       0.5 * (one.extent + other.extent));
        }
      }
      here.clear();
    }
    arriving.receive(pulse.duration, steps);
  });
  std::vector<double> mean(count, 0.0);
  for (const EnergySteps& part : parts)
    for (std::size_t i = 0; i < count; ++i) mean[i] += part.energy[i] / step;
  for (double& power : mean) power = std::max(0.0, power);
  return mean;
}

}  // namespace asdic::detail
