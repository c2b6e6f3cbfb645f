#include "processing/tracker.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "processing/assignment.h"

namespace asdic::detail {
namespace {

/// What a contact would be if the target were there.
Eigen::Vector3d measured(const SmallMatrix<4, 1>& state, const Contact& c,
                         SmallMatrix<3, 4>* slope) {
  const Vec2 position = state.head<2>(), velocity = state.tail<2>();
  const Vec2 from_array = position - c.array, from_source = position - c.source;
  const double range = std::max(from_array.norm(), 1e-3);
  const double way_out = std::max(from_source.norm(), 1e-3);
  const Vec2 home = from_array / range, out = from_source / way_out;
  const Vec2 v_home = velocity - c.array_velocity, v_out = velocity - c.source_velocity;
  if (slope != nullptr) {
    slope->setZero();
    // ∂β/∂(x, y) for a bearing from north, clockwise
    (*slope)(0, 0) = from_array.y() / (range * range);
    (*slope)(0, 1) = -from_array.x() / (range * range);
    slope->block<1, 2>(1, 0) = home.transpose();
    const Vec2 turning =
        (v_home - home * home.dot(v_home)) / range + (v_out - out * out.dot(v_out)) / way_out;
    slope->block<1, 2>(2, 0) = 0.5 * turning.transpose();
    slope->block<1, 2>(2, 2) = 0.5 * (home + out).transpose();
  }
  // Range rate: half the rate at which the way out and back grows.
  return {std::atan2(from_array.x(), from_array.y()), range,
          0.5 * (v_home.dot(home) + v_out.dot(out))};
}

/// R = M·diag(σ²)·Mᵀ, docs/theory/processing.md, eq. (12)
Eigen::Matrix3d noise(const Contact& c) {
  Eigen::Matrix3d mix = Eigen::Matrix3d::Identity();  // of the errors of bearing, range, range rate
  mix(1, 0) = c.range_per_bearing;
  mix(1, 2) = c.range_per_rate;
  const Eigen::Vector3d sigma(c.bearing_sigma, c.range_sigma, c.range_rate_sigma);
  return mix * sigma.cwiseAbs2().asDiagonal() * mix.transpose();
}

/// What range and range rate are more than their slopes say, ½·xᵀ·H·x for an error x of the state,
/// by its covariance P: mean ½·tr(H_i·P), covariance ½·tr(H_i·P·H_j·P). (The bearing's is small.)
/// Bar-Shalom, Li & Kirubarajan (2001), 10.3.2.
struct Curvature {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();

  Curvature(const TrackState& state, const Contact& c) {
    if (!c.bearing_known) return;
    const auto across = [&](const Vec2& platform) -> Eigen::Matrix2d {  // ∂²|x|/∂x∂xᵀ
      const Vec2 way = state.mean.head<2>() - platform;
      const double range = std::max(way.norm(), 1e-3);
      const Vec2 beside(way.y() / range, -way.x() / range);
      return beside * beside.transpose() / range;
    };
    const Eigen::Matrix2d home = across(c.array), both = 0.5 * (home + across(c.source));
    SmallMatrix<4, 4> of_range = SmallMatrix<4, 4>::Zero(), of_rate = of_range;
    of_range.topLeftCorner<2, 2>() = home;
    of_rate.topRightCorner<2, 2>() = of_rate.bottomLeftCorner<2, 2>() = both;
    const SmallMatrix<4, 4> range = of_range * state.covariance, rate = of_rate * state.covariance;
    mean[1] = 0.5 * range.trace();
    mean[2] = 0.5 * rate.trace();
    covariance(1, 1) = 0.5 * (range * range).trace();
    covariance(2, 2) = 0.5 * (rate * rate).trace();
    covariance(1, 2) = covariance(2, 1) = 0.5 * (range * rate).trace();
  }
};

/// A track while it is made.
struct Candidate {
  TrackState state;
  ContactTrack track;
  int age = 1, hits = 1, misses = 0;  // pings
  bool believed = false;
};

class Tracker {
 public:
  explicit Tracker(const TrackerSettings& settings) : settings_(settings) {}

  void ping(int index, double time, std::span<const Contact> contacts) {
    std::vector<char> taken(contacts.size(), 0);
    hit_.assign(open_.size(), 0);
    associate(true, index, contacts, taken);
    associate(false, index, contacts, taken);
    for (std::size_t i = 0; i < open_.size(); ++i)
      if (hit_[i] == 0) miss(open_[i], index, time);
    std::erase_if(open_, [&](Candidate& c) { return ends(c); });
    drop_duplicates();
    for (std::size_t j = 0; j < contacts.size(); ++j)
      if (taken[j] == 0 && !belongs(contacts[j])) begin(index, contacts[j], static_cast<int>(j));
  }

