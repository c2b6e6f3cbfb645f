#include "processing/coverage/coverage.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "core/geometry.h"
#include "core/text.h"
#include "processing/coverage/beam_bank.h"
#include "processing/coverage/bearing_reverberation.h"
#include "processing/coverage/echo_mean.h"
#include "processing/coverage/filter_weights.h"
#include "processing/coverage/plane_fans.h"
#include "processing/coverage/pulse_band.h"
#include "processing/detection_threshold.h"
#include "raytrace/parallel/parallel.h"
#include "raytrace/warnings/warnings.h"
#include "reverb/fields/scattering_field.h"
#include "reverb/fields/scattering_parts.h"
#include "sonar/noise/noise_in_guide.h"
#include "sonar/noise/noise_spectrum.h"
#include "sonar/paths/enough_bounces.h"
#include "sonar/reverberation/reverberation_bounces.h"
#include "sonar/reverberation/reverberation_ends.h"
#include "sonar/reverberation/reverberation_fields.h"
#include "sonar/scenario/ping_bounds.h"
#include "sonar/signal/pulse_coherence.h"
#include "sonar/warnings/warnings.h"

namespace asdic::detail {
namespace {

constexpr float unknown = std::numeric_limits<float>::quiet_NaN();

void require(bool holds, const char* where, const std::string& got, const std::string& expected) {
  if (!holds) throw InputError({.where = where, .got = got, .expected = expected});
}

/// Probability of detection over SNR in steps so small that it is straight between them.
class ProbabilityTable {
 public:
  ProbabilityTable(double false_alarm_probability, double cells, double shape) {
    values_.resize(static_cast<std::size_t>((high - low) / step) + 2);
    in_parallel(values_.size(), [&](std::size_t i) {
      values_[i] = detection_probability(power_from_db(low + static_cast<double>(i) * step),
                                         false_alarm_probability, cells, shape);
    });
  }
  [[nodiscard]] double operator()(double snr_db) const noexcept {
    const double at = (std::clamp(snr_db, low, high) - low) / step;
    const auto i = std::min(static_cast<std::size_t>(at), values_.size() - 2);
    return std::lerp(values_[i], values_[i + 1], at - static_cast<double>(i));
  }

 private:
  static constexpr double low = -40.0, high = 60.0, step = 0.1;  // [dB]
  std::vector<double> values_;
};

/// Until when the farthest cells answer [s].
double latest_echo(const PingSimulator& simulator, const CoverageSettings& settings, double apart,
                   double pulse) {
  // Paths that bounce steeply come later than along the horizontal by some per cent.
  constexpr double steeper = 1.05;
  return steeper * (2.0 * settings.reach + apart) /
             (0.97 * fastest_water(simulator.scenario().environment)) +
         pulse;
}

/// An odd part of a length that is no longer than some tens of metres.
double part_of(double length) {
  constexpr double longest = 50.0;  // [m]
  const double parts = std::ceil(length / longest);
  return length / (std::fmod(parts, 2.0) == 0.0 ? parts + 1.0 : parts);
}

/// Of what it is: surface, bottom, volume.
constexpr std::size_t kinds = 3;
std::size_t kind_of(const ScatteringPart& part) {
  if (!part.level.boundary) return 2;
  return *part.level.boundary == BoundaryKind::surface ? 0 : 1;
}

/// Velocities of source and array together, by which sound of what lies still is shifted [m/s].
Vec2 closing_of(const PingGeometry& geometry, int array) {
  return (geometry.source().velocity + geometry.reference_place(array).velocity).head<2>();
}

class Maker {
 public:
  Maker(const PingSimulator& simulator, const CoverageSettings& settings, const Progress& progress)
      : simulator_(simulator),
        scenario_(simulator.scenario()),
        settings_(settings),
        progress_(progress),
        paths_(simulator.paths()),
        geometry_(simulator.geometry(settings.ping)),
        pulse_(simulator.pulse(geometry_.sent().transmitter)),
        coherence_(pulse_coherence(pulse_)),
        projector_(simulator.transmitter(settings.ping)),
        pattern_(projector_, speed_at_source() / frequency(), speed_at_source(),
                 geometry_.source_heading()),
        phones_(geometry_.phones(settings.array)),
        step_(settings.reach / settings.ranges),
        spacing_(paths_.layered() ? part_of(step_) : step_),
        band_(pulse_),
        nodes_(phones_, paths_.speed_at(receiver()) / frequency(), closing().norm() / band_.half()),
        beams_(phones_, band_, frequency(), paths_.speed_at(receiver()), settings.bearings, nodes_,
               noise_field(scenario_, settings.array), closing()) {}

  Coverage make() {
    begin();
    find_bounces();
    make_fans();
    walk_bearings();
    look_through_beams();
    tell_limits();
    return std::move(made_);
  }

 private:
  [[nodiscard]] double frequency() const { return pulse_.centre_frequency(); }
  [[nodiscard]] double speed_at_source() const { return paths_.speed_at(source()); }
  [[nodiscard]] const Vec3& source() const { return geometry_.source().position; }
  [[nodiscard]] const Vec3& receiver() const {
    return geometry_.reference_place(settings_.array).position;
  }
  [[nodiscard]] Vec2 closing() const { return closing_of(geometry_, settings_.array); }
  [[nodiscard]] double apart() const { return (source() - receiver()).head<2>().norm(); }
  /// One plane serves both ends: they lie over one another, or the ocean is layered.
  [[nodiscard]] bool together() const { return apart() < 0.5 * step_; }
  /// Echoes by eigenrays and waves to every range, which all bearings share.
  [[nodiscard]] bool by_arrivals() const { return paths_.layered() && together(); }
  [[nodiscard]] std::size_t cells() const {
    return static_cast<std::size_t>(settings_.bearings) *
           static_cast<std::size_t>(settings_.ranges);
  }
  static constexpr double planes_share = 0.1;  // of the work: planes of all directions
  void tell(double share) const {
    if (progress_ && !progress_(share)) throw Interrupted();
  }

