#include "sonar/echoes/echo.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <queue>
#include <tuple>
#include <utility>

#include "core/doppler.h"
#include "core/mixed_bits.h"
#include "core/propagation_memory.h"
#include "raytrace/parallel/stop.h"
#include "reverb/scattering/forward_scatter.h"
#include "sonar/echoes/leg_response.h"
#include "sonar/echoes/one_leg.h"
#include "sonar/echoes/outer_phones.h"
#include "sonar/echoes/target_response.h"
#include "sonar/paths/moving_paths.h"
#include "sonar/paths/plane_wave.h"
#include "sonar/paths/wave_moments.h"
#include "sonar/scenario/carried.h"
#include "sonar/scenario/sampling.h"

namespace asdic::detail {
namespace {

/// One path out and one path back, met where things are by then.
struct TwoWayPaths {
  Kinematics source, target;
  MetPath there, home;
};

double radius(std::span<const Vec3> places) {
  double furthest = 0.0;
  for (const Vec3& place : places) furthest = std::max(furthest, place.norm());
  return furthest;
}

class EchoFinder {
 public:
  EchoFinder(const EchoContext& context, int target)
      : context_(context),
        geometry_(context.geometry),
        scenario_(context.scenario()),
        draws_(scenario_.seed),
        phones_(geometry_.phones(context.array)),
        target_(scenario_.targets[static_cast<std::size_t>(target)]),
        index_(target),
        layered_(context.paths.layered()),
        latest_(end_of_record(scenario_)),
        bounces_(enough()),
        limits_(limits_of(scenario_.propagation, bounces_)),
        moving_(context.paths, limits_, context.frequency, geometry_.time(), 1e-7, context.reuse),
        closely_(context.paths, limits_, context.frequency, geometry_.time(), 1e-9, context.reuse) {
  }

  TargetEchoes find() {
    const Kinematics& source = geometry_.source();
    Way out = moving_.way(source.position, 0.0, target_.track, Vec3::Zero());
    out.leg.kind = Leg::Kind::source_to_target;
    out.leg.target = index_;
    TargetEchoes result;
    result.bounces = bounces_;
    result.legs.push_back(out.leg);
    if (out.leg.arrivals.empty()) return result;
    const bool exact = scenario_.propagation.exact_per_phone;
    Way home = way_back(out, exact ? 0 : -1);
    const std::size_t pairs = out.leg.arrivals.size() * home.leg.arrivals.size();
    const bool many = pairs > context_.most_pairs;
    if (many)
      result.many = in_two_steps(out.leg.arrivals, home.leg.arrivals,
                                 exact || (context_.listens && differs_at_phones(out, home)));
    else
      draw_scattering(out, home);
    for (std::size_t n = 0; n < (exact ? phones_.size() : 1); ++n) {
      if (n > 0) home = way_back(out, static_cast<int>(n));
      if (many) {
        list_loudest(source, out, home, result);
        shorten_bounces(home.leg.arrivals, exact ? phones_.size() : 1);
      } else {
        pair_up(source, out, home, result);
      }
      result.legs.push_back(std::move(home.leg));
    }
    if (many) {
      shorten_bounces(result.legs.front().arrivals);
      return result;
    }
    const bool plane = exact || !context_.listens || plane_waves(result);
    const bool own = !plane || (!exact && context_.listens &&
                                !alike_at_phones(out, result.legs.back(), home.end));
    const bool curved = std::any_of(result.echoes.begin(), result.echoes.end(),
                                    [](const EchoPath& echo) { return bool(echo.curve); });
    if (curved && pairs > context_.most_curved) {
      const ManyEchoes steps =
          in_two_steps(out.leg.arrivals, result.legs.back().arrivals, exact || own);
      if (steps.pairs == 0) return result;  // none is received in time
      result.scattered.clear();             // it is drawn leg by leg
      result.many = steps;
    } else if (own) {
      TargetEchoes at_phones;
      for (std::size_t n = 0; n < phones_.size(); ++n)
        pair_up(source, out, to_phone(out, static_cast<int>(n), result.legs.back(), plane),
                at_phones);
      result.at_phones = std::move(at_phones.echoes);
      result.scattered = std::move(at_phones.scattered);
    }
    return result;
  }

