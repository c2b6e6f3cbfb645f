#include "reverb/fields/scatterer_field.h"

#include <algorithm>
#include <cmath>

#include "core/fields.h"
#include "core/mixed_bits.h"
#include "core/quantities.h"

namespace asdic::detail {
namespace {

constexpr double strip = 0.1;  // in which one anchor's sea goes over into the next, of a pitch

double unit(std::uint32_t word) noexcept { return (word + 0.5) * 0x1p-32; }

std::uint64_t bits(double metres) noexcept {  // a place to the decimetre
  return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::llround(10.0 * metres)));
}

/// A gamma variate of shape ν and mean 1: Marsaglia & Tsang, ACM TOMS 26, 363 (2000), below ν = 1
/// by G(ν) = G(ν + 1)·U^{1/ν}.
double gamma_of_mean_one(double shape, RandomStream& draw) {
  const double boosted = shape < 1.0 ? shape + 1.0 : shape;
  const double d = boosted - 1.0 / 3.0, c = 1.0 / std::sqrt(9.0 * d);
  for (;;) {
    const double x = draw.normal(), v = std::pow(1.0 + c * x, 3.0);
    if (v <= 0.0) continue;
    if (std::log(draw.uniform()) >= 0.5 * x * x + d - d * v + d * std::log(v)) continue;
    const double scale = shape < 1.0 ? std::pow(draw.uniform(), 1.0 / shape) : 1.0;
    return d * v * scale / shape;
  }
}

}  // namespace

void ScattererStatistics::describe(Fields& field) {
  bool frozen = std::isinf(coherence_time);
  const double otherwise = frozen ? 0.0 : coherence_time;
  std::optional<double> time = frozen ? std::nullopt : std::optional(coherence_time);
  field("coherence_time", time,
        {.noun = "time", .unit = "s", .low = 1e-6, .high = 1e9, .or_zero = true},
        "after which a scatterer's weight is another; 0: with every ping");
  if (time) frozen = false;
  field("frozen", frozen, "whether weights never change");
  if (field.checks() && frozen && time)
    field.fault("coherence_time", "none for scatterers that never change (frozen = true)");
  if (field.reads()) coherence_time = frozen ? infinity : time.value_or(otherwise);
  field("k_shape", k_shape, {.noun = "shape", .low = 0.05, .high = 1e4},
        "of the gamma-distributed texture");
  if (const Only with(field, k_shape || field.exhaustive(), {.key = "k_shape"}); with)
    field("correlation_length", correlation_length,
          {.noun = "length", .unit = "m", .low = 1e-3, .high = 1e6}, "of the texture");
}

std::uint64_t ScattererKey::entity(std::uint64_t identity) const noexcept {
  return mixed(mixed(identity, std::uint64_t{ring} << 32 | sector),
               std::uint64_t{copies} << 32 | copy);
}

Scatterer place_scatterer(const ScattererGrid& grid, const ScattererKey& key, std::uint64_t entity,
                          std::uint64_t seed) noexcept {
  const auto words = RandomStream(seed, Draw::scatterer_place, 0, entity).block(0);
  const double inner = key.ring * grid.spacing, outer = inner + grid.spacing;
  const double width = 2.0 * pi / (double(grid.azimuths) * key.copies);
  const double range = std::sqrt(std::lerp(inner * inner, outer * outer, unit(words[0])));
  const double strip = double(key.sector) * key.copies + key.copy;
  const double bearing = grid.first_bearing + width * (strip + unit(words[1]));
  return {.place = grid.anchor + range * Vec2(std::sin(bearing), std::cos(bearing)),
          .area = 0.5 * (outer * outer - inner * inner) * width,
          .depth_share = unit(words[2]),
          .fate = unit(words[3])};
}