  void begin() {
    made_.settings = settings_;
    made_.transmitter = projector_.name;
    made_.array = geometry_.array(settings_.array).name;
    made_.time = geometry_.time();
    made_.frequency = frequency();
    made_.source = source();
    made_.receiver = receiver();
    made_.gain = matched_filter_gain(pulse_);
    const double shape = fluctuation_shape(settings_.fluctuation);
    made_.threshold_db = detection_threshold_db(settings_.false_alarm_probability,
                                                settings_.reference_cells, 0.5, shape);
    made_.source_level_db = projector_.source_level_db;
    for (int j = 0; j < settings_.bearings; ++j)
      made_.bearings.push_back(2.0 * pi * (j + 0.5) / settings_.bearings);
    for (int i = 0; i < settings_.ranges; ++i) made_.ranges.push_back((i + 0.5) * step_);
    made_.bottom_depth.assign(cells(), unknown);
    for (const double depth : settings_.depths) {
      CoverageLayer layer{.depth = depth};
      for (auto* values :
           {&layer.echo_db, &layer.two_way_loss_db, &layer.delay, &layer.reverberation_db,
            &layer.noise_db, &layer.signal_excess_db, &layer.detection_probability,
            &layer.uncertainty_db, &layer.reverberation_uncertainty_db})
        values->assign(cells(), unknown);
      layer.certainty.assign(cells(), std::int8_t(CoverageCertainty::sure));
      made_.layers.push_back(std::move(layer));
    }
    elevation_.assign(settings_.depths.size(), std::vector<float>(cells(), 0.0F));
    latest_ = latest_echo(simulator_, settings_, apart(), pulse_.duration());
    axis_.step = std::clamp(spacing_ / 1500.0, pulse_.duration() / 16.0, 0.25 * latest_);
    axis_.bins = static_cast<std::size_t>(std::ceil(latest_ / axis_.step)) + 1;
    parts_ = scattering_parts(scenario_.reverberation, scenario_.wind_speed,
                              speed_at_surface(scenario_, paths_));
    for (ScatteringPart& part : parts_)
      for (const Vec3& end : {source(), receiver()}) move_aside(part, end.z());
  }

  [[nodiscard]] ReverberationContext context() const {
    return {.geometry = geometry_,
            .pattern = pattern_,
            .pulse = pulse_,
            .array = settings_.array,
            .latest = latest_};
  }

  /// Where source and array are; nothing moves.
  [[nodiscard]] SheetEnds ends() const {
    SheetEnds ends = {.source = {source(), Vec3::Zero()},
                      .receiver = {receiver(), Vec3::Zero()},
                      .source_speed = paths_.speed_at(source()),
                      .receiver_speed = paths_.speed_at(receiver()),
                      .frequency = frequency(),
                      .latest = latest_};
    // A transmitter within its array, by whose own paths sound comes back in phase.
    const Carried point = geometry_.reverberation_point(settings_.array, frequency());
    if ((point.at(geometry_.time()).position - source()).norm() < 1e-6)
      ends.receiver.position = source();
    return ends;
  }

  void find_bounces() {
    if (!paths_.layered()) return find_bounces_of_planes();
    // To the target: of the nearest, a middle and the farthest range.
    const auto judged = [&](const Vec3& from, double share, double depth) {
      const double bearing = 2.0 * pi * share;
      const double range = share * settings_.reach;
      const Vec3 place(from.x() + range * std::sin(bearing), from.y() + range * std::cos(bearing),
                       depth);
      return enough_bounces(paths_, scenario_.propagation, from, place, frequency(), latest_);
    };
    for (const double depth : settings_.depths)
      for (const Vec3& end : {source(), receiver()})
        for (const double share : {0.1, 0.4, 1.0}) to_target_.include(judged(end, share, depth));
    made_.followed = to_target_;
    const BoundaryFans fans(paths_);
    const ReverberationContext at = context();
    for (const ScatteringPart& part : parts_) {
      BoundaryFans::Settings fan = fan_settings();
      fan.limits = time_limits({});
      to_part_.push_back(
          reverberation_bounces(part, ends(), fans, fan, paths_.layered(), scenario_, at));
      made_.followed.include(to_part_.back());
    }
  }

  /// Of planes in four directions: those after which every range lacks next to nothing of the
  /// energy that comes to the target's depth and, twice, to what scatters.
  void find_bounces_of_planes() {
    constexpr std::size_t segments = 32;
    constexpr int directions = 4;
    const double reach = settings_.reach + apart();
    const BounceSearch search{.most = most_over_slopes, .segments = segments, .latest = reach};
    const Bounces enough = search_bounces(
        scenario_.propagation, search, [&](const PathLimits& limits, ReceivedBounces& received) {
          std::vector<WantedLevel> levels;
          for (const double depth : settings_.depths) levels.push_back({level_of(depth), limits});
          for (const ScatteringPart& part : parts_) levels.push_back({part.level, limits});
          const PlaneFans fans(paths_, source(), levels, reach / 128.0, reach, frequency());
          std::vector<PlaneFans::Fans> found(directions);
          in_parallel(directions, [&](std::size_t i) {
            found[i] = fans.at(2.0 * pi * (double(i) + 0.3) / 4.0);
          });
          for (const PlaneFans::Fans& plane : found)
            for (std::size_t level = 0; level < plane.size(); ++level) {
              const BoundaryPaths& paths = *plane[level]->planes.front().paths;
              for (std::size_t cell = 0; cell < paths.cells(); ++cell)
                for (const BoundaryPath& path : paths.paths(cell)) {
                  const double power = std::norm(path.amplitude), sine = std::sin(path.grazing);
                  received.add(paths.range(cell), path.surface_bounces, path.bottom_bounces,
                               level < settings_.depths.size() ? power : power * sine);
                }
            }
        });
    to_target_ = enough;
    to_part_.assign(parts_.size(), enough);
    made_.followed = enough;
  }