 private:
  /// Bounces for both legs, found for where everything is when the ping starts.
  Bounces enough() const {
    const Vec3& source = geometry_.source().position;
    const Vec3 target = geometry_.target_at(index_, 0.0).position;
    const Vec3& array = geometry_.reference_place(context_.array).position;
    const auto leg = [&](const Vec3& from, const Vec3& to) {
      return enough_bounces(context_.paths, scenario_.propagation, from, to, context_.frequency,
                            latest_);
    };
    const Bounces out = leg(source, target), back = leg(target, array);
    Bounces both = out;
    both.include(back);
    both.left_out_db = out.left_out_db + back.left_out_db;
    return both;
  }

  /// Whether all echoes are plane waves to the phones. \param found  at the reference point
  bool plane_waves(const TargetEchoes& found) const {
    const Arrivals& home = found.legs.back().arrivals;
    return std::all_of(found.echoes.begin(), found.echoes.end(), [&](const EchoPath& echo) {
      return is_plane_wave(context_, echo.received,
                           home[static_cast<std::size_t>(echo.returning)].path_length);
    });
  }

  /// \param home  paths to the reference point   \param end  place of that point
  [[nodiscard]] bool alike_at_phones(const Way& out, const Leg& home, const Kinematics& end) const {
    return is_alike_at_phones(context_, {home, end.position}, [&](int phone) -> ArrivedLeg {
      Way own = to_phone(out, phone, home, true);
      return {std::move(own.leg), own.end.position};
    });
  }

  /// Way back to a phone. Over slopes the rays of the reference point are followed to a phone that
  /// is `near`; amplitudes of waves are always computed there.   \param home  paths to the
  /// reference point
  [[nodiscard]] Way to_phone(const Way& out, int phone, const Leg& home, bool near) const {
    return way_back(out, phone,
                    near && !layered_ ? std::span(home.arrivals) : std::span<const Arrival>());
  }

  /// \param channel  phone that receives it; −1: the reference point
  [[nodiscard]] Carried receiver(int channel) const {
    return geometry_.receiver(context_.array, channel);
  }

  /// Place from the reference point of which a return tells, also where its path is a phone's own.
  [[nodiscard]] Vec3 from_reference(int channel) const {
    return channel < 0 ? Vec3(Vec3::Zero()) : phones_[static_cast<std::size_t>(channel)];
  }

  /// Way back from where the first sound strikes the target.   \param known  paths to a place
  /// nearby
  [[nodiscard]] Way way_back(const Way& out, int channel,
                             std::span<const Arrival> known = {}) const {
    const Carried receiver = this->receiver(channel);
    Way back =
        moving_.way(out.end.position, out.reference_time, receiver.track, receiver.offset, known);
    back.leg.kind = Leg::Kind::target_to_array;
    back.leg.target = index_;
    back.leg.channel = channel;
    back.leg.array = context_.array;
    return back;
  }

  /// A path out that has met the target.
  struct Strike {
    Kinematics source, target;
    MetPath there;
    std::optional<Way> home;  ///< where the target has moved since the way back was found
  };
  /// \param path  number of one of the way out   \param known  paths home, for where it moved to
  [[nodiscard]] Strike strike(const Kinematics& source, const Way& out, std::size_t path,
                              std::span<const Arrival> known, const Carried& receiver) const {
    Strike s{.source = source,
             .target = {},
             .there = moving_.meet(source.position, 0.0, target_.track, Vec3::Zero(), out,
                                   out.leg.arrivals[path]),
             .home = {}};
    s.target = geometry_.target_at(index_, s.there.time);
    if (s.target.position != out.end.position)
      s.home = moving_.way(s.target.position, s.there.time, receiver.track, receiver.offset, known);
    return s;
  }

  /// With one of the paths home; nothing if by then it is gone.
  [[nodiscard]] std::optional<TwoWayPaths> with_home(const Strike& strike, const Way& back,
                                                     std::size_t number,
                                                     const Carried& receiver) const {
    const Way& home = strike.home ? *strike.home : back;
    const Arrival& known = back.leg.arrivals[number];
    const Arrival* path = strike.home ? same_path(home.leg.arrivals, known, layered_) : &known;
    if (path == nullptr) return {};
    return TwoWayPaths{.source = strike.source,
                       .target = strike.target,
                       .there = strike.there,
                       .home = moving_.meet(strike.target.position, strike.there.time,
                                            receiver.track, receiver.offset, home, *path)};
  }

