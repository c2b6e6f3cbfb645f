#include "sonar/doppler.h"

namespace asdic {

double leg_doppler(const RayEnd& sender, const RayEnd& receiver) noexcept {
  return (1.0 - receiver.velocity.dot(receiver.slowness)) /
         (1.0 - sender.velocity.dot(sender.slowness));
}

double echo_doppler(const RayEnd& source, const RayEnd& target_in, const RayEnd& target_out,
                    const RayEnd& receiver) noexcept {
  return leg_doppler(source, target_in) * leg_doppler(target_out, receiver);
}

}  // namespace asdic
