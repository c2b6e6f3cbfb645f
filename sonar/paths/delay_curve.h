#pragma once
#include <array>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "sonar/paths/returns.h"
#include "sonar/scenario/track.h"

namespace asdic::detail {

/// What becomes of one moment of the pulse on a path whose ends all move. Times since the leading
/// edge left [s], slownesses [s/m].
struct PulseMoment {
  double sent = 0.0;
  double struck = 0.0;           ///< the target (on a direct path: when it is received)
  double received = 0.0;         ///< at the array's reference point
  Vec3 lag = Vec3::Zero();       ///< of the body's points (BodyLag::per_offset)
  Vec3 at_array = Vec3::Zero();  ///< as the moving array meets it (met_by())
};

/// When what is received was sent, s₊(u(t)), where a constant Doppler factor u = η(t − τ) is not
/// enough: ranges change at changing rates, and things turn at their waypoints.
///
/// Cubics through four Chebyshev–Lobatto points of every segment between two turns. Source:
/// docs/theory/echoes.md, "No stop and hop"
class DelayCurve {
 public:
  /// One segment: times, increasing [s], and the slowness at its ends [s/m].
  struct Piece {
    std::array<double, 4> received, sent;
    Vec3 first_slowness = Vec3::Zero(), last_slowness = Vec3::Zero();
  };
  explicit DelayCurve(std::vector<Piece> pieces);

  /// u(t − s(t)·x): when was sent what a phone receives. Before the first and after the last
  /// segment these go on. \param received  t, since the leading edge left [s]   \param phone  x,
  /// from the reference point [m]
  [[nodiscard]] double sent_at(double received, const Vec3& phone) const noexcept;
  /// The same of the reference point at many times. \param received  [n] increasing   \param sent
  /// [n]
  void sent_at(std::span<const double> received, std::span<double> sent) const noexcept;
  [[nodiscard]] double first_received() const noexcept { return pieces_.front().received.front(); }
  [[nodiscard]] double last_received() const noexcept { return pieces_.back().received.back(); }
  [[nodiscard]] const std::vector<Piece>& pieces() const noexcept { return pieces_; }

 private:
  std::vector<Piece> pieces_;
  /// Newton's divided differences of u over `received`, from the second on: [pieces]
  std::vector<std::array<double, 3>> differences_;
};

/// A return whose delay is a curve: a phone at x receives Re{amplitude · s₊(u(t − s(t)·x))}.
struct CurvedReturn {
  Return straight;  ///< what the leading edge would have: delay, Doppler factor, slowness
  DelayCurve curve;
};

/// Phase that may be neglected: −60 dB of the echo [rad].
inline constexpr double negligible_phase = 1e-3;

/// A path whose ends all move, to be asked about any moment of the pulse.
struct MovingPath {
  /// Null if the path is not there by then.
  std::function<std::optional<PulseMoment>(double sent)> moment;
  double pulse_duration = 0.0;  ///< T [s]
  double frequency = 0.0;       ///< highest of the pulse [Hz]
  /// Turns of the transmitter, the target and the array, since the leading edge left [s]
  std::vector<double> source_course_changes, target_course_changes, array_course_changes;
};

/// How far the phase can be from that of a constant Doppler factor, 2πf·T·(½T·κ + |x|·v/(rc)),
/// κ = Σ_legs v²/(rc): a bound for straight rays, times four for curved ones. One leg's part.
/// \param speed  of its ends against one another [m/s]   \param length  of the path [m]
/// \param aperture  radius of the array and of the body [m]
[[nodiscard]] double curvature_phase(double frequency, double duration, double speed, double length,
                                     double sound_speed, double aperture) noexcept;

/// The moments of the ends of all segments and of two points within each. \return empty if the
/// path is lost on the way
[[nodiscard]] std::vector<PulseMoment> pulse_moments(const MovingPath& path);

/// The curve through those moments, as a highlight of the target at `offset` (map axes) sends them
/// back. \param aside  change of the slowness for that offset (SeenAside)
/// \return nothing where a constant Doppler factor does
[[nodiscard]] std::optional<DelayCurve> delay_curve(const std::vector<PulseMoment>& moments,
                                                    const Return& straight, const Vec3& offset,
                                                    const Vec3& aside, double frequency,
                                                    double aperture);

/// The waypoints at which a track changes its velocity [s], counted from `start`.
[[nodiscard]] std::vector<double> course_changes_of(const Track& track, double start);

}  // namespace asdic::detail