  void pair_up(const Kinematics& source, const Way& out, const Way& back, TargetEchoes& result) {
    const int channel = back.leg.channel;
    const Carried receiver = this->receiver(channel);
    const std::vector<RoughPath> rough_home = rough_paths(back.leg.arrivals, 2);
    const auto there = across_the_band(source.position, out),
               home = across_the_band(out.end.position, back);
    for (std::size_t i = 0; i < out.leg.arrivals.size(); ++i) {
      const Strike strike = this->strike(source, out, i, back.leg.arrivals, receiver);
      for (std::size_t j = 0; j < back.leg.arrivals.size(); ++j) {
        stop_point();
        const std::optional<TwoWayPaths> pair = with_home(strike, back, j, receiver);
        if (!pair || (bounces_.surface > fewest_bounces && pair->home.time > latest_)) continue;
        const std::size_t first = result.scattered.size();
        std::vector<EchoPath> echoes = answer(*pair, receiver, channel);
        scatter(*pair, echoes, rough_out_[i], rough_home[j], result.scattered);
        name(i, j, std::span(result.scattered).subspan(first));
        name(i, j, echoes);
        if (there != nullptr) {
          const std::vector legs = {path_on_leg(there, i, source.position, pair->there),
                                    path_on_leg(home, j, pair->target.position, pair->home)};
          for (EchoPath& echo : echoes) echo.legs = legs;
        }
        for (EchoPath& echo : echoes) result.echoes.push_back(std::move(echo));
      }
    }
  }

  /// Leg with the paths of a way, for other frequencies than the centre; null if these are not
  /// needed.
  [[nodiscard]] std::shared_ptr<const MetLeg> across_the_band(const Vec3& from,
                                                              const Way& way) const {
    if (!context_.listens || context_.pulse == nullptr ||
        scenario_.propagation.band == BandOfLosses::narrow)
      return nullptr;
    return std::make_shared<const MetLeg>(MetLeg{.from = from,
                                                 .to = way.end.position,
                                                 .paths = way.leg.arrivals,
                                                 .frequency = context_.frequency,
                                                 .limits = limits_});
  }

  /// By the numbers of their paths.
  static void name(std::size_t outgoing, std::size_t returning, std::span<EchoPath> echoes) {
    for (EchoPath& echo : echoes) {
      echo.outgoing = static_cast<int>(outgoing);
      echo.returning = static_cast<int>(returning);
    }
  }

  /// Whether what phones receive of the paths home is no plane wave about the reference point.
  [[nodiscard]] bool differs_at_phones(const Way& out, const Way& back) const {
    const double c = context_.paths.speed_at(back.end.position);
    const bool plane =
        std::all_of(back.leg.arrivals.begin(), back.leg.arrivals.end(), [&](const Arrival& path) {
          const Return received_there{
              .delay = out.leg.arrivals.front().delay + path.delay,
              .slowness = met_by(back.end.velocity, arriving_slowness(back.leg.bearing, path, c))};
          return is_plane_wave(context_, received_there, path.path_length);
        });
    return !plane || !alike_at_phones(out, back.leg, back.end);
  }

  /// \param at_phones  each phone has paths of its own
  [[nodiscard]] ManyEchoes in_two_steps(const Arrivals& there, const Arrivals& home,
                                        bool at_phones) const {
    ManyEchoes many{.target = index_, .array = context_.array, .followed = bounces_};
    std::size_t received = home.size();  // of the paths home, after one more of those there
    for (const Arrival& one : there) {
      while (received > 0 && one.delay + home[received - 1].delay > latest_) --received;
      many.pairs += received;
    }
    many.first = there.front().delay + home.front().delay;
    many.last = std::min(latest_, there.back().delay + home.back().delay);
    many.at_phones = at_phones;
    return many;
  }

