#include "processing/processing_settings.h"

#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>
#include <utility>

#include "core/fields.h"
#include "core/quantities.h"
#include "core/text.h"

namespace asdic::detail {
namespace {

constexpr Quantity cells_beside{.noun = "number of cells", .low = 0.0, .high = 1e5};
constexpr Quantity cells_averaged{.noun = "number of cells", .low = 1.0, .high = 1e5};
constexpr Quantity reached_speed{.noun = "speed", .unit = "m/s", .low = 0.0, .high = 600.0};
constexpr Quantity target_speed{.noun = "speed", .unit = "m/s", .low = 1e-3, .high = 1e4};
constexpr Quantity since_ping{.noun = "time", .unit = "s", .low = 0.0, .high = 1e9};

/// Two numbers with a sign between: "3/4", "-20:20".
std::optional<std::pair<double, double>> two_numbers(const std::string& text, char sign) {
  const auto at = text.find(sign, 1);
  if (at == std::string::npos) return std::nullopt;
  const auto number_of = [](const char* begin, const char* end) -> std::optional<double> {
    double value = 0.0;
    const auto [rest, error] = std::from_chars(begin, end, value);
    if (error != std::errc{} || rest != end || !std::isfinite(value)) return std::nullopt;
    return value;
  };
  const char* const begin = text.data();
  const auto first = number_of(begin, begin + at);
  const auto second = number_of(begin + at + 1, begin + text.size());
  if (!first || !second) return std::nullopt;
  return std::pair(*first, *second);
}

/// An angle as someone wrote it [deg]: of 12 digits, if these are the angle.
std::string degrees_text(double angle) {
  char text[32] = {};
  std::snprintf(text, sizeof text, "%.12g", degrees(angle));
  const double round = std::strtod(text, nullptr);
  return to_text(radians(round) == angle ? round : degrees(angle));
}

/// "-20:20"; none stands for all of them.
void describe_elevations(Fields& field, DetectorSettings& detector) {
  std::string text;
  if (detector.lowest_elevation > -0.5 * pi || detector.highest_elevation < 0.5 * pi)
    text = degrees_text(detector.lowest_elevation) + ':' + degrees_text(detector.highest_elevation);
  field("elevations", text,
        "looked at by arrays that tell elevation and bearing, e.g. -20:20 [deg]");
  if (!field.reads() || text.empty()) return;
  const auto angles = two_numbers(text, ':');
  if (!angles) field.fault("elevations", "two angles such as -20:20, the lower first");
  const auto [low, high] = angles.value();
  if (!(low <= high && low >= -90.0 && high <= 90.0))
    field.fault("elevations", "two angles from -90 to 90 degrees, the lower first");
  detector.lowest_elevation = radians(low);
  detector.highest_elevation = radians(high);
}

/// "3/4".
void describe_start(Fields& field, TrackerSettings& tracker) {
  std::string text = std::to_string(tracker.start_hits) + '/' + std::to_string(tracker.start_pings);
  field("track_start", text, "a track is believed after m hits in n pings");
  if (!field.reads()) return;
  const auto numbers = two_numbers(text, '/');
  if (!numbers) field.fault("track_start", "hits/pings such as 3/4");
  const auto [hits, pings] = numbers.value();
  if (!(hits >= 1.0 && hits <= pings && pings <= 1000.0 && hits == std::floor(hits) &&
        pings == std::floor(pings)))
    field.fault("track_start", "hits/pings such as 3/4, no more hits than pings");
  tracker.start_hits = static_cast<int>(hits);
  tracker.start_pings = static_cast<int>(pings);
}

}  // namespace

void ProcessingSettings::describe(Fields& field) {
  field("beamformer", detector.beamformer, "of the arrays");
  if (const auto only = field.only("beamformer", detector.beamformer, Beamformer::mvdr))
    detector.mvdr.describe(field);
  field("shading", detector.shading, "of the phones, in conventional beams");
  describe_elevations(field, detector);
  field("max_speed", max_speed, reached_speed,
        "closing or opening, that the Doppler filters reach");
  detector.normaliser.describe(field);
  field("cancel_direct_blast", cancel_direct_blast,
        "take the transmissions' own sound out of the record first; auto: where echoes come while "
        "a transmitter sends on");
  field("sub_bands", detector.sub_bands, 1, 256,
        "of equal energy that a pulse is cut into: their powers are averaged, for pulses longer "
        "than echoes stay coherent");
  field("from", detector.first_time, since_ping,
        "nothing is detected before, after the ping's start; default: the pulse's duration, or 0 "
        "where echoes come while the transmitter sends on");
  field("until", detector.last_time, since_ping,
        "nor after; default: the record's end, less the pulse where the transmitter sends on");
  field("target_depth", target_depth, quantity::depth,
        "depth of what answers; default: where the ray came from if the array tells elevation, "
        "else 100 m");
  field("range_speed", range_speed, {.noun = "speed", .unit = "m/s", .low = 1000.0, .high = 2000.0},
        "straight rays of this speed, instead of the scenario's sound paths");
}

void MvdrSettings::describe(Fields& field) {
  field("mvdr_loading_db", loading_db,
        {.noun = "loading", .unit = "dB", .low = -120.0, .high = 60.0},
        "diagonal loading, re the mean power of a phone");
}

void NormaliserSettings::describe(Fields& field) {
  field("normaliser", method, "estimate of the background");
  field("across_beams", across_beams,
        "compare a peak with the beams around as well, not with its own alone");
  field("guard_cells", guard_cells, cells_beside,
        "left out on either side, at least; of pulses whose filter answers longer, that long");
  field("reference_cells", reference_cells, cells_averaged, "averaged on either side");
  field("false_alarm_probability", false_alarm_probability, false_alarm_probability_of_cell,
        "of a cell of Rayleigh background");
}

void TrackerSettings::describe(Fields& field) {
  describe_start(field, *this);
  field("track_stop", stop_misses, 1, 1000, "and ends after so many pings without a hit");
  field("track_acceleration", acceleration,
        {.noun = "acceleration", .unit = "m/s2 sqrt(s)", .low = 1e-6, .high = 1e6},
        "of targets, root of its density");
  field("track_max_speed", max_speed, target_speed, "of targets");
}

}  // namespace asdic::detail
