#include <algorithm>
#include <cmath>

#include "core/mixed_bits.h"
#include "reverb/fields/ground_spacing.h"
#include "reverb/power/reverberation_streams.h"
#include "sonar/paths/enough_bounces.h"
#include "sonar/paths/receiver_legs.h"
#include "sonar/reverberation/reverberation.h"
#include "sonar/reverberation/reverberation_covariance.h"
#include "sonar/scenario/carried.h"
#include "sonar/scenario/ping_bounds.h"
#include "sonar/signal/pulse_coherence.h"

namespace asdic::detail {
namespace {

/// The law of a boundary out of the scenario's shorter lists.
template <class... Model>
ScatteringSheet::Law law_of(const std::variant<Model...>& law) {
  return std::visit([](const auto& model) { return ScatteringSheet::Law(model); }, law);
}

/// Source and receiver of one ping, with the ways that they take while it is sent and received.
SheetEnds ends_of(const ReverberationContext& context) {
  const PingGeometry& geometry = context.geometry;
  const Carried receiver_point =
      context.point ? *context.point
                    : geometry.reverberation_point(context.array, context.pulse.centre_frequency());
  const double duration = context.pulse.duration();
  SheetEnds ends = {
      .source = sent_from(geometry.sender().track, geometry.time(), duration),
      .receiver = receiver_point.at(geometry.time()),
      .legs = receiver_legs(receiver_point.track, geometry.time(), context.latest, duration),
      .frequency = context.pulse.centre_frequency(),
      .latest = context.latest,
      .band = context.band};
  ends.source.position += geometry.sender().offset;
  for (ReceiverLeg& leg : ends.legs) leg.line.position += receiver_point.offset;
  // Who moves so little in a record that no phase changes by a twentieth of a radian is at rest.
  constexpr double still = 0.05;  // [rad]
  const double fastest = ends.source.velocity.norm() + ends.receiver.velocity.norm();
  if (ends.legs.empty() && 2.0 * pi * ends.frequency * fastest * ends.latest / slowest_sea < still)
    ends.source.velocity = ends.receiver.velocity = Vec3::Zero();
  return ends;
}

/// Puts the source above the origin, the receiver beside it as it was.
void move_to_source(SheetEnds& ends) {
  const auto tidy = [](double metres) { return 1e-6 * std::round(1e6 * metres); };  // of rounding
  Vec3& receiver = ends.receiver.position;
  receiver.x() = tidy(receiver.x() - ends.source.position.x());
  receiver.y() = tidy(receiver.y() - ends.source.position.y());
  ends.source.position.head<2>().setZero();
}

/// How far the receiver gets from where it is at the ping's start [m].
double way_of_receiver(const SheetEnds& ends) {
  if (ends.legs.empty()) return ends.receiver.velocity.norm() * ends.latest;
  double furthest = (ends.receiver_at(ends.latest) - ends.receiver.position).norm();
  for (const ReceiverLeg& leg : ends.legs)  // straight between its turns
    furthest = std::max(furthest, (ends.receiver_at(leg.until) - ends.receiver.position).norm());
  return furthest;
}

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

}  // namespace

double speed_at_surface(const Scenario& scenario, const PropagationPaths& paths) {
  Vec3 place = scenario.platforms[0].track.at(0.0).position;
  place.z() = paths.surface_depth(place);
  return paths.speed_at(place);
}

ReverberationModel::ReverberationModel(const Scenario& scenario, const PropagationPaths& paths,
                                       const Pulse& widest)
    : scenario_(scenario),
      paths_(paths),
      fans_(paths),
      spacing_(asdic::detail::ground_spacing(scenario.reverberation, scenario.environment,
                                             widest.bandwidth_99(),
                                             speed_at_surface(scenario, paths))),
      fastest_water_(asdic::detail::fastest_water(scenario.environment)),
      resolved_sectors_(scenario.reverberation.resolve_azimuth
                            ? resolved_sectors(scenario, speed_at_surface(scenario, paths))
                            : 1) {}

int ReverberationModel::sectors(double reach) const {
  const ReverberationSettings& settings = scenario_.reverberation;
  const double cells = reach / spacing_ * settings.scatterers_per_cell;
  const double most = 2.0 * static_cast<double>(settings.most_returns) / std::max(1.0, cells);
  const double wanted = std::min(static_cast<double>(resolved_sectors_), std::floor(most));
  return std::max(settings.azimuths, static_cast<int>(wanted));
}

std::vector<ReverberationModel::Part> ReverberationModel::parts() const {
  const ReverberationSettings& settings = scenario_.reverberation;
  std::vector<Part> found;
  if (!settings.enabled) return found;
  if (settings.surface_scatters) {
    AnySurfaceScattering law = settings.surface;
    set_sea(law, scenario_.wind_speed, speed_at_surface(scenario_, paths_));
    found.push_back({BoundaryKind::surface, law_of(law), settings.surface_field,
                     Draw::surface_weight, std::uint64_t{0}});
  }
  if (settings.bottom)
    found.push_back({BoundaryKind::bottom, law_of(*settings.bottom), settings.bottom_field,
                     Draw::bottom_weight, std::uint64_t{1}});
  std::uint64_t id = 2;
  for (const VolumeLayer& layer : settings.volume) {
    const double height = layer.bottom - layer.top;
    const int sheets =
        layer.sheets.value_or(std::max(1, static_cast<int>(std::ceil(height / 50.0))));
    const double thickness = height / sheets;
    for (int i = 0; i < sheets; ++i)
      found.push_back({GroundLevel(layer.top + (i + 0.5) * thickness),
                       VolumeSheet{layer.strength_db, thickness}, layer.field, Draw::volume_weight,
                       id++, thickness});
  }
  return found;
}

namespace {

/// A sheet through the very depth of a platform has no paths but along it: moved aside.
GroundLevel off(const GroundLevel& level, double thickness, double depth) {
  const double aside = 0.1 * thickness;
  if (level.boundary || std::abs(level.depth - depth) >= 0.5 * aside) return level;
  return GroundLevel(depth + (level.depth < depth ? -aside : aside));
}

}  // namespace

bool ReverberationModel::forgets_places(const Part& part,
                                        const ReverberationContext& context) const {
  const ScattererStatistics& statistics = part.field.statistics;
  return paths_.layered() && context.drifts && !context.point && scenario_.arrays.size() == 1 &&
         scenario_.reverberation.synthesis != ScattererSynthesis::scatterers &&
         statistics.coherence_time == 0.0 && !statistics.k_shape;
}

bool ReverberationModel::seas_compared(const ScattererField& field) const {
  return field.statistics.coherence_time > 0.0 ||
         std::any_of(scenario_.arrays.begin(), scenario_.arrays.end(),
                     [&](const ReceiverArray& array) {
                       return array.platform != scenario_.arrays.front().platform;
                     });
}

double ReverberationModel::wide_cells(const Pulse& pulse) noexcept {
  // A quarter of what sound runs in a sixteenth of a pulse: as far apart as circles of places are.
  constexpr double longest = 0.1;  // [s]
  return 0.25 * slowest_sea * std::min(pulse.duration() / 16.0, longest);
}

void ReverberationModel::meet(Part part, const ReverberationContext& context, Ground ground,
                              std::vector<ScatteringField>& fields) const {
  const ReverberationSettings& settings = scenario_.reverberation;
  // Who receives one ping cannot tell weights that last from those that do not.
  if (context.received_once && settings.synthesis != ScattererSynthesis::scatterers &&
      !part.field.statistics.k_shape)
    part.field.statistics.coherence_time = 0.0;
  const ScattererField& field = part.field;
  SheetEnds ends = ends_of(context);

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

  BoundaryFans::Settings fan = {
      .sectors = settings.azimuths,
      .spacing = spacing_,
      .wide = ground == Ground::means && paths_.layered() ? wide_cells(context.pulse) : 0.0,
      // in steps, so that a slow drift finds what is kept
      .max_range = reach + spacing_ + 500.0 * std::ceil(apart / 1000.0),
      .frequency = ends.frequency,
      .limits = {}};
  ends.source_speed = paths_.speed_at(ends.source.position);
  ends.receiver_speed = paths_.speed_at(ends.receiver.position);
  part.level = off(off(part.level, part.thickness, ends.source.position.z()), part.thickness,
                   ends.receiver.position.z());
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
  const Bounces followed = enough(part, ends, fan, context);
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
    if (context.reuse != nullptr && !known) context.reuse->reverberation = false;
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
  // For parts of an array that of all its phones: they are to receive the same scatterers.
  const auto farthest_phone = [&](const Vec2& place) {
    if (!context.point) return (receiver - place).norm();
    const Vec2 reference = context.geometry.reference_place(context.array).position.head<2>();
    double farthest = 0.0;
    for (const Vec3& x : context.geometry.phones(context.array))
      farthest = std::max(farthest, (reference + x.head<2>() - place).norm());
    return farthest;
  };
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
         .bearings = settings.azimuths,
         // Who lies this far off an end is nearer to it than half its range only within:
         .divided_below =
             2.0 * std::max((source - anchor.place).norm(), farthest_phone(anchor.place)),
         .bounces = followed,
         .share = anchor.share});
  }
}

