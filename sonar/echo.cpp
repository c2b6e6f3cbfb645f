#include "sonar/echo.h"

#include <algorithm>
#include <cmath>
#include <span>

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

/// One way from a fixed point at a known time to something that moves: eigenrays to where it is at
/// a reference time.
struct Way {
  Leg leg;
  Mover end;
};

/// The same path after its ends have moved by metres: same history, nearest launch angle. Null if
/// it is there no more.
const Arrival* same_path(const Arrivals& arrivals, const Arrival& path) {
  const Arrival* nearest = nullptr;
  double least = radians(1.0);
  for (const Arrival& a : arrivals) {
    if (a.surface_bounces != path.surface_bounces || a.bottom_bounces != path.bottom_bounces ||
        a.upper_turns != path.upper_turns || a.lower_turns != path.lower_turns)
      continue;
    const double difference = std::abs(a.launch_elevation - path.launch_elevation);
    if (difference < least) {
      least = difference;
      nearest = &a;
    }
  }
  return nearest;
}

class EchoFinder {
 public:
  EchoFinder(const EchoContext& context, int target)
      : context_(context),
        scenario_(context.scenario),
        array_(scenario_.arrays[static_cast<std::size_t>(context.array)]),
        array_track_(scenario_.platforms[static_cast<std::size_t>(array_.platform)].track),
        target_(scenario_.targets[static_cast<std::size_t>(target)]),
        index_(target) {}

  TargetEchoes find() {
    const Kinematics source = transmitter_at(scenario_, context_.transmitter, context_.ping_time);
    const Way out =
        way(source.position, 0.0, target_.track, Vec3::Zero(), Leg::Kind::source_to_target);
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
  /// Eigenrays from a point to where a track is at a time since the ping's start. \param known  the
  /// same paths when something was metres away; none: they are searched for
  Way way_at(const Vec3& from, const Track& track, const Vec3& offset, Leg::Kind kind, double time,
             std::span<const Arrival> known) const {
    Way way;
    way.end = Mover::on(track, offset, context_.ping_time, time);
    const Vec3& to = way.end.at_reference.position;
    const Separation s = separation(from, to);
    way.leg.kind = kind;
    way.leg.target = index_;
    way.leg.bearing = s.bearing;
    way.leg.range = s.range;
    const PathLimits limits = limits_of(scenario_.propagation);
    way.leg.arrivals = known.empty()
                           ? context_.paths.find(from, to, context_.frequency, limits)
                           : context_.paths.follow(known, from, to, context_.frequency, limits);
    return way;
  }

  /// The same to where the track is when the first of them comes.
  Way way(const Vec3& from, double start, const Track& track, const Vec3& offset, Leg::Kind kind,
          std::span<const Arrival> known = {}) const {
    Way way = way_at(from, track, offset, kind, start, known);
    for (int i = 0; i < 4 && !way.leg.arrivals.empty(); ++i) {  // each round gains a factor v/c
      const double time = start + way.leg.arrivals.front().delay;
      if (std::abs(time - way.end.reference_time) < 1e-9) break;
      const Mover then = Mover::on(track, offset, context_.ping_time, time);
      if (then.at_reference.position == way.end.at_reference.position) {
        way.end = then;
        break;
      }
      // The first step is the long one, all that the end does during a one-way travel time.
      const Arrivals before = i == 0 && known.empty() ? Arrivals{} : std::move(way.leg.arrivals);
      way = way_at(from, track, offset, kind, time, before);
    }
    return way;
  }

  /// When a path that starts at `start` reaches the end of its way, which has moved since the
  /// reference time: t = start + τ + s·v(t − t_ref).
  static double arrival_time(const Way& way, double start, const Arrival& path,
                             const Vec3& slowness) {
    const double along = slowness.dot(way.end.at_reference.velocity);
    return (start + path.delay - along * way.end.reference_time) / (1.0 - along);
  }

  /// The linear step neglects the curvature of τ, d²/(2rc) for a displacement d: less than 0.1 µs?
  /// Over slopes it also neglects that the plane turns with the end, a slowness across the plane of
  /// the order of the slope times sin θ/c: a millimetre of displacement is less than 0.1 µs.
  [[nodiscard]] bool settled_enough(double moved, double c, double range) const {
    if (!context_.paths.layered()) return moved <= 1e-3;
    return moved * moved <= 1e-7 * 2.0 * c * range;
  }

  /// One path to where the track is when *that path* arrives: found again there until the linear
  /// step is enough.
  struct Settled {
    Way way;
    Arrival path;
    double time;  ///< of arrival
  };
  Settled settle(const Vec3& from, double start, const Track& track, const Vec3& offset,
                 const Way& reference, const Arrival& path) const {
    Settled settled{reference, path, 0.0};
    for (int i = 0; i < 4; ++i) {
      const double c = context_.paths.speed_at(settled.way.end.at_reference.position);
      settled.time =
          arrival_time(settled.way, start, settled.path,
                       slowness_vector(settled.way.leg.bearing, settled.path.arrival_elevation, c));
      const Mover then = Mover::on(track, offset, context_.ping_time, settled.time);
      const double moved =
          (then.at_reference.position - settled.way.end.at_reference.position).norm();
      if (settled_enough(moved, c, std::max(settled.way.leg.range, moved))) break;
      Way again = way_at(from, track, offset, reference.leg.kind, settled.time,
                         std::span(&settled.path, 1));
      const Arrival* same = same_path(again.leg.arrivals, settled.path);
      if (same == nullptr) break;
      settled.path = *same;
      settled.way = std::move(again);
    }
    return settled;
  }

  void pair_up(const Kinematics& source, const Way& out, int channel, TargetEchoes& result) const {
    const Vec3 offset =
        array_.offset +
        (channel < 0 ? Vec3::Zero() : array_.phones[static_cast<std::size_t>(channel)]);
    Way back = way(out.end.at_reference.position, out.end.reference_time, array_track_, offset,
                   Leg::Kind::target_to_array);
    back.leg.channel = channel;
    back.leg.array = context_.array;
    for (std::size_t i = 0; i < out.leg.arrivals.size(); ++i) {
      const Settled there =
          settle(source.position, 0.0, target_.track, Vec3::Zero(), out, out.leg.arrivals[i]);
      const Kinematics struck = target_.track.at(context_.ping_time + there.time);
      const bool moved = struck.position != out.end.at_reference.position;
      const Way home = moved ? way(struck.position, there.time, array_track_, offset,
                                   Leg::Kind::target_to_array, back.leg.arrivals)
                             : back;
      for (std::size_t j = 0; j < back.leg.arrivals.size(); ++j) {
        const Arrival* path =
            moved ? same_path(home.leg.arrivals, back.leg.arrivals[j]) : &back.leg.arrivals[j];
        if (path == nullptr) continue;  // by then it is gone
        EchoPath echo =
            pair(source, there, struck,
                 settle(struck.position, there.time, array_track_, offset, home, *path));
        echo.outgoing = static_cast<int>(i);
        echo.returning = static_cast<int>(j);
        echo.heard.channel = channel < 0 ? Return::all_channels : channel;
        result.echoes.push_back(echo);
      }
    }
    result.legs.push_back(std::move(back.leg));
  }

  EchoPath pair(const Kinematics& source, const Settled& there, const Kinematics& target,
                const Settled& home) const {
    const Kinematics& phone = home.way.end.at_reference;
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
};

}  // namespace

TargetEchoes target_echoes(const EchoContext& context, int target) {
  return EchoFinder(context, target).find();
}

}  // namespace asdic