  /// What to know before trusting the picture.
  void tell_limits() {
    const auto tell_of = [&](bool there, const std::string& text) {
      if (there) made_.warnings.push_back(text);
    };
    // Further than a record hears, of which the scenario's own warning tells.
    const std::string beyond = checks::beyond_the_map(scenario_, settings_.reach);
    tell_of(!beyond.empty() && checks::beyond_the_map(scenario_).empty(), beyond);
    tell_of(!scenario_.interferers.empty(),
            "interferer: the noise of ships is not in the picture of the area");
    tell_of(pulse_.duration() * pulse_.bandwidth_99() < 10.0 && !parts_.empty(),
            "pulse: the picture of the area is that of targets and scatterers at rest; a target "
            "that moves stands out better from reverberation");
    tell_of(!paths_.layered(),
            "environment: over slopes and fronts the picture of the area is right as a mean over "
            "cells; a cell by itself may be off by its uncertainty_db");
    tell_what_hides_echoes();
    tell_depths_without_water();
    const std::string bounces = lacking(scenario_.propagation, made_.followed, "the picture");
    tell_of(!bounces.empty(), bounces);
  }

  /// Targets below the sea floor wherever one looks.
  void tell_depths_without_water() {
    float deepest = -std::numeric_limits<float>::infinity();
    for (const float depth : made_.bottom_depth)
      if (depth > deepest) deepest = depth;
    for (const CoverageLayer& layer : made_.layers)
      if (std::all_of(layer.certainty.begin(), layer.certainty.end(), [](std::int8_t one) {
            return one == std::int8_t(CoverageCertainty::no_water);
          }))
        made_.warnings.push_back(
            "--depth: " + to_text(layer.depth) +
            " m is in the water nowhere within the reach, whose deepest place has " +
            to_text(std::round(10.0 * double(deepest)) / 10.0) +
            " m: nothing is known of a target there");
  }

  /// Of what the array receives beside echoes, reverberation and noise.
  void tell_what_hides_echoes() {
    const double speed = paths_.speed_at(receiver()), length = pulse_.duration();
    const bool own = geometry_.is_own(settings_.array);
    if (own && scenario_.pings.blanking)
      made_.warnings.push_back("pings.blanking: the array receives nothing of the first " +
                               to_text(length) + " s, in which echoes come from nearer than " +
                               to_text(std::round(0.5 * length * speed)) +
                               " m; the picture of the area shows them as if it did");
    if (own || !scenario_.propagation.direct_blast) return;
    const double blast = (source() - receiver()).norm() / speed;
    made_.warnings.push_back(
        "propagation.direct_blast: the ping itself is received from " +
        to_text(std::round(100.0 * blast) / 100.0) + " s on for " + to_text(length) +
        " s and hides echoes; the picture of the area shows them as if it were not");
  }

  [[nodiscard]] double reverberation_reach() const {
    return 0.5 * fastest_water(scenario_.environment) * latest_ + apart();
  }
  [[nodiscard]] BoundaryFans::Settings fan_settings() const {
    return {.sectors = settings_.bearings,
            .spacing = spacing_,
            .wide = spacing_,
            .max_range = reverberation_reach(),
            .frequency = frequency(),
            .limits = {}};
  }
  /// What comes home too late is not followed.
  [[nodiscard]] PathLimits time_limits(PathLimits limits) const {
    limits.home_slowness = 0.999 / fastest_water(scenario_.environment);
    limits.max_delay = latest_ + limits.home_slowness * apart();
    limits.diffraction = false;
    return limits;
  }

  /// The level of a target's depth: a little aside of a source's or array's own, which only a ray
  /// along it would reach.
  [[nodiscard]] GroundLevel level_of(double depth) const {
    constexpr double aside = 0.05;  // [m]
    for (const Vec3& end : {source(), receiver()})
      if (std::abs(depth - end.z()) < aside) depth = end.z() + (depth < end.z() ? -aside : aside);
    return GroundLevel(depth);
  }

  void make_fans() {
    if (by_arrivals()) find_arrivals();
    std::vector<WantedLevel> levels;
    first_part_ = by_arrivals() ? 0 : settings_.depths.size();
    for (const double depth : settings_.depths)
      if (!by_arrivals())
        levels.push_back(
            {level_of(depth), time_limits(limits_of(scenario_.propagation, to_target_))});
    for (std::size_t i = 0; i < parts_.size(); ++i)
      levels.push_back(
          {parts_[i].level, time_limits(limits_of(scenario_.propagation, to_part_[i]))});
    const double reach =
        std::max(settings_.reach + apart(), parts_.empty() ? 0.0 : reverberation_reach());
    const SheetEnds at = ends();
    const auto fans = [&](const Vec3& place) {
      return std::make_unique<PlaneFans>(paths_, place, levels, spacing_, reach, frequency());
    };
    out_ = fans(at.source.position);
    if (at.source.position.z() != receiver().z() || !(together() || paths_.layered()))
      back_ = fans(at.receiver.position);
    made_.planes = paths_.layered() ? 1 : settings_.bearings * (back_ ? 2 : 1);
    if (paths_.layered() || together()) return;
    // From the array a cell's bearing is its plane's; from the source any may be.
    constexpr int most = 180;
    const int sectors = std::min(settings_.bearings, most);
    all_round_ = out_->all_round(sectors, [&](double share) { tell(planes_share * share); });
    for (std::size_t i = 0; i < parts_.size(); ++i)
      out_groups_.push_back(
          std::make_shared<FanGroups>(*all_round_[first_part_ + i], alike(parts_[i]), frequency()));
    made_.planes = sectors + settings_.bearings;
  }

