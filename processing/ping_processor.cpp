#include "processing/ping_processor.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/check_settings.h"
#include "core/error.h"
#include "core/geometry.h"
#include "core/text.h"
#include "processing/known_blasts.h"
#include "processing/listening_band.h"
#include "raytrace/parallel/parallel.h"
#include "sonar/scenario/ping_geometry.h"
#include "sonar/scenario/transmission.h"

namespace asdic::detail {
namespace {

/// The pulse's band with room for its flanks, stretched by all Doppler factors.
ListeningBand listening_band(const Replica& replica, std::span<const double> dopplers,
                             double highest_allowed) {
  const double room = 0.25 * replica.bandwidth();
  const double low = std::max((replica.lowest_frequency() - room) * dopplers.front(), 0.0);
  const double high =
      std::min((replica.highest_frequency() + room) * dopplers.back(), highest_allowed);
  return {.centre = 0.5 * (low + high), .width = high - low};
}

/// The factors whose echoes lie within a recorded baseband; always one.
std::span<const double> received_factors(const Replica& replica, std::span<const double> all,
                                         double carrier, double rate) {
  const auto received = [&](double factor) {
    return std::abs(replica.centre_frequency() * factor - carrier) < 0.45 * rate;
  };
  const auto first = std::find_if(all.begin(), all.end(), received);
  const auto last = std::find_if_not(first, all.end(), received);
  if (first == all.end())
    throw InputError(
        {.where = "replica",
         .got = "a centre frequency of " + std::to_string(replica.centre_frequency()) + " Hz",
         .expected = "one within the recorded baseband"});
  return {first, last};
}

/// Of the way from the first phone to the last [rad].
double chord_bearing(std::span<const Vec3> phones) {
  const Vec3 chord = phones.back() - phones.front();
  return std::atan2(chord.x(), chord.y());
}

/// Turns what was received, and the array that received it, clockwise by an angle [rad].
void rotate(Detection& d, ArrayShape& shape, double angle) {
  const auto rotated = [&](const Vec3& v) {
    const double c = std::cos(angle), s = std::sin(angle);
    return Vec3(c * v.x() + s * v.y(), c * v.y() - s * v.x(), v.z());
  };
  d.look = rotated(d.look);
  d.bearing = std::remainder(d.bearing + angle, 2.0 * pi);
  shape.axis = rotated(shape.axis);
  shape.across = rotated(shape.across);
  shape.normal = rotated(shape.normal);
}

}  // namespace

PingProcessor::PingProcessor(Scenario scenario, std::vector<Replica> replicas,
                             ProcessingSettings settings)
    : scenario_(std::move(scenario)),
      replicas_(std::move(replicas)),
      settings_(settings),
      paths_(scenario_.environment, scenario_.transect, scenario_.area) {
  if (replicas_.empty())
    throw InputError({.where = "replica", .got = "none", .expected = "at least one"});
  const auto require = [](bool good, const char* where, double got, const char* expected) {
    if (!good) throw InputError({.where = where, .got = std::to_string(got), .expected = expected});
  };
  check_settings(settings_);
  check_settings(settings_.tracker);
  require(settings_.detector.lowest_elevation <= settings_.detector.highest_elevation, "elevations",
          degrees(settings_.detector.lowest_elevation), "no more than the highest");
  require(settings_.tracker.start_hits >= 1 &&
              settings_.tracker.start_hits <= settings_.tracker.start_pings,
          "track_start", settings_.tracker.start_hits, "hits from 1 to the number of pings");
  if (settings_.target_depth) {
    // Somewhere at the platforms or targets there must be water that deep.
    double floor = 0.0;
    const auto look_at = [&](const Track& track) {
      floor = std::max(floor, paths_.bottom_depth(track.at(0.0).position));
    };
    for (const Platform& platform : scenario_.platforms) look_at(platform.track);
    for (const Target& target : scenario_.targets) look_at(target.track);
    if (!(*settings_.target_depth < floor))
      throw InputError(
          {.where = "target_depth",
           .got = std::to_string(*settings_.target_depth) + " m",
           .expected = "a depth above the sea floor at " + std::to_string(floor) + " m"});
  }
  for (const Replica& replica : replicas_) {
    const double product = replica.noise_bandwidth() * replica.duration();
    if (const int parts = settings_.detector.sub_bands; parts > 1 && parts > 0.25 * product)
      throw InputError({.where = "sub_bands",
                        .got = std::to_string(parts),
                        .expected = "no more than a quarter of the pulse's duration times its "
                                    "bandwidth, " +
                                    to_text(std::max(1.0, std::floor(0.25 * product)))});
    // The slowest sound of any ocean, so that no echo falls outside the bank.
    banks_.push_back(doppler_bank(replica, 2.0 * settings_.max_speed / 1400.0,
                                  settings_.bank_loss_db, settings_.detector.sub_bands));
    localisers_.push_back(std::make_unique<Localiser>(
        paths_, LocaliserSettings{.frequency = replica.centre_frequency(),
                                  .propagation = scenario_.propagation,
                                  .depth = settings_.target_depth,
                                  .speed = settings_.range_speed}));
  }
}

ProcessedArray PingProcessor::process(const ArrayRecording& recording,
                                      const std::function<bool()>& proceed,
                                      std::span<const TrueEcho> echoes) const {
  const Replica& pulse = replica(recording.transmitter);
  std::span<const double> factors = dopplers(recording.transmitter);
  if (recording.carrier)
    factors = received_factors(pulse, factors, *recording.carrier, recording.sample_rate);
  const std::size_t channels = recording.phones.size();
  const double top = recording.carrier ? *recording.carrier + 0.5 * recording.sample_rate
                                       : 0.5 * recording.sample_rate;
  ListeningBand band = listening_band(pulse, factors, top);
  if (recording.carrier) {
    const double bottom = *recording.carrier - 0.5 * recording.sample_rate;
    const double low = std::max(band.centre - 0.5 * band.width, bottom);
    const double high = band.centre + 0.5 * band.width;
    band = {.centre = 0.5 * (low + high), .width = high - low};
  }
  const double silence = pulse.duration() / factors.front();
  Baseband baseband = recording.carrier
                          ? to_baseband(recording.envelope, channels, recording.sample_rate,
                                        *recording.carrier, recording.start, band, silence)
                          : to_baseband(recording.pressure, channels, recording.sample_rate,
                                        recording.start, band, silence);

  ProcessedArray done{.ping = recording.ping, .array = recording.array};
  const PingGeometry geometry(scenario_,
                              {.transmitter = recording.transmitter, .time = recording.ping_time},
                              recording.ping);
  const ArrayMotion& motion = geometry.motion(recording.array);
  done.places.source = geometry.source();
  const Carried& reference = motion.reference();
  done.places.array = reference.track.since(recording.ping_time, reference.offset);
  const Vec3 at_ping = done.places.array.at(0.0).position;
  done.sound_speed = paths_.speed_at(at_ping);
  std::vector<Vec3> phones;
  for (const Vec3& x : recording.phones) phones.push_back(x - at_ping);
  if (motion.deforms()) {  // its shape in the middle of the record
    const auto values = recording.carrier ? recording.envelope.size() : recording.pressure.size();
    const double samples = static_cast<double>(values / std::max<std::size_t>(channels, 1));
    const double middle = recording.start + 0.5 * samples / recording.sample_rate;
    phones = motion.phones(recording.ping, recording.ping_time + middle);
  }
  const double heading = chord_bearing(phones);
  // How far the line has turned from the shape that its beams are formed for [rad].
  const auto rotated_by = [&](double time) {
    if (!motion.deforms()) return 0.0;
    return chord_bearing(
               motion.phones(recording.ping, recording.ping_time + time + 0.5 * pulse.duration())) -
           heading;
  };
  const double wavelength = done.sound_speed / pulse.centre_frequency();
  done.shape = shape_of(phones, wavelength);
  done.places.shape = done.shape;
  done.elevation_sigma = 0.25 * wavelength / std::max(done.shape.height, 0.25 * wavelength);

  const double length = static_cast<double>(recording.carrier ? recording.envelope.size()
                                                              : recording.pressure.size()) /
                        static_cast<double>(std::max<std::size_t>(channels, 1)) /
                        recording.sample_rate;
  BlastSearch search{.scenario = scenario_,
                     .paths = paths_,
                     .ping = recording.ping,
                     .transmitter = recording.transmitter,
                     .array = recording.array,
                     .ping_time = recording.ping_time,
                     .start = recording.start,
                     .end = recording.start + length,
                     .phones = phones};
  done.sends_on = sends_on(scenario_, recording.transmitter, recording.array, pulse.duration());
  if (settings_.cancel_direct_blast != BlastCancelling::off) {
    const std::vector<KnownBlast> blasts =
        known_blasts(search, replicas_, settings_.cancel_direct_blast == BlastCancelling::on);
    cancel_blasts(baseband, band, blasts, blanked_times(search, replicas_), done.blast);
  }

  DetectorSettings detector = settings_.detector;
  done.searched_from =
      std::max(settings_.detector.first_time.value_or(first_time(search)), recording.start);
  detector.first_time = done.searched_from;
  if (!detector.last_time && done.sends_on) {
    // Echoes that are received whole; of a record hardly longer than the pulse, by half.
    const double whole = search.end - pulse.duration();
    detector.last_time = whole > done.searched_from + 0.5 * pulse.duration()
                             ? whole
                             : search.end - 0.5 * pulse.duration();
  }
  done.searched_until = std::min(detector.last_time.value_or(infinity), search.end);
  std::vector<Probe> probes;
  for (const TrueEcho& echo : echoes)
    probes.push_back({.time = echo.time,
                      .doppler = std::isnan(echo.doppler) ? 1.0 : echo.doppler,
                      .look = -echo.travel});
  done.result =
      detect(baseband, phones, done.sound_speed, pulse, factors, detector, probes, proceed);

  // The transmitter as it was for that ping.
  const Transmitter projector = projector_of(scenario_, recording.transmitter, recording.ping);
  const double c = paths_.speed_at(done.places.source.position);
  const BeamPattern pattern(projector, c / pulse.centre_frequency(), c, geometry.source_heading());
  SonarPlaces places = done.places;
  places.pattern = &pattern;
  const Localiser& localiser =
      *localisers_[localisers_.size() > 1 ? static_cast<std::size_t>(recording.transmitter) : 0];
  in_parallel(done.result.detections.size(), [&](std::size_t i) {
    Detection& d = done.result.detections[i];
    d.ping = recording.ping;
    d.array = recording.array;
    SonarPlaces then = places;
    if (const double angle = rotated_by(d.time); angle != 0.0) rotate(d, then.shape, angle);
    d.locations = localiser.locate(d, then, done.elevation_sigma);
    if (d.locations.empty()) d.unplaced = localiser.reason(d, places);
  });
  return done;
}

double PingProcessor::first_time(const BlastSearch& search) const {
  if (!scenario_.pings.continuous) return 0.0;
  const Replica& pulse = replica(search.transmitter);
  // The own ship's pulse hides what comes while it lasts, unless it lasts so long that echoes are
  // looked for meanwhile. On other ships nothing of a ping comes before its own sound.
  if (is_own(scenario_, search.transmitter, search.array))
    return sends_on(scenario_, search.transmitter, search.array, pulse.duration())
               ? 0.0
               : pulse.duration();
  return first_sound(search, pulse);
}

std::string PingProcessor::lack() const {
  if (std::none_of(localisers_.begin(), localisers_.end(),
                   [](const auto& localiser) { return localiser->lacks_bounces(); }))
    return "";
  return "propagation: places are found by paths of up to " +
         std::to_string(DelayTables::most_bounces) +
         " bounces off either boundary, and more hold sound here: an echo along one of those is "
         "placed as if it came along another";
}

MapRanges PingProcessor::ranges_at(const ProcessedArray& processed, int sender,
                                   std::span<const double> times) const {
  const Localiser& localiser =
      *localisers_[localisers_.size() > 1 ? static_cast<std::size_t>(sender) : 0];
  MapRanges ranges;
  if (times.empty()) return ranges;
  SonarPlaces places = processed.places;
  const double apart = separation(places.source.position, places.array.at(0.0).position).range;
  if (apart <= 0.1 * farthest_apart * times.back()) {
    places.shape.kind = ArrayKind::point;  // no direction is needed
    ranges.of_time.assign(times.size(), std::numeric_limits<double>::quiet_NaN());
    in_parallel(times.size(), [&](std::size_t i) {
      const auto found = localiser.locate({.time = times[i]}, places, 1.0);
      if (!found.empty()) ranges.of_time[i] = found[0].range;
    });
    return ranges;
  }
  if (places.shape.kind == ArrayKind::point || places.shape.upright()) return ranges;
  const std::vector<Vec3>& looks = processed.result.grid.looks;
  const bool two_sides = places.shape.kind == ArrayKind::line;
  ranges.of_beam.resize(looks.size() * times.size());
  if (two_sides) ranges.of_mirror.resize(looks.size() * times.size());
  in_parallel(looks.size(), [&](std::size_t b) {
    const auto row = [&](const Vec3& look, std::vector<double>& into) {
      const std::vector<double> found =
          localiser.ranges(std::atan2(look.x(), look.y()), times, places);
      std::copy(found.begin(), found.end(),
                into.begin() + static_cast<std::ptrdiff_t>(b * times.size()));
    };
    row(looks[b], ranges.of_beam);
    if (two_sides) row(mirrored(places.shape, looks[b]), ranges.of_mirror);
  });
  return ranges;
}

Resolution PingProcessor::resolution(const ProcessedArray& processed) const {
  const double wavelength = processed.sound_speed / replica(0).centre_frequency();
  return {.time = processed.result.time_cell,
          .doppler = processed.result.doppler_cell,
          .delay_per_doppler = processed.result.delay_per_doppler,
          .curved = processed.sends_on,
          .direction =
              processed.shape.kind == ArrayKind::point ? 2.0 : wavelength / processed.shape.length};
}

std::vector<Contact> PingProcessor::contacts(const ProcessedArray& processed, double ping_time,
                                             int side) const {
  std::vector<Contact> result;
  const double wavelength = processed.sound_speed / replica(0).centre_frequency();
  for (std::size_t i = 0; i < processed.result.detections.size(); ++i) {
    const Detection& d = processed.result.detections[i];
    if (d.locations.size() <= static_cast<std::size_t>(side)) continue;
    const Location& place = d.locations[static_cast<std::size_t>(side)];
    const double snr = power_from_db(d.snr_db);
    Contact c{.detection = static_cast<int>(i), .time = ping_time + place.struck};
    c.range = place.range;
    c.range_rate = place.range_rate;
    c.range_sigma = sigma_of(processed.result.time_cell, snr) * place.range_slope;
    c.range_rate_sigma = trusted_sigma(d, processed.result) * place.rate_slope;
    // Along the ridge the delay is late by D for an error of η, the range rate low by rate_slope.
    c.range_per_rate = -processed.result.delay_per_doppler * place.range_slope / place.rate_slope;
    if (std::isnan(place.bearing)) {  // no bearing: a track along one line, seen from the platform
      c.bearing_known = false;
      c.bearing = 0.0;
      c.bearing_sigma = 1e-3;
    } else {
      c.bearing = place.bearing;
      // A line's cell widens as 1/sin of the angle with its axis, to its square root at endfire.
      double across = 1.0;
      if (processed.shape.kind == ArrayKind::line || processed.shape.bent)
        across = std::max(std::sqrt(std::max(1.0 - d.cosine * d.cosine, 0.0)),
                          std::sqrt(wavelength / processed.shape.length));
      c.bearing_sigma = sigma_of(wavelength / (processed.shape.breadth * across), snr);
      c.range_per_bearing = place.bearing_slope;
      const Kinematics received = processed.places.array.at(d.time);
      c.array = received.position.head<2>();
      c.array_velocity = received.velocity.head<2>();
      c.source = processed.places.source.position.head<2>();
      c.source_velocity = processed.places.source.velocity.head<2>();
    }
    result.push_back(c);
  }
  return result;
}

}  // namespace asdic::detail
