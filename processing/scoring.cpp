#include "processing/scoring.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/geometry.h"

namespace asdic::detail {
namespace {

/// How far a direction is from where an echo comes from, in what the array can tell.
double off_direction(const Detection& d, const TrueEcho& echo, const ArrayShape& shape,
                     double direction) {
  const Vec3 from = -echo.travel;
  switch (shape.kind) {
    case ArrayKind::point:
      return 0.0;
    case ArrayKind::line:
      return std::abs(from.dot(shape.axis) - d.cosine);
    case ArrayKind::plane: {
      // The components in the plane, each by its own extent; at most the side is asked for.
      const double across = std::abs((from - d.look).dot(shape.across));
      const double cell = std::min(1.0, direction * shape.length / shape.width);
      return std::max(std::abs((from - d.look).dot(shape.axis)), across * direction / cell);
    }
    case ArrayKind::volume:
      return std::acos(std::clamp(from.dot(d.look), -1.0, 1.0));
  }
  return 0.0;
}

/// By so much an echo may be louder than its paths' levels say, or a little below its threshold:
/// paths and noise add up by chance.
constexpr double level_room_db = 10.0;

/// What a target's paths within a cell amount to.
struct Together {
  double in_phase_db = 0.0;  ///< amplitudes added
  double power_db = 0.0;     ///< powers added
};

Together together(std::span<const TrueEcho> echoes, const TrueEcho& echo, double cell) {
  if (!std::isfinite(echo.level_db)) return {.in_phase_db = infinity, .power_db = infinity};
  double amplitude = 0.0, power = 0.0;
  for (const TrueEcho& other : echoes)
    if (other.target == echo.target && std::abs(other.time - echo.time) <= cell) {
      amplitude += amplitude_from_db(other.level_db);
      power += power_from_db(other.level_db);
    }
  return {.in_phase_db = db_from_amplitude(amplitude), .power_db = db_from_power(power)};
}

}  // namespace

PingScore score_detections(std::span<const Detection> detections, std::span<const TrueEcho> echoes,
                           std::span<const TrueTarget> targets, const ArrayShape& shape,
                           const Track& array, const Resolution& resolution, double first,
                           double last) {
  PingScore score;
  score.owner.assign(detections.size(), -1);
  for (std::size_t i = 0; i < detections.size(); ++i) {
    const Detection& d = detections[i];
    double loudest = -infinity;
    for (const TrueEcho& echo : echoes) {
      const double off = std::isnan(echo.doppler) ? 0.0 : d.doppler - echo.doppler;
      const double along_ridge = resolution.delay_per_doppler * off;
      double late = d.time - echo.time - along_ridge;
      if (resolution.curved) {
        const double other = d.time - echo.time;
        late = late * other < 0.0 ? 0.0 : std::min(std::abs(late), std::abs(other));
      }
      if (std::abs(late) > resolution.time || std::abs(off) > resolution.doppler ||
          off_direction(d, echo, shape, resolution.direction) > resolution.direction ||
          echo.level_db <= loudest)
        continue;
      const double most = together(echoes, echo, resolution.time).in_phase_db + level_room_db;
      if (most < std::max(d.level_db, echo.threshold_db)) continue;
      loudest = echo.level_db;
      score.owner[i] = echo.target;
    }
    if (score.owner[i] == -1) ++score.false_alarms;
  }
  for (const TrueTarget& target : targets) {
    TargetScore row{.target = target.target,
                    .present = target.present,
                    .position_error = std::nan(""),
                    .range_error = std::nan(""),
                    .bearing_error = std::nan("")};
    row.detectable = std::any_of(echoes.begin(), echoes.end(), [&](const TrueEcho& echo) {
      return echo.target == target.target && echo.time >= first && echo.time <= last &&
             together(echoes, echo, resolution.time).power_db >= echo.threshold_db;
    });
    for (std::size_t i = 0; i < detections.size(); ++i)
      if (score.owner[i] == target.target &&
          (row.detection < 0 ||
           detections[i].snr_db > detections[static_cast<std::size_t>(row.detection)].snr_db))
        row.detection = static_cast<int>(i);
    row.hit = row.detection >= 0;
    row.detectable = row.detectable || row.hit;  // by luck
    if (target.present && row.detectable) ++(row.hit ? score.hits : score.misses);
    if (row.hit) {
      const Detection& own = detections[static_cast<std::size_t>(row.detection)];
      const Vec3 received_at = array.at(own.time).position;
      const Separation truth = separation(received_at, target.position);
      row.from_array = (target.position - received_at).head<2>();
      for (const Location& place : own.locations) {
        const Vec3 off = place.position - target.position;
        const double error = std::isnan(place.bearing) ? std::abs(place.range - truth.range)
                                                       : std::hypot(off.x(), off.y());
        if (!std::isnan(row.position_error) && error >= row.position_error) continue;
        const Separation seen = separation(received_at, place.position);
        row.position_error = std::isnan(place.bearing) ? std::nan("") : error;
        if (!std::isnan(place.bearing)) row.error = off.head<2>();
        row.range_error = (std::isnan(place.bearing) ? place.range : seen.range) - truth.range;
        row.bearing_error = std::isnan(place.bearing)
                                ? std::nan("")
                                : std::remainder(seen.bearing - truth.bearing, 2.0 * pi);
      }
    }
    score.targets.push_back(row);
  }
  return score;
}

}  // namespace asdic::detail
