#include "reverb/scattering/sea_draws.h"

#include <cmath>

#include "core/mixed_bits.h"
#include "core/units.h"

namespace asdic::detail {
namespace {

constexpr std::size_t most_kept = 400'000;  // some 30 MB

}  // namespace

std::size_t SeaDraws::Hash::operator()(const Try& at) const noexcept {
  return mixed(at.path, (static_cast<std::uint64_t>(at.bounce) << 32) ^
                            (static_cast<std::uint64_t>(at.part) << 16) ^
                            static_cast<std::uint64_t>(at.number));
}

RandomStream SeaDraws::stream(const Try& at) const {
  const std::uint64_t bounce =
      (static_cast<std::uint64_t>(at.bounce) << 16) + static_cast<std::uint64_t>(at.number) + 1;
  return {seed_, Draw::forward_scatter, static_cast<std::uint32_t>(at.part),
          mixed(~at.path, bounce)};
}

SeaDraws::Chances SeaDraws::chances(const Try& at) const {
  RandomStream draws = stream(at);
  return {draws.uniform(), draws.uniform(), draws.uniform(), draws.uniform()};
}

WaveSum SeaDraws::drawn_sum(const Try& at, int count) const {
  RandomStream draws = stream(at);
  for (int i = 0; i < 4; ++i) (void)draws.uniform();  // those of chances()
  double along = 0.0, across = 0.0, omega = 0.0;
  for (int i = 0; i < count; ++i) {
    const double wave = 1.0 / std::sqrt(-std::log(draws.uniform()));
    const double u = draws.uniform();
    const double way = draws.uniform() < 0.5 ? -1.0 : 1.0;
    if (sea_ == Sea::isotropic) {
      along += wave * std::cos(2.0 * pi * u);
      across += wave * std::sin(2.0 * pi * u);
    } else {
      along += u < 0.5 ? wave : -wave;
    }
    omega += way * std::sqrt(wave);
  }
  return {static_cast<float>(along), static_cast<float>(across), static_cast<float>(omega)};
}

WaveSum SeaDraws::sum(const Try& at, int count) {
  const auto known = kept_.find(at);
  if (known == kept_.end()) {
    const WaveSum drawn = drawn_sum(at, count);
    if (kept_.size() < most_kept) kept_.emplace(at, Kept{drawn, count});
    return drawn;
  }
  Kept& kept = known->second;
  if (kept.count != count) kept = {drawn_sum(at, count), count};
  return kept.sum;
}

}  // namespace asdic::detail