  /// Fans of both ends that lie in the plane of a bearing from the array.
  struct Ends {
    PlaneFans::Fans out, back;
  };
  [[nodiscard]] Ends fans_at(double bearing) const {
    Ends found{.out = all_round_.empty() ? out_->at(bearing) : all_round_, .back = {}};
    found.back = back_ ? back_->at(bearing) : found.out;
    return found;
  }

  void walk_bearings() {
    const auto bearings = static_cast<std::size_t>(settings_.bearings);
    const std::size_t row = bearings * nodes_.size();
    for (std::size_t k = 0; k < kinds; ++k)
      if (std::any_of(parts_.begin(), parts_.end(),
                      [&](const ScatteringPart& part) { return kind_of(part) == k; }))
        density_[k].assign(axis_.bins * row, 0.0F);
    std::atomic<std::size_t> done = 0;
    const bool symmetric = paths_.layered() && apart() < 1e-3 && pattern_.azimuthally_symmetric();
    // Of a sea that is the same all round one bearing tells all echoes, and what comes back to an
    // array to which paths are in phase from all bearings alike. Else some bearings tell that.
    const std::size_t stride = !symmetric                             ? 1
                               : receiving_phones().alike_all_round() ? bearings
                                                                      : between_bearings(bearings);
    const std::size_t walked = (bearings + stride - 1) / stride;
    in_parallel(walked, [&](std::size_t number) {
      const std::size_t j = number * stride;
      const Ends fans = fans_at(made_.bearings[j]);
      EchoMeans means(frequency(), *coherence_, pulse_.bandwidth_99());
      for (std::size_t depth = 0; depth < settings_.depths.size() && (j == 0 || !symmetric);
           ++depth)
        echoes(j, depth, by_arrivals() ? nullptr : fans.out[depth].get(),
               by_arrivals() ? nullptr : fans.back[depth].get(), means);
      for (std::size_t i = 0; i < parts_.size(); ++i)
        reverberation(j, i, fans.out[first_part_ + i], fans.back[first_part_ + i]);
      const double from = all_round_.empty() ? 0.0 : planes_share;
      tell(std::lerp(from, 0.7, static_cast<double>(++done) / static_cast<double>(walked)));
    });
    if (symmetric) spread_bearings(stride);
    for (std::size_t j = 0; j < bearings; ++j)
      for (int i = 0; i < settings_.ranges; ++i)
        made_.bottom_depth[j * static_cast<std::size_t>(settings_.ranges) +
                           static_cast<std::size_t>(i)] =
            static_cast<float>(paths_.bottom_depth(place_of(j, i)));
  }

  [[nodiscard]] Vec3 place_of(std::size_t bearing, int range) const {
    const double r = made_.ranges[static_cast<std::size_t>(range)];
    return receiver() +
           Vec3(r * std::sin(made_.bearings[bearing]), r * std::cos(made_.bearings[bearing]), 0.0);
  }

  /// Phases of what comes back by two ways turn with the cosine of the bearing.
  static std::size_t between_bearings(std::size_t bearings) {
    constexpr std::size_t enough = 48;
    return std::max<std::size_t>(1, bearings / enough);
  }

  /// Echoes of the first bearing hold for all; reverberation lies between that of each `stride`th.
  void spread_bearings(std::size_t stride) {
    const auto ranges = static_cast<std::size_t>(settings_.ranges);
    const auto bearings = static_cast<std::size_t>(settings_.bearings);
    const auto spread = [&](auto& values) {
      for (std::size_t j = 1; j < bearings; ++j)
        std::copy_n(values.begin(), ranges,
                    values.begin() + static_cast<std::ptrdiff_t>(j * ranges));
    };
    for (std::size_t d = 0; d < made_.layers.size(); ++d) {
      CoverageLayer& layer = made_.layers[d];
      for (auto* values :
           {&layer.echo_db, &layer.two_way_loss_db, &layer.delay, &layer.uncertainty_db})
        spread(*values);
      spread(layer.certainty);
      spread(elevation_[d]);
    }
    const std::size_t nodes = nodes_.size(), row = bearings * nodes;
    for (std::vector<float>& density : density_)
      in_parallel(density.size() / row, [&](std::size_t bin) {
        float* const all = &density[bin * row];
        for (std::size_t j = 0; j < bearings; ++j) {
          const std::size_t from = j / stride * stride;
          if (from == j) continue;
          const std::size_t to = std::min(from + stride, bearings);
          const float share = static_cast<float>(j - from) / static_cast<float>(to - from);
          const float* const a = &all[from * nodes];
          const float* const b = &all[to % bearings * nodes];
          for (std::size_t e = 0; e < nodes; ++e) all[j * nodes + e] = a[e] + share * (b[e] - a[e]);
        }
      });
  }

