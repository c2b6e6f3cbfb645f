#include "sonar/reverberation/reverberation_covariance.h"

#include <algorithm>
#include <cmath>

#include "core/grouped.h"
#include "core/mixed_bits.h"
#include "raytrace/parallel/parallel.h"
#include "reverb/power/delay_bins.h"
#include "sonar/reverberation/segment_covariance.h"

namespace asdic::detail {
namespace {

using Listener = ReverberationCovariance::Listener;
using Segment = ReverberationCovariance::Segment;

constexpr double golden = 0.6180339887498949;

/// The places of a field at which pairs are looked at: on circles half a bin of two-way delay apart
/// and, further out, a 256th of their radius, four to a segment of delays.
struct Circles {
  const ScatteringField& field;
  std::vector<double> edges;  // [m]
  std::size_t sectors;

  Circles(const ScatteringField& f, double bin, std::size_t bearings) : field(f), edges{0.0} {
    const double reach = field.grid.rings * field.grid.spacing;
    const double height = std::abs(field.depth - field.sheet.ends().source.position.z());
    const double least = std::clamp(0.25 * slowest_sea * bin, 1.0, std::max(1.0, 0.25 * height));
    while (edges.back() < reach)
      edges.push_back(std::min(reach, edges.back() + std::max(least, edges.back() / 256.0)));
    const auto n = static_cast<std::size_t>(field.bearings);
    // All round one bearing is enough, unless each tells of one choice out of many paths.
    constexpr std::size_t choices = 8;
    sectors = azimuthally_symmetric() ? (field.sheet.bundled() ? choices : 1)
                                      : n * ((bearings + 4 * n - 1) / (4 * n));
  }
  [[nodiscard]] std::size_t count() const noexcept { return edges.size() - 1; }
  [[nodiscard]] bool azimuthally_symmetric() const noexcept {
    return field.sheet.azimuthally_symmetric();
  }
};

/// All that is received of one circle.
void receive_circle(const Circles& circles, std::size_t circle, const AudibleLimits& limits,
                    const PathInterference& interference, ReceptionMemory& memory,
                    std::vector<Received>& received) {
  const ScatteringField& field = circles.field;
  const double step = circles.edges[circle + 1] - circles.edges[circle];
  const double range = circles.edges[circle] + 0.5 * step;
  const double area = 2.0 * pi * range * step / static_cast<double>(circles.sectors);  // a place's
  const double ring = field.ring_area(static_cast<std::uint32_t>(range / field.grid.spacing));
  // Circles' first bearings differ, so that no bearing is left out where a segment has several.
  const double rotated = golden * static_cast<double>(circle);
  const double offset = circles.azimuthally_symmetric() ? 0.5 : rotated - std::floor(rotated);
  const Vec2 middle = field.sheet.ends().source.position.head<2>();
  for (std::size_t sector = 0; sector < circles.sectors; ++sector) {
    const double bearing = field.grid.first_bearing + 2.0 * pi *
                                                          (static_cast<double>(sector) + offset) /
                                                          static_cast<double>(circles.sectors);
    const Vec2 outward(std::sin(bearing), std::cos(bearing));
    receive(field,
            {.middle = middle + range * outward,
             .outward = outward,
             .length = step,
             .width = area / step,
             .area = area,
             .ring = ring,
             .chance = mixed(circle, sector)},
            limits, interference, circles.azimuthally_symmetric(), memory, received);
  }
}

/// Bearings all round, as many as the array can resolve and some more: the mean of
/// e^{i2πf ξ d cos φ} over N equal steps of φ is J₀ to within 2J_N of its argument. Those of four
/// circles interleave, and in a segment that holds a part of a circle more the alias is J_{N/4}.
std::size_t bearings_for(const Listener& listener) {
  double furthest = 0.0, highest = 0.0;
  for (const Vec3& phone : listener.phones)
    furthest = std::max(furthest, (phone - listener.phones.front()).head<2>().norm());
  for (const double f : listener.band.frequencies) highest = std::max(highest, f);
  return static_cast<std::size_t>(2.0 * pi * highest * furthest / slowest_sea) + 64;
}

/// All that is received, field by field, some circles after the other.
std::vector<std::vector<Received>> receive_all(std::span<const ScatteringField* const> fields,
                                               const AudibleLimits& limits, double bin,
                                               const Listener& listener) {
  constexpr std::size_t together = 32, usual = 8;  // circles of a task; pairs of a place
  std::vector<std::vector<Received>> all;
  for (const ScatteringField* field : fields) {
    const Circles circles(*field, bin, bearings_for(listener));
    const PathInterference interference(listener.phones, field->sheet.ends().frequency,
                                        *listener.coherence, circles.azimuthally_symmetric());
    const std::size_t before = all.size();
    all.resize(before + (circles.count() + together - 1) / together);
    in_parallel(all.size() - before, [&](std::size_t part) {
      ReceptionMemory memory;
      std::vector<Received>& received = all[before + part];
      received.reserve(usual * together * circles.sectors);
      const std::size_t end = std::min(circles.count(), (part + 1) * together);
      for (std::size_t i = part * together; i < end; ++i)
        receive_circle(circles, i, limits, interference, memory, received);
    });
  }
  return all;
}

/// Segments of two bins and, later, of a sixty-fourth of the delay, within which elevations hardly
/// change.
std::vector<Segment> segments_of(std::size_t bins) {
  std::vector<Segment> found;
  for (std::size_t begin = 0; begin < bins;) {
    const std::size_t end = std::min(bins, begin + std::max<std::size_t>(2, begin / 64));
    found.push_back({.begin = begin, .end = end});
    begin = end;
  }
  return found;
}

/// The largest level slowness of what is received of whole circles [s/m].
double fastest_of(std::span<Received* const> received) {
  double fastest2 = 0.0;
  for (const Received* h : received)
    if (h->azimuthally_symmetric)
      fastest2 = std::max({fastest2, h->one_slowness.head<2>().squaredNorm(),
                           h->other_slowness.head<2>().squaredNorm()});
  return std::sqrt(fastest2);
}

}  // namespace

bool ReverberationCovariance::serves(const ScatteringField& field) noexcept {
  const SheetEnds& ends = field.sheet.ends();
  const ScattererField& f = field.field;
  constexpr double one_place = 0.1;  // [m]
  return ends.source.velocity.isZero() && !ends.receiver_moves() &&
         (ends.source.position - ends.receiver.position).norm() < one_place && ends.band.empty() &&
         f.motion.kind == ScattererMotion::Kind::still && f.motion.current.isZero() &&
         f.statistics.coherence_time == 0.0 && !f.statistics.k_shape;
}

BandNodes ReverberationCovariance::frequencies_for(std::span<const Vec3> phones, double centre,
                                                   double bandwidth) {
  constexpr double error = 0.01, alike = 0.02;  // [rad]; at both ends of band and array
  double furthest = 0.0;
  for (const Vec3& phone : phones) furthest = std::max(furthest, phone.norm());
  const double half_width = 0.5 * bandwidth;
  const double rotation = 2.0 * pi * half_width * furthest / slowest_sea;
  return chebyshev_nodes(centre, half_width,
                         rotation < alike ? 1 : nodes_for(0.0, rotation, error));
}

ReverberationCovariance::ReverberationCovariance(std::span<const ScatteringField* const> fields,
                                                 const AudibleLimits& limits,
                                                 const Listener& listener)
    : band(listener.band) {
  bin = delay_bin(listener.pulse_duration, listener.latest);
  intensity.assign(static_cast<std::size_t>(std::ceil(listener.latest / bin)), 0.0);
  if (intensity.empty()) return;
  segments = segments_of(intensity.size());
  const Steering steering(listener.phones, listener.band.frequencies);
  components = steering.components();
  std::vector<std::vector<Received>> parts = receive_all(fields, limits, bin, listener);
  std::vector<Received*> received;
  for (std::vector<Received>& part : parts)
    for (Received& h : part) received.push_back(&h);
  const AzimuthallySymmetricArray azimuthally_symmetric(listener.phones, listener.band.frequencies,
                                                        fastest_of(received));

  std::vector<std::size_t> segment_of_bin(intensity.size()), segment_of(received.size());
  for (std::size_t s = 0; s < segments.size(); ++s)
    for (std::size_t b = segments[s].begin; b < segments[s].end; ++b) segment_of_bin[b] = s;
  for (std::size_t i = 0; i < received.size(); ++i) {
    const auto b = static_cast<std::size_t>(std::max(0.0, received[i]->delay) / bin);
    segment_of[i] = segment_of_bin[std::min(b, intensity.size() - 1)];
  }
  const Grouped by_segment = grouped(segment_of, segments.size());

  std::vector<std::vector<std::complex<float>>> factors(segments.size());
  in_parallel(segments.size(), [&](std::size_t s) {
    Segment& segment = segments[s];
    SegmentSum sum(steering, azimuthally_symmetric);
    for (const std::size_t i : by_segment.of(s)) sum.add(*received[i]);
    segment.rank = sum.factor(factors[s]);
  });
  std::size_t count = 0;
  for (std::size_t s = 0; s < segments.size(); ++s) {
    segments[s].first = count;
    count += segments[s].rank;
  }
  columns.resize(count * components);
  for (std::size_t s = 0; s < segments.size(); ++s)
    std::copy(factors[s].begin(), factors[s].end(),
              columns.begin() + static_cast<std::ptrdiff_t>(segments[s].first * components));
  // What a neighbour's cells put into a silent segment has the neighbour's directions.
  const auto take_over = [](Segment& silent, const Segment& neighbour) {
    if (silent.rank > 0) return;
    silent.first = neighbour.first;
    silent.rank = neighbour.rank;
  };
  for (std::size_t s = 1; s < segments.size(); ++s) take_over(segments[s], segments[s - 1]);
  for (std::size_t s = segments.size() - 1; s > 0; --s) take_over(segments[s - 1], segments[s]);
  for (const Received* h : received)
    spread(h->power / bin, (h->delay - 0.5 * h->extent) / bin, (h->delay + 0.5 * h->extent) / bin,
           std::span(intensity));
}

std::size_t ReverberationCovariance::bytes() const noexcept {
  return sizeof *this + intensity.capacity() * sizeof(double) +
         segments.capacity() * sizeof(Segment) + columns.capacity() * sizeof(columns[0]);
}

}  // namespace asdic::detail