std::vector<ScatteringSheet::Law> ReverberationModel::laws() const {
  std::vector<ScatteringSheet::Law> found;
  for (const Part& part : parts()) found.push_back(part.law);
  return found;
}

/// Out of the paths' memory if everything that it depends on is as it was once.
std::shared_ptr<const ExpectedReverberation> ReverberationModel::expected(
    std::span<const ScatteringField> fields, const ReverberationContext& context) const {
  const double duration = context.pulse.duration();
  const auto key = ExpectedReverberation::key(fields, duration);
  const auto make = [&] {
    if (context.reuse != nullptr) context.reuse->expected_level = false;
    if (context.budget != nullptr)
      context.budget->take(ExpectedReverberation::need(fields, duration));
    return std::make_shared<ExpectedReverberation>(fields, duration);
  };
  return key ? paths_.memory().remember(*key, make) : make();
}

namespace {

constexpr double many = 20'000.0;  // returns: fewer are gridded as soon

/// Whether a ping may be received as streams where they serve.
bool may_stream(const Scenario& scenario, const ReverberationContext& context) noexcept {
  const ScattererSynthesis how = scenario.reverberation.synthesis;
  return how != ScattererSynthesis::scatterers && how != ScattererSynthesis::covariance &&
         !context.phones.empty() && scenario.arrays.size() == 1;
}

/// Where phones are, of all shapes that an array has: some of them, evenly.
std::vector<Vec3> places_of(std::span<const std::vector<Vec3>> shapes,
                            std::span<const Vec3> phones) {
  if (shapes.empty()) return {phones.begin(), phones.end()};
  constexpr std::size_t most = 64;
  std::vector<Vec3> all, some;
  for (const std::vector<Vec3>& shape : shapes) all.insert(all.end(), shape.begin(), shape.end());
  const std::size_t count = std::min(all.size(), std::max(most, shapes.front().size()));
  for (std::size_t i = 0; i < count; ++i) some.push_back(all[i * all.size() / count]);
  return some;
}

/// Who receives them.
ReverberationStreams::Listener stream_listener(const ReverberationContext& context) {
  // What an array of many shapes receives is sorted for all of them once.
  const std::vector<std::vector<Vec3>> now{{context.phones.begin(), context.phones.end()}};
  const auto& shapes = context.geometry.array(context.array).shapes;
  const double highest = context.pulse.centre_frequency() + 0.5 * context.pulse.bandwidth_99();
  return {.extents = ReverberationStreams::extents_of(shapes.empty() ? now : shapes, highest),
          .phones = context.phones.size(),
          .frequency = highest,
          .bandwidth = context.pulse.bandwidth_99(),
          .pulse_duration = context.pulse.duration(),
          .coherence = pulse_coherence(context.pulse),
          .places = places_of(shapes, context.phones),
          .latest = context.latest};
}

}  // namespace