  /// The paths of a cell of a fan as legs of an echo.
  void legs_of(const BoundaryFan& fan, const Vec3& end, const Vec3& place, bool sent,
               std::vector<EchoLeg>& legs) const {
    legs.clear();
    const Vec2 way = (place - end).head<2>();
    const double range = way.norm(), bearing = std::atan2(way.x(), way.y());
    const BoundaryPaths& paths = *fan.towards(bearing).paths;
    const double at = paths.grid().at(range);
    if (!(at < static_cast<double>(paths.cells()))) return;
    const auto cell = static_cast<std::size_t>(at);
    const double beyond = range - paths.range(cell);
    const Vec2 outward = range > 0.0 ? Vec2(way / range) : Vec2(0.0, 1.0);
    for (const BoundaryPath& path : paths.paths(cell)) {
      legs.push_back(
          {.amplitude = path.amplitude,
           .sent = sent ? pattern_.towards(bearing, path.launch_elevation) : 1.0,
           .delay = path.delay +
                    (path.horizontal_slowness + 0.5 * path.slowness_slope * beyond) * beyond,
           .slowness = path.horizontal_slowness * outward,
           .elevation = path.launch_elevation});
    }
  }

  /// Every eigenray and wave from an end to all ranges of a layered ocean.
  void find_arrivals() {
    const SheetEnds at = ends();
    const PathLimits limits = limits_of(scenario_.propagation, to_target_);
    for (const double depth : settings_.depths) {
      Both both;
      both.out.resize(made_.ranges.size());
      const auto search = [&](const Vec3& end, std::vector<Arrivals>& found) {
        found.resize(made_.ranges.size());
        in_parallel(found.size(), [&](std::size_t i) {
          found[i] = paths_.find(end, Vec3(end.x(), end.y() + made_.ranges[i], depth), frequency(),
                                 limits);
        });
      };
      search(at.source.position, both.out);
      if (at.source.position.z() != at.receiver.position.z())
        search(at.receiver.position, both.back);
      arrivals_.push_back(std::move(both));
    }
  }

  /// The same as legs of an echo, to a place that may lie some metres off that range.
  /// \return whether one of them is a ray
  bool legs_of(const Arrivals& arrivals, double range, const Vec3& end, const Vec3& place,
               bool sent, std::vector<EchoLeg>& legs) const {
    legs.clear();
    const Separation way = separation(end, place);
    const Vec2 outward(std::sin(way.bearing), std::cos(way.bearing));
    bool ray = false;
    for (const Arrival& a : arrivals) {
      legs.push_back({.amplitude = a.amplitude,
                      .sent = sent ? pattern_.towards(way.bearing, a.launch_elevation) : 1.0,
                      .delay = a.delay + a.horizontal_slowness * (way.range - range),
                      .slowness = a.horizontal_slowness * outward,
                      .elevation = a.launch_elevation});
      ray = ray || a.kind != ArrivalKind::diffracted;
    }
    return ray;
  }

  /// Standard deviation of 20 lg of the distances there and back, over a cell's length [dB].
  [[nodiscard]] double falls_over_cell(const Vec3& place) const {
    const auto slope = [&](const Vec3& end) {
      const double distance = std::max(0.5 * step_, (place - end).norm());
      return (place - end).head<2>().dot((place - receiver()).head<2>()) /
             (distance * distance * std::max(0.5 * step_, (place - receiver()).head<2>().norm()));
    };
    return db_per_neper * std::abs(slope(source()) + slope(receiver())) * step_ / std::sqrt(12.0);
  }

  /// Echoes of one bearing. \param out, back  fans; null: of arrivals
  void echoes(std::size_t j, std::size_t depth, const BoundaryFan* out, const BoundaryFan* back,
              EchoMeans& means) {
    CoverageLayer& layer = made_.layers[depth];
    const auto ranges = static_cast<std::size_t>(settings_.ranges);
    const std::size_t first = j * ranges;
    const SheetEnds at = ends();
    std::vector<EchoLeg> there, home;
    std::vector<std::size_t> paths(ranges, 0);
    for (std::size_t i = 0; i < ranges; ++i) {
      Vec3 place = place_of(j, static_cast<int>(i));
      place.z() = layer.depth;
      const std::size_t cell = first + i;
      if (layer.depth >= paths_.bottom_depth(place) || layer.depth <= paths_.surface_depth(place)) {
        layer.certainty[cell] = std::int8_t(CoverageCertainty::no_water);
        continue;
      }
      bool rays = true;
      const double range = made_.ranges[i];
      if (out == nullptr) {
        const Both& both = arrivals_[depth];
        const Arrivals& way_back = both.back.empty() ? both.out[i] : both.back[i];
        rays = legs_of(both.out[i], range, at.source.position, place, true, there);
        rays = legs_of(way_back, range, at.receiver.position, place, false, home) && rays;
      } else {
        legs_of(*out, at.source.position, place, true, there);
        legs_of(*back, at.receiver.position, place, false, home);
        rays = !there.empty() && !home.empty();
      }
      paths[i] = rays ? there.size() + home.size() : 0;
      if (!rays) {
        layer.certainty[cell] = std::int8_t(CoverageCertainty::no_path);
        layer.uncertainty_db[cell] = std::numeric_limits<float>::infinity();
      }
      const EchoCell where{
          .outward = Vec2(std::sin(made_.bearings[j]), std::cos(made_.bearings[j])),
          .length = step_,
          .width = together() ? 0.0 : range * 2.0 * pi / settings_.bearings,
          .falls_db = falls_over_cell(place)};
      const EchoMean echo = means(there, home, where);
      layer.echo_db[cell] = static_cast<float>(projector_.source_level_db + settings_.strength_db +
                                               db_from_power(echo.power));
      layer.two_way_loss_db[cell] = static_cast<float>(-db_from_power(echo.open_power));
      elevation_[depth][cell] = static_cast<float>(echo.elevation);
      if (echo.power > 0.0) layer.delay[cell] = static_cast<float>(echo.delay);
      // Fans that are right as means do not tell their paths' phases.
      if (rays)
        layer.uncertainty_db[cell] = static_cast<float>(
            paths_.layered() ? echo.spread_db : std::max(echo.spread_db, echo.phases_db));
    }
    find_edges(layer, first, paths);
  }