  /// The loudest of too many pairs, at one of the receivers.
  void list_loudest(const Kinematics& source, const Way& out, const Way& back,
                    TargetEchoes& result) const {
    constexpr std::size_t most_listed = 1000;
    const std::size_t most =
        back.leg.channel < 0 ? most_listed : std::max<std::size_t>(1, most_listed / phones_.size());
    const Carried receiver = this->receiver(back.leg.channel);
    const auto there = across_the_band(source.position, out),
               home = across_the_band(out.end.position, back);
    for (const auto& [i, j] : loudest_pairs(out.leg, back.leg, most)) {
      stop_point();
      const Strike strike =
          this->strike(source, out, i, std::span(&back.leg.arrivals[j], 1), receiver);
      const std::optional<TwoWayPaths> pair = with_home(strike, back, j, receiver);
      if (!pair) continue;
      std::vector<EchoPath> echoes = answer(*pair, receiver, back.leg.channel);
      name(i, j, echoes);
      if (there != nullptr)
        for (EchoPath& echo : echoes) echo.legs = {{there, i}, {home, j}};
      for (EchoPath& echo : echoes) result.echoes.push_back(std::move(echo));
    }
  }

  /// The first pair and the loudest that are received in time, by the numbers of their paths.
  /// Loudest paths first on both legs, the best of every row of pairs is its first that is left.
  [[nodiscard]] std::vector<std::pair<std::size_t, std::size_t>> loudest_pairs(
      const Leg& out, const Leg& back, std::size_t most) const {
    const Arrivals &there = out.arrivals, &home = back.arrivals;
    const auto power = [](const Arrival& path) {
      return std::norm(path.amplitude) + path.scattered;
    };
    const auto ordered = [&](const Arrivals& paths, const auto& of) {
      std::vector<std::pair<double, std::size_t>> found;
      for (std::size_t i = 0; i < paths.size(); ++i) found.emplace_back(of(paths[i]), i);
      std::sort(found.begin(), found.end(), std::greater<>());
      return found;
    };
    const auto outward = ordered(there, [&](const Arrival& path) {
      return power(path) * std::norm(context_.pattern.towards(launch_bearing(path, out.bearing),
                                                              path.launch_elevation));
    });
    const auto homeward = ordered(home, power);
    using Best = std::tuple<double, std::size_t, std::size_t>;  // power; row, place in it
    std::priority_queue<Best> best;
    for (std::size_t row = 0; row < outward.size(); ++row)
      best.emplace(outward[row].first * homeward[0].first, row, 0);
    std::vector<std::pair<std::size_t, std::size_t>> found = {{0, 0}};
    for (std::size_t looked = 0; !best.empty() && found.size() < most && looked < 32 * most;
         ++looked) {
      const auto [loud, row, place] = best.top();
      best.pop();
      const std::size_t i = outward[row].second, j = homeward[place].second;
      if (there[i].delay + home[j].delay <= latest_ && i + j > 0) found.emplace_back(i, j);
      if (place + 1 < homeward.size())
        best.emplace(outward[row].first * homeward[place + 1].first, row, place + 1);
    }
    std::sort(found.begin(), found.end());
    return found;
  }

  /// Draws the scattering of the outgoing paths by rough boundaries, once for all phones, and
  /// chooses the number of parts.
  void draw_scattering(const Way& out, const Way& back) {
    constexpr std::size_t most = 4096;  // of a target
    const std::size_t pairs = out.leg.arrivals.size() * back.leg.arrivals.size();
    parts_ =
        static_cast<int>(std::clamp<std::size_t>(most / std::max<std::size_t>(pairs, 1), 2, 16));
    rough_out_ = rough_paths(out.leg.arrivals, 1);
  }

  /// \param leg  1: outgoing; 2: returning
  [[nodiscard]] std::vector<RoughPath> rough_paths(const Arrivals& paths, std::uint64_t leg) {
    std::vector<RoughPath> found;
    for (const Arrival& path : paths)
      found.push_back(rough_path(scenario_.environment, path, context_.frequency, parts_, draws_,
                                 mixed(mixed(entity(), leg), scatter_history(path))));
    return found;
  }

  /// A number that names the transmitter and the target.
  [[nodiscard]] std::uint64_t entity() const {
    return mixed(static_cast<std::uint64_t>(geometry_.sent().transmitter),
                 target_identity(scenario_, index_));
  }

