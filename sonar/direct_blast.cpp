#include "sonar/direct_blast.h"

#include "sonar/doppler.h"
#include "sonar/moving_paths.h"

namespace asdic {
namespace {

/// The blast at one phone, or at the reference point for all of them.
void hear(const EchoContext& context, int channel, DirectBlast& blast) {
  const Scenario& scenario = context.scenario;
  const ReceiverArray& array = scenario.arrays[static_cast<std::size_t>(context.array)];
  const Track& track = scenario.platforms[static_cast<std::size_t>(array.platform)].track;
  const Vec3 offset = channel < 0
                          ? array.offset
                          : Vec3(array.offset + array.phones[static_cast<std::size_t>(channel)]);
  const Kinematics source = transmitter_at(scenario, context.transmitter, context.ping_time);
  const MovingPaths moving(context.paths, limits_of(scenario.propagation), context.frequency,
                           context.ping_time);
  Way way = moving.way(source.position, 0.0, track, offset);
  way.leg.kind = Leg::Kind::source_to_array;
  way.leg.array = context.array;
  way.leg.channel = channel;
  const double c_source = context.paths.speed_at(source.position);
  for (const Arrival& path : way.leg.arrivals) {
    const MetPath met = moving.meet(source.position, 0.0, track, offset, way, path);
    const double c_array = context.paths.speed_at(met.way.end.position);
    const Vec3 leaving = slowness_vector(met.way.leg.bearing, met.path.launch_elevation, c_source);
    const Vec3 arriving = slowness_vector(met.way.leg.bearing, met.path.arrival_elevation, c_array);
    blast.heard.push_back(
        {.delay = met.time,
         .amplitude = met.path.amplitude * context.pattern(met.path.launch_elevation),
         .doppler = leg_doppler({source.velocity, leaving}, {met.way.end.velocity, arriving}),
         .slowness = arriving,
         .channel = channel < 0 ? Return::all_channels : channel});
  }
  blast.legs.push_back(std::move(way.leg));
}

}  // namespace

DirectBlast direct_blast(const EchoContext& context) {
  DirectBlast blast;
  const Scenario& scenario = context.scenario;
  if (!scenario.propagation.exact_per_phone) {
    hear(context, -1, blast);
    return blast;
  }
  const auto phones = scenario.arrays[static_cast<std::size_t>(context.array)].phones.size();
  for (std::size_t n = 0; n < phones; ++n) hear(context, static_cast<int>(n), blast);
  return blast;
}

}  // namespace asdic
