#pragma once
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/random.h"
#include "sonar/paths/returns.h"

namespace asdic::detail::support {

/// Returns of random phase and level spread over a time and a band of Doppler factors, for tests.
struct RandomReturns {
  std::size_t count = 300;
  double first = 0.0, last = 1.0;      ///< delays [s]
  double doppler = 1.0, spread = 0.0;  ///< η within doppler ± spread
  int channels = 0;                    ///< above 0: a quarter of them go to one channel each
  std::uint64_t seed = 1;

  [[nodiscard]] Returns make() const {
    RandomStream draw(seed, Draw::surface_weight, 0, 0);
    Returns returns(count);
    for (Return& r : returns) {
      r.delay = first + (last - first) * draw.uniform();
      r.amplitude = draw.complex_normal();
      r.doppler = doppler + spread * (2.0 * draw.uniform() - 1.0);
      const double azimuth = 2.0 * pi * draw.uniform(), elevation = pi * (draw.uniform() - 0.5);
      r.slowness = Vec3(std::sin(azimuth) * std::cos(elevation),
                        std::cos(azimuth) * std::cos(elevation), std::sin(elevation)) /
                   1500.0;
      if (channels > 0 && draw.uniform() < 0.25)
        r.channel = static_cast<int>(draw.uniform() * channels);
    }
    return returns;
  }
};

}  // namespace asdic::detail::support