  /// Where paths begin or end from a cell to the next, and the level jumps.
  void find_edges(CoverageLayer& layer, std::size_t first,
                  const std::vector<std::size_t>& paths) const {
    constexpr float jump = 3.0F, at_shadow = 6.0F;  // [dB]
    const auto is = [&](std::size_t i, CoverageCertainty what) {
      return layer.certainty[first + i] == std::int8_t(what);
    };
    for (std::size_t i = 0; i < paths.size(); ++i) {
      if (!is(i, CoverageCertainty::sure)) continue;
      float worst = 0.0F;
      for (const std::size_t next : {i - 1, i + 1}) {
        if (next >= paths.size() || is(next, CoverageCertainty::no_water)) continue;
        if (is(next, CoverageCertainty::no_path))
          worst = std::max(worst, at_shadow);
        else if (paths[next] != paths[i]) {
          const float step = std::abs(layer.echo_db[first + next] - layer.echo_db[first + i]);
          if (step > jump) worst = std::max(worst, step);
        }
      }
      if (!(worst > 0.0F)) continue;
      layer.certainty[first + i] = std::int8_t(CoverageCertainty::edge);
      layer.uncertainty_db[first + i] = std::max(layer.uncertainty_db[first + i], worst);
    }
  }

  /// Which paths of a leg are received as one.
  [[nodiscard]] PathResolution alike(const ScatteringPart& part) const {
    double level = 0.0, upright = 0.0;
    for (const Vec3& phone : phones_) {
      level = std::max(level, phone.head<2>().norm());
      upright = std::max(upright, std::abs(phone.z()));
    }
    return {.delay = 1.0 / (8.0 * pulse_.bandwidth_99()),
            .level = spacing_ + level,
            .level_of_range = 1.0 / 256.0,
            .depth = upright,
            .thickness = part.thickness};
  }

  /// Where the phones are about the end of the paths, and how they go on.
  [[nodiscard]] ReceivingPhones receiving_phones() const {
    ReceivingPhones found;
    const Vec2 aside = (receiver() - ends().receiver.position).head<2>();
    for (const Vec3& phone : phones_) found.offsets.push_back(phone.head<2>() + aside);
    found.velocity = geometry_.reference_place(settings_.array).velocity.head<2>();
    return found;
  }

  /// Reverberation of one bearing.
  void reverberation(std::size_t j, std::size_t number,
                     const std::shared_ptr<const BoundaryFan>& out,
                     const std::shared_ptr<const BoundaryFan>& back) {
    const ScatteringPart& part = parts_[number];
    const SheetEnds at = ends();
    const auto depth_at = [&](const Vec3& place) {
      if (!part.level.boundary) return part.level.depth;
      return *part.level.boundary == BoundaryKind::surface ? paths_.surface_depth(place)
                                                           : paths_.bottom_depth(place);
    };
    ScatteringSheet::Groups groups;
    groups.out = out_groups_.empty() ? std::make_shared<FanGroups>(*out, alike(part), frequency())
                                     : out_groups_[number];
    groups.back =
        out == back ? groups.out : std::make_shared<FanGroups>(*back, alike(part), frequency());
    const ScatteringSheet sheet(out, back, part.law, at, pattern_, groups);
    const double depth = depth_at(receiver());
    const ScatteringGround ground{
        .middle = receiver().head<2>(),
        .edges = ring_edges(reverberation_reach(), std::abs(depth - receiver().z()), axis_.step),
        .depth = depth,
        .thickness = part.thickness};
    std::vector<float> power(axis_.bins * nodes_.size(), 0.0F);
    add_reverberation(sheet, ground, made_.bearings[j], 2.0 * pi / settings_.bearings, *coherence_,
                      axis_, nodes_, receiving_phones(), power);
    std::vector<float>& density = density_[kind_of(part)];
    const std::size_t row = static_cast<std::size_t>(settings_.bearings) * nodes_.size();
    for (std::size_t bin = 0; bin < axis_.bins; ++bin)
      for (std::size_t e = 0; e < nodes_.size(); ++e)
        density[bin * row + j * nodes_.size() + e] += power[bin * nodes_.size() + e];
  }

  /// By how much the echoes of a cell's ends are apart [s], no more than a pulse.
  [[nodiscard]] double cell_delay() const {
    return std::min(2.0 * step_ / paths_.speed_at(receiver()), pulse_.duration());
  }

  /// Over each delay the mean that the matched filter receives, times the pulse's energy.
  void receive_pulse(std::vector<float>& density, const std::vector<float>& weights) const {
    if (density.empty()) return;
    const std::size_t row = density.size() / axis_.bins, half = weights.size() / 2;
    std::vector<float> received(density.size(), 0.0F);
    in_parallel(axis_.bins, [&](std::size_t bin) {
      for (std::size_t k = 0; k < weights.size(); ++k) {
        if (bin + k < half || bin + k - half >= axis_.bins) continue;
        const float* const from = &density[(bin + k - half) * row];
        for (std::size_t i = 0; i < row; ++i) received[bin * row + i] += weights[k] * from[i];
      }
    });
    density = std::move(received);
  }

  /// Surface, bottom and volume into the first of them that is there.
  void add_up_kinds() {
    std::vector<float>* first = nullptr;
    for (std::vector<float>& density : density_) {
      if (density.empty()) continue;
      if (first == nullptr) {
        first = &density;
        continue;
      }
      const std::size_t row = density.size() / axis_.bins;
      in_parallel(axis_.bins, [&](std::size_t bin) {
        for (std::size_t i = bin * row; i < (bin + 1) * row; ++i) (*first)[i] += density[i];
      });
      density = {};
    }
  }