  std::vector<ContactTrack> finish() {
    for (Candidate& c : open_)
      if (c.believed) done_.push_back(std::move(c.track));
    for (ContactTrack& track : done_)  // ends with its last hit
      while (track.points.back().detection < 0) track.points.pop_back();
    std::sort(done_.begin(), done_.end(),
              [](const ContactTrack& a, const ContactTrack& b) { return a.number < b.number; });
    for (std::size_t i = 0; i < done_.size(); ++i) done_[i].number = static_cast<int>(i) + 1;
    return std::move(done_);
  }

 private:
  void associate(bool believed, int index, std::span<const Contact> contacts,
                 std::vector<char>& taken) {
    std::vector<std::size_t> rows;
    for (std::size_t i = 0; i < open_.size(); ++i)
      if (open_[i].believed == believed) rows.push_back(i);
    if (rows.empty() || contacts.empty()) return;
    std::vector<double> cost(rows.size() * contacts.size(), infinity);
    for (std::size_t r = 0; r < rows.size(); ++r)
      for (std::size_t j = 0; j < contacts.size(); ++j) {
        if (taken[j] != 0) continue;
        TrackState state = open_[rows[r]].state;
        state.predict(contacts[j].time, settings_.acceleration);
        const auto innovation = state.innovation(contacts[j]);
        const double distance = innovation.distance();
        // The likelihood's exponent: distance and how much is expected to fall in the gate.
        if (distance < settings_.gate)
          cost[r * contacts.size() + j] =
              distance + std::log(innovation.covariance.determinant()) + 100.0;
      }
    const std::vector<int> columns =
        assign(cost, static_cast<int>(rows.size()), static_cast<int>(contacts.size()));
    for (std::size_t r = 0; r < rows.size(); ++r) {
      if (columns[r] < 0) continue;
      const auto j = static_cast<std::size_t>(columns[r]);
      Candidate& c = open_[rows[r]];
      c.state.predict(contacts[j].time, settings_.acceleration);
      c.state.update(c.state.innovation(contacts[j]));
      taken[j] = 1;
      hit_[rows[r]] = 1;
      ++c.age;
      ++c.hits;
      c.misses = 0;
      note(c, index, contacts[j].detection);
      if (c.hits >= settings_.start_hits) c.believed = true;
    }
  }

  void miss(Candidate& c, int index, double time) {
    c.state.predict(std::max(time, c.state.time), settings_.acceleration);
    ++c.age;
    ++c.misses;
    note(c, index, -1);
  }

  /// Whether a track is over; one that was believed is kept.
  bool ends(Candidate& c) {
    if (!c.believed) {
      const int left = settings_.start_pings - c.age;
      return c.hits + left < settings_.start_hits;
    }
    if (c.misses < settings_.stop_misses) return false;
    done_.push_back(std::move(c.track));
    return true;
  }

  /// Two candidates that agree are one: the older, or the one with more hits, stays.
  void drop_duplicates() {
    for (std::size_t i = 0; i < open_.size(); ++i)
      for (std::size_t j = i + 1; j < open_.size();) {
        const SmallMatrix<4, 1> off = open_[i].state.mean - open_[j].state.mean;
        const SmallMatrix<4, 4> both = open_[i].state.covariance + open_[j].state.covariance;
        const bool same = !open_[j].believed && off.dot(both.ldlt().solve(off)) < 4.0;
        if (same)
          open_.erase(open_.begin() + static_cast<std::ptrdiff_t>(j));
        else
          ++j;
      }
  }

  /// Whether a believed track explains a contact that it was not updated with (another path of the
  /// same echo).
  [[nodiscard]] bool belongs(const Contact& contact) const {
    return std::any_of(open_.begin(), open_.end(), [&](const Candidate& c) {
      if (!c.believed) return false;
      TrackState state = c.state;
      state.predict(std::max(contact.time, state.time), settings_.acceleration);
      return state.innovation(contact).distance() < settings_.gate;
    });
  }

  void begin(int index, const Contact& contact, int) {
    Candidate c;
    c.state = TrackState::from(contact, settings_.max_speed);
    c.track.number = ++begun_;
    c.believed = settings_.start_hits <= 1;
    note(c, index, contact.detection);
    open_.push_back(std::move(c));
  }

  static void note(Candidate& c, int index, int detection) {
    const auto& p = c.state.covariance;
    c.track.points.push_back({.ping = index,
                              .detection = detection,
                              .time = c.state.time,
                              .position = c.state.mean.head<2>(),
                              .velocity = c.state.mean.tail<2>(),
                              .position_sigma = std::sqrt(p(0, 0) + p(1, 1)),
                              .velocity_sigma = std::sqrt(p(2, 2) + p(3, 3))});
  }

