#include "sonar/paths/delay_curve.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/units.h"

namespace asdic::detail {
namespace {

constexpr std::size_t points = 4;                                    // of a segment
constexpr std::array<double, points> lobatto{0.0, 0.25, 0.75, 1.0};  // (1 − cos kπ/3)/2

/// The moment of the pulse that meets a turn: `when(moment)` = turn, by regula falsi (Illinois) to
/// 1 ns: u ↦ t is straight but for the turn's own corner. Null outside (first, last).
std::optional<double> sent_at_change(const MovingPath& path, const PulseMoment& first,
                                     const PulseMoment& last, double PulseMoment::*when,
                                     double change) {
  double low = first.sent, high = last.sent, below = first.*when - change,
         above = last.*when - change;
  if (!(below < 0.0 && above > 0.0)) return std::nullopt;
  int kept = 0;  // the end that stayed: −1 the low one, +1 the high one
  for (int i = 0; i < 60 && high - low > 1e-9; ++i) {
    const double sent = low + (high - low) * below / (below - above);
    const auto between = path.moment(sent);
    if (!between) return std::nullopt;
    const double miss = (*between).*when - change;
    if (std::abs(miss) < 1e-9) return sent;
    if (miss < 0.0) {
      low = sent, below = miss;
      if (std::exchange(kept, 1) == 1) above *= 0.5;
    } else {
      high = sent, above = miss;
      if (std::exchange(kept, -1) == -1) below *= 0.5;
    }
  }
  return 0.5 * (low + high);
}

}  // namespace

DelayCurve::DelayCurve(std::vector<Piece> pieces) : pieces_(std::move(pieces)) {
  for (const Piece& piece : pieces_) {
    std::array<double, points> d = piece.sent;
    for (std::size_t order = 1; order < points; ++order)
      for (std::size_t k = points - 1; k >= order; --k)
        d[k] = (d[k] - d[k - 1]) / (piece.received[k] - piece.received[k - order]);
    differences_.push_back({d[1], d[2], d[3]});
  }
}

double DelayCurve::sent_at(double received, const Vec3& phone) const noexcept {
  const bool elsewhere = !(phone.x() == 0.0 && phone.y() == 0.0 && phone.z() == 0.0);
  const auto piece = std::find_if(pieces_.begin(), std::prev(pieces_.end()), [&](const Piece& p) {
    return received - p.last_slowness.dot(phone) <= p.received.back();
  });
  double t = received;
  if (elsewhere) {
    // Over the array the slowness changes by parts of 1e-5: that of t does for t − s·x.
    const double share =
        (received - piece->received.front()) / (piece->received.back() - piece->received.front());
    t -= piece->first_slowness.dot(phone) +
         share * (piece->last_slowness - piece->first_slowness).dot(phone);
  }
  // u = u₀ + (t − t₀)·(d₁ + (t − t₁)·(d₂ + (t − t₂)·d₃))
  const auto& d = differences_[static_cast<std::size_t>(piece - pieces_.begin())];
  const auto& at = piece->received;
  return piece->sent[0] + (t - at[0]) * (d[0] + (t - at[1]) * (d[1] + (t - at[2]) * d[2]));
}

void DelayCurve::sent_at(std::span<const double> received, std::span<double> sent) const noexcept {
  for (std::size_t begin = 0, end = 0, p = 0; begin < received.size(); begin = end, ++p) {
    const Piece& piece = pieces_[p];
    end = p + 1 == pieces_.size()
              ? received.size()
              : static_cast<std::size_t>(
                    std::upper_bound(received.begin(), received.end(), piece.received.back()) -
                    received.begin());
    const auto& d = differences_[p];
    const auto& at = piece.received;
    for (std::size_t i = begin; i < end; ++i) {
      const double t = received[i];
      sent[i] = piece.sent[0] + (t - at[0]) * (d[0] + (t - at[1]) * (d[1] + (t - at[2]) * d[2]));
    }
  }
}

double curvature_phase(double frequency, double duration, double speed, double length,
                       double sound_speed, double aperture) noexcept {
  constexpr double curved_rays = 4.0;
  const double turning = speed / (std::max(length, 1.0) * sound_speed);  // of the slowness [1/m]
  return curved_rays * 2.0 * pi * frequency * duration * turning *
         (0.5 * duration * speed + aperture);
}

std::vector<PulseMoment> pulse_moments(const MovingPath& path) {
  const auto first = path.moment(0.0), last = path.moment(path.pulse_duration);
  if (!first || !last) return {};
  std::vector<double> ends{0.0, path.pulse_duration};
  const auto add = [&](const std::vector<double>& course_changes, double PulseMoment::*when) {
    for (const double change : course_changes)
      if (const auto sent = sent_at_change(path, *first, *last, when, change))
        ends.push_back(*sent);
  };
  for (const double change : path.source_course_changes)
    if (change > 0.0 && change < path.pulse_duration) ends.push_back(change);
  add(path.target_course_changes, &PulseMoment::struck);
  add(path.array_course_changes, &PulseMoment::received);
  std::sort(ends.begin(), ends.end());
  std::vector<PulseMoment> moments;
  for (std::size_t i = 1; i < ends.size(); ++i) {
    const double length = ends[i] - ends[i - 1];
    if (length < 1e-6) continue;
    for (const double share : lobatto) {
      const double sent = ends[i - 1] + share * length;
      const auto moment = sent == first->sent  ? first
                          : sent == last->sent ? last
                                               : path.moment(sent);
      if (!moment) return {};
      moments.push_back(*moment);
    }
  }
  return moments;
}

std::optional<DelayCurve> delay_curve(const std::vector<PulseMoment>& moments,
                                      const Return& straight, const Vec3& offset, const Vec3& aside,
                                      double frequency, double aperture) {
  if (moments.empty()) return std::nullopt;
  std::vector<DelayCurve::Piece> pieces;
  double furthest = 0.0, first = 0.0, turned = 0.0;
  for (std::size_t i = 0; i < moments.size(); ++i) {
    const PulseMoment& m = moments[i];
    const Vec3 slowness = m.at_array + aside;
    if (i % points == 0) pieces.emplace_back().first_slowness = slowness;
    pieces.back().last_slowness = slowness;
    turned = std::max(turned, (slowness - straight.slowness).norm());
    const double received = m.received + m.lag.dot(offset);
    if (i == 0) first = received;
    pieces.back().received[i % points] = received;
    pieces.back().sent[i % points] = m.sent;
    furthest = std::max(furthest, std::abs(straight.doppler * (received - first) - m.sent));
  }
  const double phase = 2.0 * pi * frequency * (furthest + turned * aperture);
  if (phase < negligible_phase) return std::nullopt;
  return DelayCurve(std::move(pieces));
}

std::vector<double> course_changes_of(const Track& track, double start) {
  std::vector<double> course_changes;
  for (const Waypoint& point : track.waypoints) course_changes.push_back(point.time - start);
  return course_changes;
}

}  // namespace asdic::detail
