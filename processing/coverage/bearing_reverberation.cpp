#include "processing/coverage/bearing_reverberation.h"

#include <algorithm>
#include <cmath>

#include "core/mixed_bits.h"
#include "reverb/fields/scattering_field.h"
#include "reverb/power/path_interference.h"

namespace asdic::detail {
namespace {

/// A pair through the middle of a piece.
struct Sound {
  std::complex<double> pressure;  // of the whole piece, with the phase of its delay
  double delay, power;
  std::array<double, 3> phases;  // outward, beside that and in depth [rad]
  double steepness;              // [s/m] outward
  double elevation;              // it comes from [rad]
  double level;                  // cosine of that
  bool by_itself;
};

class PieceSounds {
 public:
  PieceSounds(const ScatteringSheet& sheet, const PulseCoherence& pulse, const DelayAxis& axis,
              const ElevationNodes& nodes, const ReceivingPhones& phones, std::span<float> power)
      : sheet_(sheet), pulse_(pulse), axis_(axis), nodes_(nodes), phones_(phones), power_(power) {}

  void add(const Vec2& place, const GroundPiece& piece, double area, std::uint64_t chance) {
    sheet_.pairs_at(place, pairs_, nullptr, 0.0, 0.0, chance);
    if (pairs_.found.empty()) return;
    constexpr double faintest = 1e-6;  // of the loudest pair of a place
    double loudest = 0.0;
    for (const PathPair& pair : pairs_.found) loudest = std::max(loudest, pair.power);
    const PiecePhases turns(piece, sheet_.ends().frequency);
    const Vec2 beside(-piece.outward.y(), piece.outward.x());
    const double omega = 2.0 * pi * sheet_.ends().frequency;
    sounds_.clear();
    for (const PathPair& pair : pairs_.found) {
      if (!(pair.power > faintest * loudest)) continue;
      const double steep = steepness(pair, piece.outward);
      const std::complex<double> pressure =
          pair.amplitude * std::sqrt(pair.area * area * pair.reciprocal);
      sounds_.push_back(
          {.pressure = pressure * std::polar(1.0, -omega * (pair.delay - pairs_.found[0].delay)),
           .delay = pair.delay,
           .power = std::norm(pressure),
           .phases = {turns.along * steep, turns.across * steepness(pair, beside),
                      turns.through * (pair.out_ends->down + pair.back_ends->down)},
           .steepness = steep,
           .elevation = pair.back->launch_elevation,
           .level = std::cos(pair.back->launch_elevation),
           .by_itself = pair.of_many});
    }
    share_interference(piece.outward);
    for (const Sound& sound : sounds_) put(sound, piece.length);
  }

 private:
  /// Gives each of two sounds half of what they are together beyond what they are alone.
  void share_interference(const Vec2& outward) {
    constexpr double nothing = 18.0;  // e⁻⁹
    if (sounds_.empty()) return;
    const double wavenumber = 2.0 * pi * sheet_.ends().frequency / sheet_.ends().receiver_speed;
    const ReceivingPhones::Along phones = phones_.along(outward, sounds_.front().delay);
    const double spread = wavenumber * wavenumber * phones.square;
    std::sort(sounds_.begin(), sounds_.end(),
              [](const Sound& a, const Sound& b) { return a.delay < b.delay; });
    for (std::size_t i = 0; i < sounds_.size(); ++i) {
      Sound& a = sounds_[i];
      if (a.by_itself) continue;
      for (std::size_t j = i + 1; j < sounds_.size(); ++j) {
        Sound& b = sounds_[j];
        if (b.delay - a.delay >= pulse_.duration()) break;
        if (b.by_itself) continue;
        double turned = 0.0;
        for (std::size_t k = 0; k < 3; ++k)
          turned += (a.phases[k] - b.phases[k]) * (a.phases[k] - b.phases[k]);
        const double aside = a.level - b.level;
        turned += spread * aside * aside;
        if (!(turned < nothing)) continue;
        const double both =
            std::exp(-0.5 * turned) *
            std::real(a.pressure * std::conj(b.pressure) * std::conj(pulse_(b.delay - a.delay)) *
                      std::polar(1.0, wavenumber * phones.middle * aside));
        a.power += both;
        b.power += both;
      }
    }
  }

