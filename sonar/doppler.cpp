#include "sonar/doppler.h"

namespace asdic {

double leg_doppler(const MovingEnd& sender, const MovingEnd& receiver) noexcept {
  return (1.0 - receiver.velocity.dot(receiver.slowness)) /
         (1.0 - sender.velocity.dot(sender.slowness));
}

double echo_doppler(const MovingEnd& source, const MovingEnd& target_in,
                    const MovingEnd& target_out, const MovingEnd& receiver) noexcept {
  return leg_doppler(source, target_in) * leg_doppler(target_out, receiver);
}

}  // namespace asdic