/// Marks the fields that are received by their covariance: those that it serves, if they have many
/// returns. Two arrays that receive the same scatterers would have one covariance: not if there are
/// several. Out of the paths' memory if it is there.
std::shared_ptr<const ReverberationCovariance> ReverberationModel::covariance(
    std::span<ScatteringField> fields, const ExpectedReverberation& expected,
    const ReverberationContext& context) const {
  // Its work grows with their square, a second at so many.
  constexpr std::size_t most_components = 128;
  const ScattererSynthesis how = scenario_.reverberation.synthesis;
  if (how == ScattererSynthesis::scatterers || how == ScattererSynthesis::streams ||
      context.phones.empty() || scenario_.arrays.size() > 1)
    return nullptr;
  const BandNodes band = ReverberationCovariance::frequencies_for(
      context.phones, context.pulse.centre_frequency(), context.pulse.bandwidth_99());
  if (how == ScattererSynthesis::automatic &&
      (!context.plane_waves || band.frequencies.size() * context.phones.size() > most_components))
    return nullptr;
  std::vector<const ScatteringField*> served;
  for (std::size_t i = 0; i < fields.size(); ++i)
    if (ReverberationCovariance::serves(fields[i]) &&
        (how == ScattererSynthesis::covariance || expected.returns_of(i) > many)) {
      fields[i].received_by = ReceivedBy::covariance;
      served.push_back(&fields[i]);
    }
  if (served.empty()) return nullptr;
  const ReverberationCovariance::Listener listener = {.phones = context.phones,
                                                      .band = band,
                                                      .pulse_duration = context.pulse.duration(),
                                                      .coherence = pulse_coherence(context.pulse),
                                                      .latest = context.latest};
  auto key =
      ExpectedReverberation::key(fields, listener.pulse_duration, Kept::reverberation_covariance);
  const auto make = [&] {
    return std::make_shared<ReverberationCovariance>(served, expected.limits, listener);
  };
  if (!key) return make();
  key->add(listener.band.frequencies);
  key->add(listener.coherence->fingerprint());
  for (const ScatteringField& field : fields)
    key->add_all(static_cast<int>(field.received_by), field.thickness);
  for (const Vec3& phone : context.phones) key->add(phone);
  return paths_.memory().remember(*key, make);
}

