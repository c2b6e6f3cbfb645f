#include "core/doppler.h"

namespace asdic::detail {

double echo_doppler(const MovingEnd& source, const MovingEnd& target_in,
                    const MovingEnd& target_out, const MovingEnd& receiver) noexcept {
  return leg_doppler(source, target_in) * leg_doppler(target_out, receiver);
}

}  // namespace asdic::detail
