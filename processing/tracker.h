#pragma once
#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/units.h"

namespace asdic::detail {

/// A located detection, as a tracker takes it.
struct Contact {
  int detection = -1;  ///< its index, for whoever made it
  double time = 0.0;   ///< when the sound struck it, since the start of the scenario [s]
  double bearing = 0.0, range = 0.0, range_rate = 0.0;  ///< [rad], [m], [m/s] as in Location
  double bearing_sigma = 0.0, range_sigma = 0.0, range_rate_sigma = 0.0;
  /// Errors of bearing and range rate that are errors of range as well: dr = ε_r +
  /// range_per_rate·ε_ṙ
  /// + range_per_bearing·ε_β, where `range_sigma` is of ε_r alone. A sweep's delay goes with its
  /// Doppler factor along its ridge [m per m/s]; the range of a pair that lies apart with the
  /// bearing, along the ellipse of its delay [m/rad].
  double range_per_rate = 0.0, range_per_bearing = 0.0;
  bool bearing_known = true;  ///< false: along one line, `bearing`, which it never leaves
  Vec2 array = Vec2::Zero(), array_velocity = Vec2::Zero();    ///< when it received (east, north)
  Vec2 source = Vec2::Zero(), source_velocity = Vec2::Zero();  ///< when it sent
};

class Fields;

struct TrackerSettings {
  int start_hits = 3, start_pings = 4;  ///< a track is believed after m hits in its first n pings
  int stop_misses = 4;         ///< and ends after so many pings without a hit, one after the other
  double gate = 16.0;          ///< largest squared Mahalanobis distance of a hit (χ², 3 degrees)
  double acceleration = 0.02;  ///< of a target, root of its density over a second [m/s²]
  double max_speed = 15.0;     ///< of a target [m/s]

  void describe(Fields& field);
};

struct TrackPoint {
  int ping = 0;        ///< index of the ping, from 0
  int detection = -1;  ///< that it was updated with; −1: none, coasted
  double time = 0.0;   ///< since the start of the scenario [s]
  Vec2 position = Vec2::Zero(), velocity = Vec2::Zero();  ///< [m], [m/s] (east, north)
  double position_sigma = 0.0;  ///< root of the trace of the position's covariance [m]
  double velocity_sigma = 0.0;
};

/// What is believed to be one thing over several pings; ends with its last hit.
struct ContactTrack {
  int number = 0;  ///< from 1, in the order in which they begin
  std::vector<TrackPoint> points;
};

/// State (x, y, v_x, v_y) and covariance.
struct TrackState {
  SmallMatrix<4, 1> mean = SmallMatrix<4, 1>::Zero();
  SmallMatrix<4, 4> covariance = SmallMatrix<4, 4>::Zero();
  double time = 0.0;  ///< [s]

  /// Constant velocity with white acceleration. \param acceleration  [m/s²·√s]
  void predict(double to, double acceleration);
  /// Innovation, its covariance and the measurement's slope for a contact; to the second order, for
  /// a place that is known to 300 m across at 8 km is 6 m further away than it looks.
  struct Innovation {
    Eigen::Vector3d residual;
    Eigen::Matrix3d noise;       ///< the contact's, and what the slope leaves out
    Eigen::Matrix3d covariance;  ///< of the residual
    SmallMatrix<3, 4> slope;
    [[nodiscard]] double distance() const;  ///< squared, Mahalanobis
  };
  [[nodiscard]] Innovation innovation(const Contact& contact) const;
  /// Extended Kalman filter, Joseph's form.
  void update(const Innovation& innovation);
  /// From one contact: its place, any speed across, and along it what its range rate tells beside
  /// what a target may do, a deviation of half the greatest speed; the range goes with it.
  [[nodiscard]] static TrackState from(const Contact& contact, double max_speed);
};

/// Tracks over pings: extended Kalman filters on bearing, range and range rate; contacts go to
/// tracks by the cheapest assignment of all (global nearest neighbour), tracks that are believed
/// first; a contact that no track wants begins one. Bar-Shalom, Li & Kirubarajan, Estimation with
/// Applications to Tracking and Navigation (2001), ch. 5, 10. docs/theory/processing.md, eq.
/// (9)–(11) \param pings       [pings] contacts of each, in order of time   \param ping_times
/// [pings] [s]
[[nodiscard]] std::vector<ContactTrack> track_contacts(std::span<const std::vector<Contact>> pings,
                                                       std::span<const double> ping_times,
                                                       const TrackerSettings& settings);

}  // namespace asdic::detail