/// Marks the fields that are received as streams: those that they serve, if they have many returns
/// and no covariance. Out of the paths' memory if they are there.
std::shared_ptr<const ReverberationStreams> ReverberationModel::streams(
    std::span<ScatteringField> fields, const ExpectedReverberation& expected,
    const ReverberationContext& context) const {
  if (!may_stream(scenario_, context)) return nullptr;
  const bool wherever = scenario_.reverberation.synthesis == ScattererSynthesis::streams;
  const ReverberationStreams::Listener listener = stream_listener(context);
  std::vector<const ScatteringField*> served;
  for (std::size_t i = 0; i < fields.size(); ++i)
    if (fields[i].received_by == ReceivedBy::scatterers &&
        ReverberationStreams::serves(fields[i]) &&
        (wherever || expected.returns_of(i) >
                         std::max(many, ReverberationStreams::worth(listener, fields[i])))) {
      fields[i].received_by = ReceivedBy::streams;
      served.push_back(&fields[i]);
    }
  if (served.empty()) return nullptr;
  auto key =
      ExpectedReverberation::key(fields, listener.pulse_duration, Kept::reverberation_streams);
  const auto make = [&] {
    if (context.budget != nullptr)
      context.budget->take(ReverberationStreams::need(served, listener));
    return std::make_shared<ReverberationStreams>(served, expected.limits, listener);
  };
  if (!key) return make();
  key->add(listener.frequency);
  key->add(listener.coherence->fingerprint());
  for (const ScatteringField& field : fields) {
    const ScattererMotion& motion = field.field.motion;
    key->add_all(static_cast<int>(field.received_by), field.thickness, field.boundary,
                 static_cast<int>(motion.kind), motion.receding_share, motion.current);
  }
  for (const Vec3& axis : listener.extents) key->add(axis);
  for (const Vec3& place : listener.places) key->add(place);
  return paths_.memory().remember(*key, make);
}

std::vector<ScatteringField> ReverberationModel::fields(const ReverberationContext& context,
                                                        Ground ground) const {
  std::vector<ScatteringField> found;
  for (Part& part : parts()) meet(std::move(part), context, ground, found);
  return found;
}

std::vector<ScatteringField> ReverberationModel::in_detail(
    std::vector<ScatteringField> received, const ReverberationContext& context) const {
  const auto one_by_one = [](const ScatteringField& field) {
    return field.received_by == ReceivedBy::scatterers;
  };
  if (context.level_alone || std::none_of(received.begin(), received.end(), one_by_one) ||
      !paths_.layered() || !(wide_cells(context.pulse) > spacing_))
    return received;
  std::vector<ScatteringField> fine = fields(context, Ground::scatterers), all;
  for (std::size_t i = 0; i < received.size(); ++i)
    all.push_back(std::move(one_by_one(received[i]) ? fine[i] : received[i]));
  return all;
}

Bounces ReverberationModel::bounces(const ReverberationContext& context) const {
  Bounces all;
  for (const ScatteringField& field : fields(context, Ground::means)) all.include(field.bounces);
  return all;
}

void ReverberationModel::take_memory(const ReverberationContext& context) const {
  const std::vector<ScatteringField> received = fields(context, Ground::means);
  if (received.empty()) return;
  context.budget->take(ExpectedReverberation::need(received, context.pulse.duration()));
  const bool forgets =
      std::all_of(received.begin(), received.end(),
                  [](const ScatteringField& field) { return ReverberationStreams::serves(field); });
  if (!forgets) static_cast<void>(in_detail(received, context));
  // How many returns there are, and so whether they are received as streams, is not known yet;
  // those that a covariance serves seldom are.
  if (!may_stream(scenario_, context)) return;
  const bool wherever = scenario_.reverberation.synthesis == ScattererSynthesis::streams;
  std::vector<const ScatteringField*> served;
  for (const ScatteringField& field : received)
    if (ReverberationStreams::serves(field) &&
        (wherever || !ReverberationCovariance::serves(field)))
      served.push_back(&field);
  if (!served.empty())
    context.budget->take(ReverberationStreams::need(served, stream_listener(context)));
}

PingReverberation ReverberationModel::ping(const ReverberationContext& context) const {
  std::vector<ScatteringField> received = fields(context, Ground::means);
  auto known = expected(received, context);
  auto by_covariance = covariance(received, *known, context);
  auto as_streams = streams(received, *known, context);
  return {scenario_,
          context,
          in_detail(std::move(received), context),
          std::move(known),
          std::move(by_covariance),
          std::move(as_streams)};
}

}  // namespace asdic::detail