  /// What rough boundaries scatter about a pair of paths. \param echoes  of the pair's own
  void scatter(const TwoWayPaths& pair, std::span<const EchoPath> echoes,
               const RoughPath& rough_out, const RoughPath& rough_home,
               std::vector<EchoPath>& found) const {
    const Arrival &there = pair.there.path, &home = pair.home.path;
    const double mean = std::norm(there.amplitude * home.amplitude);
    const double scattered = intensity(pair) - mean;
    if (!(scattered > 1e-9 * mean)) return;
    const auto place = [](const Kinematics& end) { return Vec2(end.position.head<2>()); };
    const ScatteredLeg legs[] = {
        {&rough_out, place(pair.source), pair.there.way.leg.bearing, geometry_.time()},
        {&rough_home, place(pair.target), pair.home.way.leg.bearing,
         geometry_.time() + pair.there.time}};
    const std::uint64_t name =
        mixed(mixed(entity(), scatter_history(there)), scatter_history(home));
    const double c = context_.paths.speed_at(pair.home.way.end.position);
    const double pressure = std::sqrt(scattered);
    for (const EchoPath& echo : echoes) {
      const Vec3 x = from_reference(echo.received.channel);
      // what the glint itself sends back, and the transmitter to there
      const std::complex<double> of_glint = echo.glint,
                                 pattern = context_.pattern.towards(echo.response.bearing,
                                                                    echo.response.elevation);
      for (const ScatteredPart& part : forward_scatter(
               scenario_.environment, legs, context_.frequency, parts_, scenario_.seed, name)) {
        EchoPath one = echo;
        one.curve.reset();
        one.received.doppler *= 1.0 + part.shift / context_.frequency;
        one.received.slowness =
            met_by(pair.home.way.end.velocity,
                   slowness_vector(arrival_bearing(home, pair.home.way.leg.bearing) + part.bearing,
                                   home.arrival_elevation + part.elevation, c));
        one.received.delay += part.delay + (echo.received.slowness - one.received.slowness).dot(x);
        one.response.without_pattern = pressure * part.amplitude * of_glint;
        one.received.amplitude = one.response.without_pattern * pattern;
        one.level_db = source_level_db() + db_from_amplitude(std::abs(one.received.amplitude));
        found.push_back(std::move(one));
      }
    }
  }

  /// Of a pair of paths in the mean: the mean fields' and what is scattered about them.
  static double intensity(const TwoWayPaths& pair) {
    const Arrival &there = pair.there.path, &home = pair.home.path;
    return (std::norm(there.amplitude) + there.scattered) *
           (std::norm(home.amplitude) + home.scattered);
  }

  [[nodiscard]] double source_level_db() const { return geometry_.transmitter().source_level_db; }

  /// Slownesses at the four ends of a pair.
  struct Slownesses {
    Vec3 at_source, into_target, out_of_target, at_phone;
  };
  Slownesses slownesses(const TwoWayPaths& pair) const {
    const auto speed = [&](const Kinematics& k) { return context_.paths.speed_at(k.position); };
    const double c_source = speed(pair.source), c_target = speed(pair.target),
                 c_phone = speed(pair.home.way.end);
    const double there = pair.there.way.leg.bearing, home = pair.home.way.leg.bearing;
    return {.at_source = leaving_slowness(there, pair.there.path, c_source),
            .into_target = arriving_slowness(there, pair.there.path, c_target),
            .out_of_target = leaving_slowness(home, pair.home.path, c_target),
            .at_phone = arriving_slowness(home, pair.home.path, c_phone)};
  }

  Vec3 lag_of(const TwoWayPaths& pair) const {
    const Slownesses s = slownesses(pair);
    return BodyLag{.into = s.into_target,
                   .out = s.out_of_target,
                   .at_phone = s.at_phone,
                   .body_velocity = pair.target.velocity,
                   .phone_velocity = pair.home.way.end.velocity}
        .per_offset();
  }

