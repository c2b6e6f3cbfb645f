#include "sonar/echo.h"

#include <algorithm>
#include <cmath>

#include "sonar/doppler.h"
#include "sonar/geometry.h"

namespace asdic {
namespace {

/// A place on a track near a moment: position there, and a velocity for the way from it.
struct Mover {
  Kinematics at_reference;
  double reference_time = 0.0;  ///< since the ping's start [s]

  static Mover on(const Track& track, const Vec3& offset, double ping_time, double time) {
    Kinematics k = track.at(ping_time + time);
    k.position += offset;
    return {k, time};
  }
};

Vec3 slowness_vector(double bearing, double elevation, double sound_speed) {
  return direction(bearing, elevation) / sound_speed;
}

PathLimits limits_of(const PropagationSettings& settings) {
  return {.max_surface_bounces = settings.max_surface_bounces,
          .max_bottom_bounces = settings.max_bottom_bounces,
          .max_launch_angle = settings.max_launch_angle};
}

/// One way from a fixed point at a known time to something that moves: eigenrays to where it is
/// when the first of them comes.
struct Way {
  Leg leg;
  Mover end;
};

class EchoFinder {
 public:
  EchoFinder(const EchoContext& context, int target)
      : context_(context),
        scenario_(context.scenario),
        target_(scenario_.targets[static_cast<std::size_t>(target)]),
        index_(target) {}

  TargetEchoes find() {
    const Kinematics source = scenario_.platform.at(context_.ping_time);
    const Way out =
        way(source.position, 0.0, target_.track, Vec3::Zero(), Leg::Kind::source_to_target);
    TargetEchoes result;
    result.legs.push_back(out.leg);
    if (out.leg.arrivals.empty()) return result;
    if (scenario_.propagation.exact_per_phone) {
      for (std::size_t n = 0; n < scenario_.array.phones.size(); ++n)
        pair_up(source, out, static_cast<int>(n), result);
    } else {
      pair_up(source, out, -1, result);
    }
    return result;
  }

 private:
  double speed_at(double depth) const { return context_.ocean.environment().water.at(depth).c; }

  Way way(const Vec3& from, double start, const Track& track, const Vec3& offset,
          Leg::Kind kind) const {
    Way way;
    double travel = 0.0;
    for (int i = 0; i < 3; ++i) {  // the target moves metres in the correction of its own motion:
                                   // two rounds reach rounding
      way.end = Mover::on(track, offset, context_.ping_time, start + travel);
      const Vec3& to = way.end.at_reference.position;
      const Separation s = separation(from, to);
      way.leg.kind = kind;
      way.leg.target = index_;
      way.leg.bearing = s.bearing;
      way.leg.range = s.range;
      way.leg.arrivals = context_.ocean.find(from.z(), to.z(), s.range, context_.frequency,
                                             limits_of(scenario_.propagation));
      if (way.leg.arrivals.empty()) break;
      const double arrival = way.leg.arrivals.front().delay;
      if (way.end.at_reference.velocity.isZero() && i > 0) break;
      if (std::abs(arrival - travel) < 1e-9) break;
      travel = arrival;
    }
    return way;
  }

  void pair_up(const Kinematics& source, const Way& out, int channel, TargetEchoes& result) const {
    const Vec3 offset =
        scenario_.array.offset +
        (channel < 0 ? Vec3::Zero() : scenario_.array.phones[static_cast<std::size_t>(channel)]);
    Way back = way(out.end.at_reference.position, out.end.reference_time, scenario_.platform,
                   offset, Leg::Kind::target_to_array);
    back.leg.channel = channel;
    for (std::size_t i = 0; i < out.leg.arrivals.size(); ++i)
      for (std::size_t j = 0; j < back.leg.arrivals.size(); ++j) {
        EchoPath echo = pair(source, out, back, out.leg.arrivals[i], back.leg.arrivals[j]);
        echo.outgoing = static_cast<int>(i);
        echo.returning = static_cast<int>(j);
        echo.heard.channel = channel < 0 ? Return::all_channels : channel;
        result.echoes.push_back(echo);
      }
    result.legs.push_back(std::move(back.leg));
  }

  EchoPath pair(const Kinematics& source, const Way& out, const Way& back, const Arrival& there,
                const Arrival& home) const {
    const Kinematics& target = out.end.at_reference;
    const Kinematics& phone = back.end.at_reference;
    const double c_source = speed_at(source.position.z()), c_target = speed_at(target.position.z()),
                 c_phone = speed_at(phone.position.z());
    const Vec3 at_source = slowness_vector(out.leg.bearing, there.launch_elevation, c_source);
    const Vec3 into_target = slowness_vector(out.leg.bearing, there.arrival_elevation, c_target);
    const Vec3 out_of_target = slowness_vector(back.leg.bearing, home.launch_elevation, c_target);
    const Vec3 at_phone = slowness_vector(back.leg.bearing, home.arrival_elevation, c_phone);

    // Struck at t₁ = τ₁ + s_in·v_T(t₁ − t_ref); heard at t₂ = t₁ + τ₂ − s_out·v_T(t₁ − t_ref) +
    // s_R·v_R(t₂ − t_ref′).
    const double into = into_target.dot(target.velocity);
    const double struck = (there.delay - into * out.end.reference_time) / (1.0 - into);
    const double late = struck - out.end.reference_time;
    const double away = at_phone.dot(phone.velocity);
    const double heard = (struck + home.delay - out_of_target.dot(target.velocity) * late -
                          away * back.end.reference_time) /
                         (1.0 - away);

    EchoPath echo;
    echo.target = index_;
    echo.heard.delay = heard;
    echo.heard.amplitude = there.amplitude * home.amplitude *
                           context_.pattern(there.launch_elevation) *
                           amplitude_from_db(target_.strength_db);
    echo.heard.doppler = echo_doppler({source.velocity, at_source}, {target.velocity, into_target},
                                      {target.velocity, out_of_target}, {phone.velocity, at_phone});
    echo.heard.slowness = at_phone;
    echo.level_db =
        scenario_.transmitter.source_level_db + db_from_amplitude(std::abs(echo.heard.amplitude));
    return echo;
  }

  const EchoContext& context_;
  const Scenario& scenario_;
  const Target& target_;
  int index_;
};

}  // namespace

TargetEchoes target_echoes(const EchoContext& context, int target) {
  return EchoFinder(context, target).find();
}

}  // namespace asdic