  void look_through_beams() {
    const std::vector<float> weights = filter_weights(pulse_, axis_.step, cell_delay());
    add_up_kinds();
    for (std::vector<float>& density : density_) receive_pulse(density, weights);
    const ProbabilityTable probability(settings_.false_alarm_probability, settings_.reference_cells,
                                       fluctuation_shape(settings_.fluctuation));
    const double noise_db = noise_band_db(scenario_.noise, frequency(), pulse_.bandwidth_40db());
    std::atomic<std::size_t> done = 0;
    in_parallel(static_cast<std::size_t>(settings_.bearings), [&](std::size_t j) {
      look(j, noise_db, probability);
      tell(0.7 + 0.3 * static_cast<double>(++done) / settings_.bearings);
    });
  }

  /// One bearing: all its cells, by the elevation at which the beam looks.
  void look(std::size_t j, double noise_db, const ProbabilityTable& probability) {
    const auto ranges = static_cast<std::size_t>(settings_.ranges);
    std::vector<std::optional<BeamBank::Beam>> beams(nodes_.size());
    std::vector<double> gains(nodes_.size());
    for (std::size_t d = 0; d < made_.layers.size(); ++d) {
      CoverageLayer& layer = made_.layers[d];
      std::vector<double> aside(ranges, 0.0);
      for (std::size_t cell = j * ranges; cell < (j + 1) * ranges; ++cell) {
        if (layer.certainty[cell] == std::int8_t(CoverageCertainty::no_water)) continue;
        const std::size_t node = nodes_.nearest(double(elevation_[d][cell]));
        if (!beams[node]) {
          beams[node] = beams_.beam(made_.bearings[j], node);
          gains[node] = beams_.gain_over_noise_db(made_.bearings[j], node);
        }
        // Of a cell that nothing answers from: as if along a straight line.
        const double range = made_.ranges[cell - j * ranges];
        const double delay = std::isnan(layer.delay[cell])
                                 ? (2.0 * range + apart()) / paths_.speed_at(receiver())
                                 : double(layer.delay[cell]);
        double reverberation = 0.0, sidelobes = 0.0;
        for (const std::vector<float>& density : density_)
          if (!density.empty()) {
            const Received part = received(density, *beams[node], delay);
            reverberation += part.all;
            sidelobes += part.aside;
          }
        if (reverberation > 0.0) aside[cell - j * ranges] = sidelobes / reverberation;
        const BeamLevels levels{
            .echo_db = double(layer.echo_db[cell]),
            .reverberation_db = projector_.source_level_db + db_from_power(reverberation),
            .noise_db = noise_db - gains[node]};
        const double excess = signal_excess_db(levels, made_.gain, made_.threshold_db);
        layer.reverberation_db[cell] = static_cast<float>(levels.reverberation_db);
        layer.noise_db[cell] = static_cast<float>(levels.noise_db);
        layer.signal_excess_db[cell] = static_cast<float>(excess);
        layer.detection_probability[cell] =
            static_cast<float>(probability(excess + made_.threshold_db));
      }
      tell_uncertainty(layer, j * ranges, aside);
    }
  }

  /// Standard deviation of reverberation in a cell: over it and by what blurs it, of fans, of what
  /// beams hear in their sidelobes, and of a moving source that is elsewhere.
  /// \param first  cell of a bearing   \param aside  shares of sidelobes, by range
  void tell_uncertainty(CoverageLayer& layer, std::size_t first,
                        const std::vector<double>& aside) const {
    // Measured against pings: docs/theory/coverage.md.
    const double of_fans = paths_.layered() ? 0.5 : 1.0;
    constexpr double edge = 6.0;  // [dB]
    // Lobes between nodes; and where sound comes by more than one path, two orders of a pair that
    // two sidelobes may receive against one another: half of the power is not there.
    const bool by_many = made_.followed.surface > 0 || made_.followed.bottom > 0;
    const double of_sidelobes = by_many ? std::hypot(1.0, 3.0) : 1.0;
    const std::vector<float>& level = layer.reverberation_db;
    const auto ranges = static_cast<std::size_t>(settings_.ranges);
    // A level is blurred over bins of delay, and sound from elsewhere comes early or late.
    const double cell = 2.0 * step_ / paths_.speed_at(receiver());
    const double blurred = std::max(1.0, (axis_.step + beams_.smear()) / cell);
    for (std::size_t i = 0; i < ranges; ++i) {
      if (std::isnan(level[first + i])) continue;
      double change = 0.0;
      for (const std::size_t next : {i - 1, i + 1})
        if (next < ranges && !std::isnan(level[first + next]) &&
            level[first + next] != level[first + i])  // both may be none
          change = std::max(change, std::abs(double(level[first + next] - level[first + i])));
      // Even on a slope; all of it at an edge, of which a cell may lie on either side.
      const double steps = blurred * change / (change > edge ? 1.0 : std::sqrt(3.0));
      layer.reverberation_uncertainty_db[first + i] = static_cast<float>(
          std::hypot(std::hypot(of_fans, steps),
                     std::hypot(of_sidelobes * aside[i], of_moving_source(made_.ranges[i]))));
    }
  }

  /// Of a source under way whose sound is taken to come from the array's direction [dB].
  [[nodiscard]] double of_moving_source(double range) const {
    if (together()) return 0.0;
    const double turned = std::min(2.0, 2.0 * apart() / range);
    const double shift = turned * geometry_.source().velocity.head<2>().norm() * frequency() /
                         paths_.speed_at(receiver());
    return -db_from_power(std::max(1e-3, band_.passes(shift)));
  }