  /// What all glints of the target send back by one pair of paths.
  std::vector<EchoPath> answer(const TwoWayPaths& pair, const Carried& receiver,
                               int channel) const {
    const auto [at_source, into_target, out_of_target, at_phone] = slownesses(pair);
    const Vec3 lag = lag_of(pair);
    const Kinematics& phone = pair.home.way.end;
    EchoPath echo;
    echo.target = index_;
    echo.array = context_.array;
    echo.struck = pair.there.time;
    echo.received.channel = channel < 0 ? Return::all_channels : channel;
    echo.received.doppler =
        echo_doppler({pair.source.velocity, at_source}, {pair.target.velocity, into_target},
                     {pair.target.velocity, out_of_target}, {phone.velocity, at_phone});
    echo.received.slowness = met_by(phone.velocity, at_phone);
    const double bearing = launch_bearing(pair.there.path, pair.there.way.leg.bearing),
                 elevation = pair.there.path.launch_elevation;
    const std::complex<double> crossed = pair.there.path.amplitude * pair.home.path.amplitude;
    const std::complex<double> towards = context_.pattern.towards(bearing, elevation);
    const std::complex<double> carried = crossed * towards;
    echo.response = {.path_length = pair.there.path.path_length + pair.home.path.path_length,
                     .bearing = bearing,
                     .elevation = elevation};
    const std::vector<Glint> seen = glints(scenario_, index_, context_.look(), into_target,
                                           out_of_target, geometry_.time() + pair.there.time);
    const Vec3 x = from_reference(channel);
    const SeenAside seen_aside(at_phone, pair.home.path);
    std::vector<EchoPath> echoes;
    for (const Glint& glint : seen) {
      echo.highlight = glint.highlight;
      // A phone's own path has its own lag.
      const Vec3 aside = channel < 0 ? seen_aside.of(glint.offset) : Vec3(Vec3::Zero());
      echo.received.slowness = met_by(phone.velocity, at_phone + aside);
      echo.received.delay = pair.home.time + lag.dot(glint.offset) - echo.received.slowness.dot(x);
      echo.received.amplitude = carried * glint.amplitude;
      echo.response.without_pattern = crossed * glint.amplitude;
      echo.glint = glint.amplitude;
      echo.level_db = source_level_db() + db_from_amplitude(std::abs(echo.received.amplitude));
      if (const double all = intensity(pair); all > std::norm(crossed))
        echo.level_db = source_level_db() +
                        db_from_amplitude(std::sqrt(all) * std::abs(glint.amplitude * towards));
      echoes.push_back(echo);
    }
    bend(pair, receiver, channel, seen, echoes);
    return echoes;
  }

  /// Gives the echoes curves where the ranges change at changing rates during the pulse.
  void bend(const TwoWayPaths& pair, const Carried& receiver, int channel,
            const std::vector<Glint>& seen, std::vector<EchoPath>& echoes) const {
    if (context_.pulse == nullptr || echoes.empty()) return;
    const Pulse& pulse = *context_.pulse;
    double aperture = channel < 0 ? radius(phones_) : 0.0;
    for (const Glint& glint : seen) aperture = std::max(aperture, 2.0 * glint.offset.norm());
    const double highest = pulse.centre_frequency() + 0.5 * pulse.bandwidth_40db();
    const MovingPath path = follow(pair, receiver, highest);
    const Vec3 out = pair.target.velocity - pair.source.velocity,
               back = pair.home.way.end.velocity - pair.target.velocity;
    const double c = context_.paths.speed_at(pair.target.position);
    const double phase = curvature_phase(highest, pulse.duration(), out.norm(),
                                         pair.there.path.path_length, c, aperture) +
                         curvature_phase(highest, pulse.duration(), back.norm(),
                                         pair.home.path.path_length, c, aperture);
    const bool course_changes =
        !(path.source_course_changes.empty() && path.target_course_changes.empty() &&
          path.array_course_changes.empty());
    if (phase < negligible_phase && !course_changes) return;
    const std::vector<PulseMoment> moments = moments_of(path, pair, receiver);
    const SeenAside seen_aside(slownesses(pair).at_phone, pair.home.path);
    for (std::size_t i = 0; i < echoes.size(); ++i) {
      const Vec3 aside = channel < 0 ? seen_aside.of(seen[i].offset) : Vec3(Vec3::Zero());
      echoes[i].curve =
          delay_curve(moments, echoes[i].received, seen[i].offset, aside, highest, aperture);
    }
  }

  /// What was found for one pair of paths, and how many sets of eigenrays that asked for.
  struct Moments {
    std::vector<PulseMoment> along;
    int legs = 0;
  };