  TrackerSettings settings_;
  std::vector<Candidate> open_;
  std::vector<char> hit_;
  std::vector<ContactTrack> done_;
  int begun_ = 0;
};

}  // namespace

void TrackState::predict(double to, double acceleration) {
  const double t = to - time;
  SmallMatrix<4, 4> step = SmallMatrix<4, 4>::Identity();
  step(0, 2) = step(1, 3) = t;
  // White acceleration of density q: ∫ of (t, 1)(t, 1)ᵀ.
  const double q = acceleration * acceleration, length = std::abs(t);
  SmallMatrix<4, 4> noise = SmallMatrix<4, 4>::Zero();
  for (int i = 0; i < 2; ++i) {
    noise(i, i) = q * length * length * length / 3.0;
    noise(i, i + 2) = noise(i + 2, i) = q * length * t / 2.0;
    noise(i + 2, i + 2) = q * length;
  }
  mean = step * mean;
  covariance = step * covariance * step.transpose() + noise;
  time = to;
}

double TrackState::Innovation::distance() const {
  return residual.dot(covariance.ldlt().solve(residual));
}

TrackState::Innovation TrackState::innovation(const Contact& contact) const {
  Innovation result;
  const Eigen::Vector3d expected = measured(mean, contact, &result.slope);
  const Curvature curved(*this, contact);
  result.residual = Eigen::Vector3d(std::remainder(contact.bearing - expected[0], 2.0 * pi),
                                    contact.range - expected[1], contact.range_rate - expected[2]) -
                    curved.mean;
  result.noise = noise(contact) + curved.covariance;
  result.covariance = result.slope * covariance * result.slope.transpose() + result.noise;
  return result;
}

void TrackState::update(const Innovation& innovation) {
  const SmallMatrix<4, 3> gain =
      innovation.covariance.ldlt().solve(innovation.slope * covariance).transpose();
  mean += gain * innovation.residual;
  const SmallMatrix<4, 4> left = SmallMatrix<4, 4>::Identity() - gain * innovation.slope;
  covariance = left * covariance * left.transpose() + gain * innovation.noise * gain.transpose();
}

TrackState TrackState::from(const Contact& c, double max_speed) {
  TrackState state;
  state.time = c.time;
  const Vec2 home(std::sin(c.bearing), std::cos(c.bearing)), across(home.y(), -home.x());
  const Vec2 from_source = c.array + c.range * home - c.source;
  const Vec2 out = from_source / std::max(from_source.norm(), 1e-3);
  // v·(home + out)/2 = range rate + what the platforms do to it
  const Vec2 along = 0.5 * (home + out);
  const double slope = std::max(along.norm(), 0.1);
  const Vec2 unit = along.normalized(), beside(unit.y(), -unit.x());
  const double measured_speed =
      (c.range_rate + 0.5 * (c.array_velocity.dot(home) + c.source_velocity.dot(out))) / slope;
  // Speed along: measured with the variance S, before that 0 with the variance P. What of the
  // measured one is error, by this, is one of range as well.
  const double likely = std::pow(0.5 * max_speed, 2.0),
               noise = std::pow(c.range_rate_sigma / slope, 2.0);
  const double speed =
      std::clamp(measured_speed * likely / (likely + noise), -max_speed, max_speed);
  const double range_per_speed = c.range_per_rate * slope;
  state.mean.head<2>() = c.array + (c.range - range_per_speed * (measured_speed - speed)) * home;
  state.mean.tail<2>() = speed * unit;
  // Independent errors of bearing, range, speed along and across: of place and velocity.
  const double speed_sigma = std::sqrt(likely * noise / (likely + noise));
  const Vec2 turned = std::max(c.range * c.bearing_sigma, 1e-3) * across +
                      c.range_per_bearing * c.bearing_sigma * home;
  SmallMatrix<4, 4> errors;
  errors.row(0) << turned.x(), c.range_sigma * home.x(), range_per_speed * speed_sigma * home.x(),
      0.0;
  errors.row(1) << turned.y(), c.range_sigma * home.y(), range_per_speed * speed_sigma * home.y(),
      0.0;
  errors.row(2) << 0.0, 0.0, speed_sigma * unit.x(), 0.5 * max_speed * beside.x();
  errors.row(3) << 0.0, 0.0, speed_sigma * unit.y(), 0.5 * max_speed * beside.y();
  state.covariance = errors * errors.transpose();
  return state;
}

std::vector<ContactTrack> track_contacts(std::span<const std::vector<Contact>> pings,
                                         std::span<const double> ping_times,
                                         const TrackerSettings& settings) {
  Tracker tracker(settings);
  for (std::size_t i = 0; i < pings.size(); ++i)
    tracker.ping(static_cast<int>(i), ping_times[i], pings[i]);
  return tracker.finish();
}

}  // namespace asdic::detail
