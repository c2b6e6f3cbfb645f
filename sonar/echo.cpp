#include "sonar/echo.h"

#include <algorithm>
#include <cmath>

#include "sonar/doppler.h"
#include "sonar/moving_paths.h"

namespace asdic {
namespace {

class EchoFinder {
 public:
  EchoFinder(const EchoContext& context, int target)
      : context_(context),
        scenario_(context.scenario),
        array_(scenario_.arrays[static_cast<std::size_t>(context.array)]),
        array_track_(scenario_.platforms[static_cast<std::size_t>(array_.platform)].track),
        target_(scenario_.targets[static_cast<std::size_t>(target)]),
        index_(target),
        moving_(context.paths, limits_of(scenario_.propagation), context.frequency,
                context.ping_time) {}

  TargetEchoes find() {
    const Kinematics source = transmitter_at(scenario_, context_.transmitter, context_.ping_time);
    Way out = moving_.way(source.position, 0.0, target_.track, Vec3::Zero());
    out.leg.kind = Leg::Kind::source_to_target;
    out.leg.target = index_;
    TargetEchoes result;
    result.legs.push_back(out.leg);
    if (out.leg.arrivals.empty()) return result;
    if (scenario_.propagation.exact_per_phone) {
      for (std::size_t n = 0; n < array_.phones.size(); ++n)
        pair_up(source, out, static_cast<int>(n), result);
    } else {
      pair_up(source, out, -1, result);
    }
    return result;
  }

 private:
  void pair_up(const Kinematics& source, const Way& out, int channel, TargetEchoes& result) const {
    const Vec3 offset =
        array_.offset +
        (channel < 0 ? Vec3::Zero() : array_.phones[static_cast<std::size_t>(channel)]);
    Way back = moving_.way(out.end.position, out.reference_time, array_track_, offset);
    back.leg.kind = Leg::Kind::target_to_array;
    back.leg.target = index_;
    back.leg.channel = channel;
    back.leg.array = context_.array;
    for (std::size_t i = 0; i < out.leg.arrivals.size(); ++i) {
      const MetPath there =
          moving_.meet(source.position, 0.0, target_.track, Vec3::Zero(), out, out.leg.arrivals[i]);
      const Kinematics struck = target_.track.at(context_.ping_time + there.time);
      const bool moved = struck.position != out.end.position;
      const Way home =
          moved ? moving_.way(struck.position, there.time, array_track_, offset, back.leg.arrivals)
                : back;
      for (std::size_t j = 0; j < back.leg.arrivals.size(); ++j) {
        const Arrival* path =
            moved ? same_path(home.leg.arrivals, back.leg.arrivals[j]) : &back.leg.arrivals[j];
        if (path == nullptr) continue;  // by then it is gone
        EchoPath echo =
            pair(source, there, struck,
                 moving_.meet(struck.position, there.time, array_track_, offset, home, *path));
        echo.outgoing = static_cast<int>(i);
        echo.returning = static_cast<int>(j);
        echo.heard.channel = channel < 0 ? Return::all_channels : channel;
        result.echoes.push_back(echo);
      }
    }
    result.legs.push_back(std::move(back.leg));
  }

  EchoPath pair(const Kinematics& source, const MetPath& there, const Kinematics& target,
                const MetPath& home) const {
    const Kinematics& phone = home.way.end;
    const double c_source = context_.paths.speed_at(source.position),
                 c_target = context_.paths.speed_at(target.position),
                 c_phone = context_.paths.speed_at(phone.position);
    const Vec3 at_source =
        slowness_vector(there.way.leg.bearing, there.path.launch_elevation, c_source);
    const Vec3 into_target =
        slowness_vector(there.way.leg.bearing, there.path.arrival_elevation, c_target);
    const Vec3 out_of_target =
        slowness_vector(home.way.leg.bearing, home.path.launch_elevation, c_target);
    const Vec3 at_phone =
        slowness_vector(home.way.leg.bearing, home.path.arrival_elevation, c_phone);

    EchoPath echo;
    echo.target = index_;
    echo.array = context_.array;
    echo.heard.delay = home.time;
    echo.heard.amplitude = there.path.amplitude * home.path.amplitude *
                           context_.pattern(there.path.launch_elevation) *
                           amplitude_from_db(target_.strength_db);
    echo.heard.doppler = echo_doppler({source.velocity, at_source}, {target.velocity, into_target},
                                      {target.velocity, out_of_target}, {phone.velocity, at_phone});
    echo.heard.slowness = at_phone;
    echo.level_db =
        scenario_.transmitters[static_cast<std::size_t>(context_.transmitter)].source_level_db +
        db_from_amplitude(std::abs(echo.heard.amplitude));
    return echo;
  }

  const EchoContext& context_;
  const Scenario& scenario_;
  const ReceiverArray& array_;
  const Track& array_track_;
  const Target& target_;
  int index_;
  MovingPaths moving_;
};

}  // namespace

TargetEchoes target_echoes(const EchoContext& context, int target) {
  return EchoFinder(context, target).find();
}

}  // namespace asdic