  /// Spreads a sound over the delays that come from its piece.
  void put(const Sound& sound, double length) {
    const double extent = std::max(axis_.step, length * std::abs(sound.steepness));
    const double first = std::max(0.0, (sound.delay - 0.5 * extent) / axis_.step);
    const double last =
        std::min(static_cast<double>(axis_.bins), (sound.delay + 0.5 * extent) / axis_.step);
    if (!(last > first)) return;
    const ElevationNodes::Place at = nodes_.at(sound.elevation);
    const double density = sound.power / extent;
    for (auto bin = static_cast<std::size_t>(first);
         bin < axis_.bins && static_cast<double>(bin) < last; ++bin) {
      const double covered = std::min(last, static_cast<double>(bin) + 1.0) -
                             std::max(first, static_cast<double>(bin));
      float* const row = &power_[bin * nodes_.size()];
      row[at.node] += static_cast<float>(at.share * covered * density);
      if (at.share < 1.0)
        row[at.node + 1] += static_cast<float>((1.0 - at.share) * covered * density);
    }
  }

  const ScatteringSheet& sheet_;
  const PulseCoherence& pulse_;
  const DelayAxis& axis_;
  const ElevationNodes& nodes_;
  const ReceivingPhones& phones_;
  std::span<float> power_;
  PathPairs pairs_;
  std::vector<Sound> sounds_;
};

}  // namespace

ReceivingPhones::Along ReceivingPhones::along(const Vec2& outward, double delay) const {
  if (offsets.empty()) return {};
  Along found;
  double square = 0.0;
  for (const Vec2& offset : offsets) {
    const double place = outward.dot(offset + delay * velocity);
    found.middle += place / static_cast<double>(offsets.size());
    square += place * place / static_cast<double>(offsets.size());
  }
  found.square = std::max(0.0, square - found.middle * found.middle);
  return found;
}

bool ReceivingPhones::alike_all_round() const {
  constexpr double nowhere = 1e-3;  // [m²]
  double xx = 0.0, yy = 0.0, xy = 0.0;
  for (const Vec2& offset : offsets) {
    xx += offset.x() * offset.x();
    yy += offset.y() * offset.y();
    xy += offset.x() * offset.y();
  }
  const double unlike = std::hypot(0.5 * (xx - yy), xy);
  return velocity.isZero(0.0) && unlike <= nowhere * static_cast<double>(offsets.size());
}

std::vector<double> ring_edges(double reach, double height, double delay_step) {
  const double least =
      std::clamp(0.25 * slowest_sea * delay_step, 1.0, std::max(1.0, 0.125 * height));
  std::vector<double> edges{0.0};
  while (edges.back() < reach)
    edges.push_back(std::min(reach, edges.back() + std::max(least, edges.back() / 256.0)));
  return edges;
}

void add_reverberation(const ScatteringSheet& sheet, const ScatteringGround& ground, double bearing,
                       double width, const PulseCoherence& pulse, const DelayAxis& axis,
                       const ElevationNodes& nodes, const ReceivingPhones& phones,
                       std::span<float> power) {
  PieceSounds sounds(sheet, pulse, axis, nodes, phones, power);
  for (std::size_t ring = 0; ring + 1 < ground.edges.size(); ++ring) {
    const double inner = ground.edges[ring], outer = ground.edges[ring + 1];
    const double range = 0.5 * (inner + outer);
    const Vec2 towards(std::sin(bearing), std::cos(bearing));
    const double nearest = sheet.nearest_end(ground.middle + range * towards, ground.depth);
    // No piece is longer than a quarter of its distance from source and array, nor wider than that.
    const auto parts = [&](double size) {
      constexpr double most = 32.0;
      return static_cast<int>(std::clamp(std::ceil(size / nearest), 1.0, most));
    };
    const int along = parts(4.0 * (outer - inner)), around = parts(range * width);
    for (int i = 0; i < along; ++i)
      for (int k = 0; k < around; ++k) {
        const double length = (outer - inner) / along, r = inner + (i + 0.5) * length;
        const double at = bearing + ((k + 0.5) / around - 0.5) * width;
        const Vec2 outward(std::sin(at), std::cos(at));
        const GroundPiece piece{.outward = outward,
                                .length = length,
                                .width = r * width / around,
                                .thickness = ground.thickness};
        sounds.add(ground.middle + r * outward, piece, piece.length * piece.width,
                   mixed(mixed(ring, static_cast<std::uint64_t>(i * around + k)),
                         static_cast<std::uint64_t>(1e6 * bearing)));
      }
  }
}

}  // namespace asdic::detail