ScattererWeights::ScattererWeights(const ScattererStatistics& statistics, Draw purpose,
                                   std::uint64_t seed, double time, std::uint32_t ping)
    : purpose_(purpose), seed_(seed) {
  const double coherence = statistics.coherence_time;
  if (coherence <= 0.0) {
    first_ = ping;
    return;
  }
  if (std::isinf(coherence)) return;
  // h has the standard deviation T/2; steps of 0.53 T leave 5e-5 of ripple in Σh².
  const double step = 0.53 * coherence;
  const double now = time / step;
  nodes_ = most_nodes;
  constexpr int before = (most_nodes - 1) / 2;
  const double first = std::round(now) - before;
  // Nodes before the start of the scenario have keys of their own: the upper half of 32 bits.
  first_ = static_cast<std::uint32_t>(static_cast<std::int64_t>(first));
  double power = 0.0;
  for (int j = 0; j < nodes_; ++j) {
    const double u = (now - first - j) * step / coherence;
    share_[static_cast<std::size_t>(j)] = std::exp(-2.0 * u * u);
    power += std::exp(-4.0 * u * u);
  }
  for (double& share : share_) share /= std::sqrt(power);
}

std::complex<double> ScattererWeights::operator()(std::uint64_t entity) const noexcept {
  std::complex<double> weight = 0.0;
  for (int j = 0; j < nodes_; ++j) {
    const auto words =
        RandomStream(seed_, purpose_, first_ + static_cast<std::uint32_t>(j), entity).block(0);
    const double radius = std::sqrt(-std::log(unit(words[0])));  // Box–Muller, E|w|² = 1
    const double angle = 2.0 * pi * unit(words[1]);
    weight += share_[static_cast<std::size_t>(j)] * radius *
              std::complex<double>(std::cos(angle), std::sin(angle));
  }
  return weight;
}

double texture_amplitude(const ScattererStatistics& statistics, const Vec2& place,
                         std::uint64_t boundary, std::uint64_t seed) noexcept {
  if (!statistics.k_shape) return 1.0;
  const auto square = [&](double x, std::uint32_t word) {
    return static_cast<std::uint64_t>(
        static_cast<std::int64_t>(std::floor(x / statistics.correlation_length + unit(word))));
  };
  // The squares' corners are drawn, so that a sonar at [0, 0] is not at a corner with every seed.
  const auto origin = RandomStream(seed, Draw::scatterer_texture, 1, boundary).block(0);
  RandomStream draw(
      seed, Draw::scatterer_texture, 0,
      mixed(mixed(boundary, square(place.x(), origin[0])), square(place.y(), origin[1])));
  return std::sqrt(gamma_of_mean_one(*statistics.k_shape, draw));
}

std::vector<Anchor> anchors_of(const Vec2& first, const Vec2& now, double time, const Vec2& current,
                               double pitch, std::uint64_t boundary, bool blended) {
  const Vec2 moved = (now - first - current * time) / pitch;
  const Vec2 nearest(std::round(moved.x()), std::round(moved.y()));
  std::vector<Anchor> anchors;
  const auto add = [&](const Vec2& point, double share) {
    const Vec2 in_water = first + pitch * point;
    anchors.push_back({.place = in_water + current * time,
                       .identity = mixed(mixed(boundary, bits(in_water.x())), bits(in_water.y())),
                       .share = share});
  };
  // On each axis the nearest point and, within half a strip of the border, the next one over it.
  Vec2 beyond = Vec2::Zero(), near = Vec2::Ones(), far = Vec2::Zero();
  for (int axis = 0; axis < 2 && blended; ++axis) {
    const double off = moved[axis] - nearest[axis];
    const double inside = (0.5 - std::abs(off)) / (0.5 * strip);  // of the border, 1 at the edge
    if (inside >= 1.0) continue;
    const double angle = 0.25 * pi * (1.0 - inside);  // π/4 on the border: halves
    beyond[axis] = off < 0.0 ? -1.0 : 1.0;
    near[axis] = std::cos(angle);
    far[axis] = std::sin(angle);
  }
  for (const bool north : {false, true})
    for (const bool east : {false, true}) {
      const double share = (east ? far.x() : near.x()) * (north ? far.y() : near.y());
      if (share > 0.0)
        add(nearest + Vec2(east ? beyond.x() : 0.0, north ? beyond.y() : 0.0), share);
    }
  return anchors;
}

}  // namespace asdic::detail
