#pragma once
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "core/random.h"
#include "raytrace/ocean/roughness.h"

namespace asdic::detail {

/// Sum of waves drawn from a sea's spectrum whose scale is 1 rad/m, under a gravity of 1 m/s².
struct WaveSum {
  float along = 0.0F, across = 0.0F;  ///< Σ K along the path and to its right, over the scale
  float omega = 0.0F;                 ///< Σ ±√K, over the root of gravity times the scale
};

/// Random waves behind the kinks of paths. What is drawn for a part and bounce of a path depends on
/// nothing else, so a path that is found again, at another time or for another receiver, has the
/// same waves. Sums are kept, because a leg asks for them at each of its moments.
class SeaDraws {
 public:
  explicit SeaDraws(std::uint64_t seed, Sea sea = Sea::isotropic) : seed_(seed), sea_(sea) {}

  /// One try to draw the kink of a bounce.
  struct Try {
    std::uint64_t path = 0;  ///< which path of what, the same from ping to ping
    int part = 0;
    std::size_t bounce = 0;
    int number = 0;  ///< of tries before it

    bool operator==(const Try&) const = default;
  };

  /// Random numbers of a try, uniform in (0, 1).
  struct Chances {
    double count, acceptance, normal_radius, normal_angle;
  };
  [[nodiscard]] Chances chances(const Try& at) const;

  /// Sum of the first waves of a try, from the sums kept where it was asked for before.
  [[nodiscard]] WaveSum sum(const Try& at, int count);

  /// The same, drawn.
  [[nodiscard]] WaveSum drawn_sum(const Try& at, int count) const;

 private:
  struct Kept {
    WaveSum sum;
    std::int32_t count = 0;
  };
  struct Hash {
    std::size_t operator()(const Try& at) const noexcept;
  };

  [[nodiscard]] RandomStream stream(const Try& at) const;

  std::uint64_t seed_;
  Sea sea_;
  std::unordered_map<Try, Kept, Hash> kept_;
};

}  // namespace asdic::detail