  /// pulse_moments(), out of what is kept for equal ways and paths.
  std::vector<PulseMoment> moments_of(const MovingPath& path, const TwoWayPaths& pair,
                                      const Carried& receiver) const {
    ExactKey key = context_.paths.key(Kept::pulse_moments, geometry_.time(), context_.frequency,
                                      path.pulse_duration, limits_, geometry_.sender(),
                                      target_.track, receiver, path.source_course_changes,
                                      path.target_course_changes, path.array_course_changes);
    add_path(key, pair.there.path);
    add_path(key, pair.home.path);
    Reuse* const reuse = context_.reuse;
    const auto legs = [&] { return reuse ? reuse->legs_reused + reuse->legs_searched : 0; };
    bool known = false;
    const auto found = context_.paths.memory().remember(
        key,
        [&] {
          const int before = legs();
          const bool by_waves = pair.there.path.kind == ArrivalKind::diffracted ||
                                pair.home.path.kind == ArrivalKind::diffracted;
          auto made = std::make_shared<Moments>(
              Moments{.along = by_waves ? wave_moments(path) : pulse_moments(path)});
          made->legs = legs() - before;
          return made;
        },
        [](const Moments& moments) { return moments.along.size() * sizeof(PulseMoment); }, &known);
    if (known && reuse != nullptr) reuse->legs_reused += found->legs;
    return found->along;
  }

  MovingPath follow(const TwoWayPaths& pair, const Carried& receiver, double highest) const {
    // Turns that the pulse can meet: it is nowhere longer than 1.5 T.
    const auto near = [&](std::vector<double> course_changes, double from) {
      std::erase_if(course_changes, [&](double change) {
        return change <= from || change >= from + 1.5 * context_.pulse->duration();
      });
      return course_changes;
    };
    return {
        .moment = [this, &pair, &receiver](double sent) { return moment(pair, receiver, sent); },
        .pulse_duration = context_.pulse->duration(),
        .frequency = highest,
        .source_course_changes =
            near(course_changes_of(geometry_.sender().track, geometry_.time()), 0.0),
        .target_course_changes =
            near(course_changes_of(target_.track, geometry_.time()), pair.there.time),
        .array_course_changes =
            near(course_changes_of(receiver.track, geometry_.time()), pair.home.time)};
  }

  /// The same pair of paths for what leaves `sent` after the leading edge.
  std::optional<PulseMoment> moment(const TwoWayPaths& pair, const Carried& receiver,
                                    double sent) const {
    TwoWayPaths then;
    then.source = geometry_.source_at(sent);
    const Way out = closely_.way(then.source.position, sent, target_.track, Vec3::Zero(),
                                 std::span(&pair.there.path, 1));
    const Arrival* path = same_path(out.leg.arrivals, pair.there.path, layered_);
    if (path == nullptr) return std::nullopt;
    then.there = closely_.meet(then.source.position, sent, target_.track, Vec3::Zero(), out, *path);
    then.target = geometry_.target_at(index_, then.there.time);
    const Way home = closely_.way(then.target.position, then.there.time, receiver.track,
                                  receiver.offset, std::span(&pair.home.path, 1));
    path = same_path(home.leg.arrivals, pair.home.path, layered_);
    if (path == nullptr) return std::nullopt;
    then.home = closely_.meet(then.target.position, then.there.time, receiver.track,
                              receiver.offset, home, *path);
    const Slownesses s = slownesses(then);
    return PulseMoment{.sent = sent,
                       .struck = then.there.time,
                       .received = then.home.time,
                       .lag = lag_of(then),
                       .at_array = met_by(then.home.way.end.velocity, s.at_phone)};
  }

  const EchoContext& context_;
  const PingGeometry& geometry_;
  const Scenario& scenario_;
  SeaDraws draws_;
  const std::vector<Vec3>& phones_;
  const Target& target_;
  int index_;
  bool layered_;
  double latest_;    // end of the record [s]
  Bounces bounces_;  // that are followed
  PathLimits limits_;
  MovingPaths moving_, closely_;      // closely_: follows delays within a pulse
  int parts_ = 1;                     // number of parts of a pair's scattered sound
  std::vector<RoughPath> rough_out_;  // of the outgoing paths
};

}  // namespace

bool is_plane_wave(const EchoContext& context, const Return& received, double length) {
  Front front{.slowness = received.slowness,
              .length = length,
              .delay = received.delay,
              .highest_frequency = context.frequency};
  if (const Pulse* pulse = context.pulse; pulse != nullptr) {
    front.duration = pulse->duration() / received.doppler;
    front.highest_frequency = pulse->centre_frequency() + 0.5 * pulse->bandwidth_40db();
  }
  return is_plane_wave(listening(context.geometry, context.array), front);
}

TargetEchoes target_echoes(const EchoContext& context, int target) {
  return EchoFinder(context, target).find();
}

}  // namespace asdic::detail
