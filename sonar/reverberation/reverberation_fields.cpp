#include "sonar/reverberation/reverberation_fields.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/mixed_bits.h"
#include "reverb/fields/ground_spacing.h"
#include "sonar/paths/enough_bounces.h"
#include "sonar/reverberation/reverberation_bounces.h"
#include "sonar/reverberation/reverberation_ends.h"
#include "sonar/scenario/ping_bounds.h"
#include "sonar/scenario/sampling.h"

namespace asdic::detail {
namespace {

/// Sectors so narrow that no array nor its Doppler resolves them: λ/(2L) for a length L, and 1/T
/// of Doppler, 2v/λ·Δφ, for a platform's speed v. The same for every array and every ping: they
/// receive the same scatterers.
int resolved_sectors(const Scenario& scenario, double sound_speed) {
  double length = 0.0, speed = 0.0;
  for (const ReceiverArray& array : scenario.arrays)
    for (const Vec3& phone : array.phones)
      length = std::max(length, 2.0 * (phone - array.phones.front()).head<2>().norm());
  for (const Platform& platform : scenario.platforms)
    speed = std::max(speed, fastest(platform.track));
  double sectors = 0.0;
  for (std::size_t i = 0; i < scenario.transmitters.size(); ++i) {
    const Pulse pulse(pulse_of(scenario, static_cast<int>(i)));
    const double wavenumber = 2.0 * pi * pulse.centre_frequency() / sound_speed;
    sectors = std::max({sectors, wavenumber * length, wavenumber * 2.0 * speed * pulse.duration()});
  }
  constexpr double most = 3600.0;
  return static_cast<int>(std::ceil(std::min(most, sectors)));
}

/// How far scatterers go in a pulse [m]: a Bragg wave as fast as one of half the sound's length.
double way_of_scatterers(const ScattererMotion& motion, double wavenumber, double duration) {
  constexpr double gravity = 9.81;
  double speed = motion.current.norm();
  if (motion.kind == ScattererMotion::Kind::spread) speed += 2.0 * motion.speed_rms;
  if (motion.kind == ScattererMotion::Kind::bragg)
    speed += 0.5 * std::sqrt(gravity / (2.0 * wavenumber));
  return speed * duration;
}

/// Which paths of a leg are received as one.
struct Resolutions {
  PathResolution out, back;
};

/// \param fan  which cells \param means  over a piece of ground or of a layer, of that thickness
Resolutions resolutions(const ReverberationContext& context, const SheetEnds& ends,
                        const ScattererMotion& motion, const BoundaryFans::Settings& fan,
                        bool means, double thickness) {
  // The band's edges turn by π/8 in an eighth of what it resolves.
  constexpr double share = 1.0 / 8.0;
  const double duration = context.pulse.duration();
  const double own =
      way_of_scatterers(motion, 2.0 * pi * ends.frequency / ends.source_speed, duration);
  PathResolution both{.delay = share / context.pulse.bandwidth_99(),
                      .level = own,
                      .level_of_range = means ? 1.0 / 256.0 : 0.0,
                      .depth = 0.0,
                      .thickness = (means ? thickness : 0.0) + own};
  if (means) both.level += std::max(fan.wide, fan.spacing);
  Resolutions found{both, both};
  const auto add_way = [&](PathResolution& leg, const Vec3& velocity) {
    leg.level += velocity.head<2>().norm() * duration;
    leg.depth += std::abs(velocity.z()) * duration;
  };
  add_way(found.out, ends.source.velocity);
  Vec3 fastest = ends.receiver.velocity.cwiseAbs();
  for (const ReceiverLeg& leg : ends.legs) fastest = fastest.cwiseMax(leg.line.velocity.cwiseAbs());
  add_way(found.back, fastest);
  // Of all shapes that an array takes, and in steps, so that one that bends finds what is kept.
  const auto in_steps = [](double metres) {
    return metres > 0.0 ? std::exp2(std::ceil(std::log2(metres))) : 0.0;
  };
  double level = 0.0, depth = 0.0;
  const auto reach = [&](std::span<const Vec3> phones) {
    for (const Vec3& phone : phones) {
      level = std::max(level, phone.head<2>().norm());
      depth = std::max(depth, std::abs(phone.z()));
    }
  };
  reach(context.geometry.phones(context.array));
  for (const auto& shape : context.geometry.array(context.array).shapes) reach(shape);
  found.back.level += in_steps(level);
  found.back.depth += in_steps(depth);
  return found;
}

/// Pairs of paths to the scatterers of a grid all round, audible or not.
/// \param scatterers  per metre of range, all round
double pairs_of_paths(const BoundaryFan& fan, const FanGroups& out, const FanGroups& back,
                      double scatterers) {
  const auto followed = [](const FanGroups& groups, std::size_t plane, std::size_t cell) {
    const GroupedPaths& of = groups.planes[std::min(plane, groups.planes.size() - 1)];
    if (cell >= of.cells()) return 0.0;
    const std::size_t bundles = of.bundles(cell).size();
    return static_cast<double>(bundles > 0 ? bundles : of.groups(cell).size());
  };
  double pairs = 0.0;
  for (std::size_t plane = 0; plane < fan.planes.size(); ++plane) {
    const BoundaryPaths& paths = *fan.planes[plane].paths;
    for (std::size_t cell = 0; cell + 1 < paths.cells(); ++cell)
      pairs += (paths.range(cell + 1) - paths.range(cell)) * followed(out, plane, cell) *
               followed(back, plane, cell);
  }
  return scatterers * pairs / static_cast<double>(std::max<std::size_t>(1, fan.planes.size()));
}

}  // namespace

double speed_at_surface(const Scenario& scenario, const PropagationPaths& paths) {
  Vec3 place = scenario.platforms[0].track.at(0.0).position;
  place.z() = paths.surface_depth(place);
  return paths.speed_at(place);
}

namespace {

/// Depths of transmitters and arrays at a few of the pings, for the sheets of volume layers.
/// \param resolved  distance that the pulse resolves [m]
LayerEnds layer_ends(const Scenario& scenario, double resolved) {
  LayerEnds ends;
  if (scenario.reverberation.volume.empty()) return ends;
  constexpr std::size_t looked_at = 16, steps = 50;
  const std::vector<Transmission> sent = transmissions(scenario);
  const std::size_t step = (sent.size() + looked_at - 1) / looked_at;
  std::vector<double> lowest, highest;  // [transmitter and arrays]
  for (std::size_t i = 0; i < sent.size(); i += step) {
    const PingGeometry geometry(scenario, sent[i], static_cast<int>(i) + 1);
    std::vector<double> now{geometry.source().position.z()};
    for (std::size_t a = 0; a < scenario.arrays.size(); ++a)
      now.push_back(geometry.reference_place(static_cast<int>(a)).position.z());
    if (lowest.empty()) lowest = highest = now;
    for (std::size_t k = 0; k < now.size(); ++k) {
      lowest[k] = std::min(lowest[k], now[k]);
      highest[k] = std::max(highest[k], now[k]);
    }
    ends.depths.insert(ends.depths.end(), now.begin(), now.end());
  }
  // A glider's sheets need not be finest at every depth where it ever is.
  ends.finest = std::max(1.0, resolved);
  for (std::size_t k = 0; k < lowest.size(); ++k)
    ends.finest = std::max(ends.finest, (highest[k] - lowest[k]) / steps);
  std::sort(ends.depths.begin(), ends.depths.end());
  ends.depths.erase(std::unique(ends.depths.begin(), ends.depths.end()), ends.depths.end());
  return ends;
}

}  // namespace

ReverberationFields::ReverberationFields(const Scenario& scenario, const PropagationPaths& paths,
                                         const Pulse& widest)
    : scenario_(scenario),
      paths_(paths),
      fans_(paths),
      spacing_(asdic::detail::ground_spacing(scenario.reverberation, scenario.environment,
                                             widest.bandwidth_99(),
                                             speed_at_surface(scenario, paths))),
      fastest_water_(asdic::detail::fastest_water(scenario)),
      resolved_sectors_(scenario.reverberation.resolve_azimuth
                            ? resolved_sectors(scenario, speed_at_surface(scenario, paths))
                            : 1),
      ends_(layer_ends(scenario, 0.5 * speed_at_surface(scenario, paths) / widest.bandwidth_99())) {
  if (!scenario.area || !scenario.area->wind()) return;
  const double heard = 0.5 * fastest_water_ * end_of_record(scenario);
  const auto [least, most] =
      scenario.area->winds(scenario.platforms[0].track.at(0.0).position.head<2>(), heard + 20e3);
  for (int kind = wind_kind(least); kind <= wind_kind(most); ++kind) winds_.push_back(kind);
}

int ReverberationFields::sectors(double reach) const {
  const ReverberationSettings& settings = scenario_.reverberation;
  const double cells = reach / spacing_ * settings.scatterers_per_cell;
  const double most = 2.0 * static_cast<double>(settings.most_returns) / std::max(1.0, cells);
  const double wanted = std::min(static_cast<double>(resolved_sectors_), std::floor(most));
  return std::max(planes(reach), static_cast<int>(wanted));
}

int ReverberationFields::planes(double reach) const {
  const int least = scenario_.reverberation.azimuths;
  if (!scenario_.area) return least;
  // Two steps of the grid apart half way to where sound is still heard.
  const Vec3 place = scenario_.platforms[0].track.at(0.0).position;
  const double apart = 2.0 * scenario_.area->spacing(place.head<2>());
  constexpr double most = 72.0;
  return std::max(least, static_cast<int>(std::min(most, std::ceil(pi * reach / apart))));
}

std::vector<ScatteringPart> ReverberationFields::parts() const {
  return scattering_parts(scenario_.reverberation, scenario_.wind_speed,
                          speed_at_surface(scenario_, paths_), winds_, ends_);
}

bool ReverberationFields::forgets_places(const ScatteringPart& part,
                                         const ReverberationContext& context) const {
  const ScattererStatistics& statistics = part.field.statistics;
  return paths_.layered() && context.drifts && !context.point && scenario_.arrays.size() == 1 &&
         scenario_.reverberation.synthesis != ScattererSynthesis::scatterers &&
         statistics.coherence_time == 0.0 && !statistics.k_shape;
}

bool ReverberationFields::seas_compared(const ScattererField& field) const {
  return field.statistics.coherence_time > 0.0 ||
         std::any_of(scenario_.arrays.begin(), scenario_.arrays.end(),
                     [&](const ReceiverArray& array) {
                       return array.platform != scenario_.arrays.front().platform;
                     });
}

bool ReverberationFields::stays(const ScattererField& field) const {
  // Phases change by less than 0.02 rad in an hour up to 1 MHz.
  constexpr double next_to_nothing = 1e-9;  // [m/s]
  return field.statistics.coherence_time == infinity && !field.statistics.k_shape &&
         field.motion.current.isZero() && scenario_.arrays.size() == 1 &&
         std::all_of(
             scenario_.platforms.begin(), scenario_.platforms.end(),
             [](const Platform& platform) { return fastest(platform.track) <= next_to_nothing; });
}

bool ReverberationFields::left_behind(const ReverberationContext& context, const Vec2& middle,
                                      const Vec2& next) const {
  const ReverberationSettings& settings = scenario_.reverberation;
  return settings.synthesis == ScattererSynthesis::automatic && scenario_.arrays.size() == 1 &&
         context.band.empty() && (next - middle).norm() > spacing_;
}

double ReverberationFields::wide_cells(const Pulse& pulse, Ground ground,
                                       double reach) const noexcept {
  // Over an area no facet is narrower.
  constexpr double cells = 1000.0;
  if (scenario_.area) return reach / cells;
  return ground == Ground::means && paths_.layered() ? wide_cells(pulse) : 0.0;
}

double ReverberationFields::wide_cells(const Pulse& pulse) noexcept {
  // A quarter of what sound runs in a sixteenth of a pulse: as far apart as circles of places are.
  constexpr double longest = 0.1;  // [s]
  return 0.25 * slowest_sea * std::min(pulse.duration() / 16.0, longest);
}

void ReverberationFields::meet(ScatteringPart part, const ReverberationContext& context,
                               Ground ground, std::vector<ScatteringField>& fields) const {
  const ReverberationSettings& settings = scenario_.reverberation;
  // Who receives one ping cannot tell weights that last from those that do not.
  if (context.received_once && settings.synthesis != ScattererSynthesis::scatterers &&
      !part.field.statistics.k_shape)
    part.field.statistics.coherence_time = 0.0;
  const ScattererField& field = part.field;
  SheetEnds ends = ends_of(context);

  const bool lasts = field.statistics.coherence_time > 0.0;
  // Around points next to the middle of the two platforms, on a lattice through that of the first
  // two: pairs whose middles are near each other receive one sea.
  const auto middle = [&](int transmitter, int array, double time) -> Vec2 {
    const auto platform = [&](int i) -> Vec2 {
      return scenario_.platforms[static_cast<std::size_t>(i)].track.at(time).position.head<2>();
    };
    return 0.5 * (platform(scenario_.transmitters[static_cast<std::size_t>(transmitter)].platform) +
                  platform(scenario_.arrays[static_cast<std::size_t>(array)].platform));
  };
  const double reach = 0.5 * fastest_water_ * context.latest;  // the ellipse's half axis
  // A sea that nobody finds again lies around the source, so that it is the same for every ping.
  const bool around = forgets_places(part, context) && ends.legs.empty();
  if (around) move_to_source(ends);
  const std::vector<Anchor> anchors =
      around ? std::vector{Anchor{
                   .place = 0.5 * (ends.source.position + ends.receiver.position).head<2>(),
                   .identity = mixed(part.id, part.id)}}
             : anchors_of(middle(0, 0, 0.0),
                          middle(context.geometry.sent().transmitter, context.array,
                                 context.geometry.time()),
                          context.geometry.time(), field.motion.current, reach / 8.0, part.id,
                          seas_compared(field));
  const Vec2 source = ends.source.position.head<2>(), receiver = ends.receiver.position.head<2>();
  const double moved = way_of_receiver(ends);
  const double apart = (source - receiver).norm() + moved;

  BoundaryFans::Settings fan = {.sectors = planes(reach),
                                .spacing = spacing_,
                                .wide = wide_cells(context.pulse, ground, reach),
                                // in steps, so that a slow drift finds what is kept
                                .max_range = reach + spacing_ + 500.0 * std::ceil(apart / 1000.0),
                                .frequency = ends.frequency,
                                .limits = {},
                                .means = scenario_.area != nullptr};
  ends.source_speed = paths_.speed_at(ends.source.position);
  ends.receiver_speed = paths_.speed_at(ends.receiver.position);
  move_aside(part, ends.source.position.z());
  move_aside(part, ends.receiver.position.z());
  const auto depth = [&](const Vec3& place) {
    if (!part.level.boundary) return part.level.depth;
    return *part.level.boundary == BoundaryKind::surface ? paths_.surface_depth(place)
                                                         : paths_.bottom_depth(place);
  };
  // What comes home too late is not followed: from r away it takes (r − apart)/c at least.
  const double home_slowness = 0.999 / fastest_water_;
  const double max_delay = context.latest + home_slowness * 1000.0 * std::ceil(apart / 1000.0);
  fan.limits.max_delay = max_delay;
  fan.limits.home_slowness = home_slowness;
  const Bounces followed =
      reverberation_bounces(part, ends, fans_, fan, paths_.layered(), scenario_, context);
  fan.limits = limits_of(scenario_.propagation, followed);
  // A few bounces that were asked for by number are followed to whatever time: what comes too late
  // is not received, but moves the nodes of the synthesis by its Doppler.
  constexpr int a_few = 12;
  if (!in_numbers(scenario_.propagation) || std::max(followed.surface, followed.bottom) > a_few) {
    fan.limits.max_delay = max_delay;
    fan.limits.home_slowness = home_slowness;
  }
  constexpr double little = 1e6;  // [bytes] not worth a question
  const bool one_place = paths_.layered() && ends.source.position.z() == ends.receiver.position.z();
  if (const MemoryNeed a_fan = fans_.need(fan); context.budget != nullptr && a_fan.bytes > little)
    for (int fans = one_place ? 1 : 2; fans > 0; --fans) context.budget->take(a_fan);
  const auto fan_around = [&](const Vec3& place) {
    bool known = false;
    auto paths_to_level = fans_.around(place, part.level, fan, &known);
    if (context.reuse != nullptr) {
      context.reuse->count_planes(static_cast<int>(paths_to_level->planes.size()), known);
      if (!known) context.reuse->reverberation = false;
    }
    return paths_to_level;
  };
  const auto out = fan_around(ends.source.position), back = fan_around(ends.receiver.position);
  Resolutions alike =
      resolutions(context, ends, field.motion, fan, ground == Ground::means, part.thickness);
  if (out == back) alike.out = alike.back = alike.out.finer(alike.back);
  PropagationMemory& memory = paths_.memory();
  const ScatteringSheet::Groups groups{
      .out = FanGroups::of(*out, alike.out, ends.frequency, memory),
      .back = FanGroups::of(*back, alike.back, ends.frequency, memory)};
  // Of so many even the audible are more than are received one by one, and sectors know delays, not
  // places: who has gone on receives other sums of the same scatterers, as good as drawn anew.
  constexpr double inaudible = 4.0;
  const int transmitter = context.geometry.sent().transmitter;
  const double interval =
      context.geometry.transmitter().interval.value_or(scenario_.pings.interval);
  if (const double time = context.geometry.time();
      lasts && ground == Ground::means && !field.statistics.k_shape &&
      left_behind(context, middle(transmitter, context.array, time),
                  middle(transmitter, context.array, time + interval)) &&
      pairs_of_paths(*out, *groups.out, *groups.back,
                     static_cast<double>(sectors(reach)) * settings.scatterers_per_cell /
                         spacing_) > inaudible * static_cast<double>(settings.most_returns)) {
    meet_anew(std::move(part), context, ground, fields);
    return;
  }
  // For parts of an array that of all its phones: they are to receive the same scatterers.
  const auto farthest_phone = [&](const Vec2& place) {
    if (!context.point) return (receiver - place).norm();
    const Vec2 reference = context.geometry.reference_place(context.array).position.head<2>();
    double farthest = 0.0;
    for (const Vec3& x : context.geometry.phones(context.array))
      farthest = std::max(farthest, (reference + x.head<2>() - place).norm());
    return farthest;
  };
  // Streams are held to a closed form where phones are far nearer to the place that receives than
  // the ground is; a longer line receives what lasts in groups.
  constexpr double near = 0.1;
  const Vec3 reference = context.geometry.reference_place(context.array).position;
  double furthest = 0.0;  // [m]
  for (const Vec3& x : context.geometry.phones(context.array))
    furthest = std::max(furthest, (reference + x - ends.receiver.position).norm());
  const double height = std::abs(depth(ends.receiver.position) - ends.receiver.position.z());
  const bool streams_fit = context.plane_waves || furthest < near * height;
  for (const Anchor& anchor : anchors) {
    const double beside = (0.5 * (source + receiver) - anchor.place).norm() + 0.5 * moved;
    fields.push_back(
        {.sheet = ScatteringSheet(out, back, part.law, ends, context.pattern, groups),
         .grid = {.anchor = anchor.place,
                  .identity = anchor.identity,
                  .spacing = spacing_,
                  .azimuths = sectors(reach),
                  .per_cell = settings.scatterers_per_cell,
                  .first_bearing = paths_.layered() ? 0.0 : paths_.transect_bearing(),
                  .rings = static_cast<std::uint32_t>(std::ceil((reach + beside) / spacing_))},
         .field = field,
         .weights = part.weights,
         .boundary = part.id,
         .depth = depth(ends.source.position),
         .thickness = part.thickness,
         .bearings = fan.sectors,
         // Who lies this far off an end is nearer to it than half its range only within:
         .divided_below =
             2.0 * std::max((source - anchor.place).norm(), farthest_phone(anchor.place)),
         .bounces = followed,
         .stays = stays(field) && streams_fit,
         .share = anchor.share});
  }
}

void ReverberationFields::meet_anew(ScatteringPart part, const ReverberationContext& context,
                                    Ground ground, std::vector<ScatteringField>& fields) const {
  part.field.statistics.coherence_time = 0.0;
  const std::size_t first = fields.size();
  meet(std::move(part), context, ground, fields);
  for (std::size_t i = first; i < fields.size(); ++i) fields[i].drawn_anew = true;
}

std::vector<ScatteringField> ReverberationFields::of(const ReverberationContext& context,
                                                     Ground ground) const {
  std::vector<ScatteringField> found;
  for (ScatteringPart& part : parts()) meet(std::move(part), context, ground, found);
  return found;
}

std::vector<ScatteringField> ReverberationFields::in_detail(
    std::vector<ScatteringField> received, const ReverberationContext& context) const {
  const auto one_by_one = [](const ScatteringField& field) {
    return field.received_by == ReceivedBy::scatterers;
  };
  if (context.level_alone || std::none_of(received.begin(), received.end(), one_by_one) ||
      !paths_.layered() || !(wide_cells(context.pulse) > spacing_))
    return received;
  std::vector<ScatteringField> fine, all;
  for (ScatteringPart& part : parts()) {
    const bool anew = std::any_of(received.begin(), received.end(), [&](const auto& field) {
      return field.boundary == part.id && field.drawn_anew;
    });
    if (anew)
      meet_anew(std::move(part), context, Ground::scatterers, fine);
    else
      meet(std::move(part), context, Ground::scatterers, fine);
  }
  for (std::size_t i = 0; i < received.size(); ++i)
    all.push_back(std::move(one_by_one(received[i]) ? fine[i] : received[i]));
  return all;
}

}  // namespace asdic::detail
