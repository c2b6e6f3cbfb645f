#include "raytrace/like_bellhop/beam.h"
namespace asdic::like_bellhop {
void lay_ray_centred_hat(const Beam&, const ReceiverBlock&, BeamSink&) {}
void lay_ray_centred_gaussian(const Beam&, const ReceiverBlock&, BeamSink&) {}
void lay_simple_gaussian(const Beam&, const ReceiverBlock&, BeamSink&) {}
void lay_cerveny_ray_centred(const Beam&, const CervenyBeams&, const ReceiverBlock&, BeamSink&) {}
}