  /// Power in a beam at a delay, and beside its main lobe.
  struct Received {
    double all = 0.0, aside = 0.0;
  };
  [[nodiscard]] Received received(const std::vector<float>& density, const BeamBank::Beam& beam,
                                  double delay) const {
    const double at =
        std::clamp(delay / axis_.step - 0.5, 0.0, static_cast<double>(axis_.bins) - 1.001);
    const auto bin = static_cast<std::size_t>(at);
    const auto later = static_cast<float>(at - static_cast<double>(bin));
    const std::size_t size = beam.all.size();
    const float* const a = &density[bin * size];
    const float* const b = a + size;
    const float* const all = beam.all.data();
    const float* const aside = beam.aside.data();
    constexpr std::size_t lanes = 8;  // summed beside one another: the compiler may not reorder
    float sums[lanes] = {}, others[lanes] = {};
    std::size_t i = 0;
    for (; i + lanes <= size; i += lanes)
      for (std::size_t k = 0; k < lanes; ++k) {
        const float power = a[i + k] + later * (b[i + k] - a[i + k]);
        sums[k] += all[i + k] * power;
        others[k] += aside[i + k] * power;
      }
    Received found;
    for (std::size_t k = 0; k < lanes; ++k) {
      found.all += double(sums[k]);
      found.aside += double(others[k]);
    }
    for (; i < size; ++i) {
      const float power = a[i] + later * (b[i] - a[i]);
      found.all += double(all[i] * power);
      found.aside += double(aside[i] * power);
    }
    return found;
  }

  const PingSimulator& simulator_;
  const Scenario& scenario_;
  const CoverageSettings& settings_;
  const Progress& progress_;
  const PropagationPaths& paths_;
  PingGeometry geometry_;
  const Pulse& pulse_;
  std::shared_ptr<const PulseCoherence> coherence_;
  Transmitter projector_;
  BeamPattern pattern_;
  std::vector<Vec3> phones_;
  double step_;     // of the ranges [m]
  double spacing_;  // of the fans' cells: an odd part of it, whose middles are among them [m]
  PulseBand band_;
  ElevationNodes nodes_;
  BeamBank beams_;
  Coverage made_;
  double latest_ = 0.0;
  DelayAxis axis_;
  std::vector<ScatteringPart> parts_;
  Bounces to_target_;
  std::vector<Bounces> to_part_;
  struct Both {
    std::vector<Arrivals> out, back;  // [ranges]; back: none, it is the same
  };
  std::vector<Both> arrivals_;  // [depths], where echoes are by_arrivals()
  std::size_t first_part_ = 0;  // of the fans' levels, that is of reverberation
  PlaneFans::Fans all_round_;   // of a source that is elsewhere, over slopes
  std::vector<std::shared_ptr<FanGroups>> out_groups_;  // [parts] of those
  std::unique_ptr<PlaneFans> out_, back_;               // back_: none, it is the same
  std::array<std::vector<float>, kinds> density_;       // [bins][bearings × nodes] [1/s]
  std::vector<std::vector<float>> elevation_;           // of the echo, [depths][cells] [rad]
};

void check(const PingSimulator& simulator, const CoverageSettings& settings) {
  const auto number = [](auto x) { return to_text(static_cast<double>(x)); };
  require(settings.ping >= 1 && settings.ping <= simulator.pings(), "--ping", number(settings.ping),
          "a ping from 1 to " + number(simulator.pings()));
  require(settings.bearings >= 4 && settings.bearings <= 3600, "--bearings",
          number(settings.bearings), "4 to 3600 bearings");
  require(settings.ranges >= 2 && settings.ranges <= 20000, "--ranges", number(settings.ranges),
          "2 to 20000 ranges");
  require(std::isfinite(settings.reach) && settings.reach >= 10.0 && settings.reach <= 1e6,
          "--reach", number(settings.reach) + " m", "10 to 1000000 m");
  require(!settings.depths.empty(), "--depth", "no depth", "one or more");
  require(settings.false_alarm_probability > 0.0 && settings.false_alarm_probability < 0.5,
          "--false-alarm", number(settings.false_alarm_probability), "above 0, below 0.5");
  for (const double depth : settings.depths)
    require(std::isfinite(depth) && depth > 0.0 && depth < 12000.0, "--depth", number(depth) + " m",
            "above 0, below 12000 m");
}

}  // namespace

MemoryNeed coverage_need(const PingSimulator& simulator, const CoverageSettings& settings) {
  check(simulator, settings);
  const PingGeometry geometry = simulator.geometry(settings.ping);
  const Pulse& pulse = simulator.pulse(geometry.sent().transmitter);
  const double wavelength =
      simulator.paths().speed_at(geometry.reference_place(settings.array).position) /
      pulse.centre_frequency();
  const double way = closing_of(geometry, settings.array).norm() / PulseBand(pulse).half();

  const double cells = static_cast<double>(settings.bearings) * settings.ranges;
  constexpr double a_cell = 9.0 * sizeof(float) + 1.0 + sizeof(float);
  // Reverberation over delay, elevation and bearing, twice while the pulse is laid over it.
  constexpr double bins = 4.0;
  const auto nodes =
      static_cast<double>(ElevationNodes(geometry.phones(settings.array), wavelength, way).size());
  return {.where = "--ranges",
          .what = "a picture of " + std::to_string(settings.bearings) + " bearings and " +
                  std::to_string(settings.ranges) + " ranges",
          .bytes = cells * (a_cell * static_cast<double>(settings.depths.size()) +
                            4.0 * bins * nodes * sizeof(float)),
          .remedy = "fewer bearings, ranges or depths"};
}

Coverage coverage(const PingSimulator& simulator, const CoverageSettings& settings,
                  const Progress& progress) {
  check(simulator, settings);
  return Maker(simulator, settings, progress).make();
}

}  // namespace asdic::detail
