#pragma once
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/units.h"
#include "sonar/scenario/track.h"

namespace asdic::detail {

class Fields;

/// Strength over aspect: 0 is the bow, π/2 the starboard beam, π the stern. Straight lines in dB.
///
/// A table that ends at or before π holds for both sides; one that goes further is of the whole
/// circle and closes on itself. Outside its angles its first and last values go on.
struct AspectTable {
  std::vector<double> aspect;       ///< [n] strictly increasing, 0 … 2π [rad]
  std::vector<double> strength_db;  ///< [n]

  void describe(Fields& field);
  [[nodiscard]] double at(double aspect) const noexcept;  ///< \param aspect any angle [rad]
};

/// One place of a body that sends sound back.
struct Highlight {
  Vec3 offset = Vec3::Zero();  ///< forward, starboard, down of the body's reference point [m]
  double strength_db = 0.0;    ///< TS of it alone, where there is no table [dB]
  std::optional<AspectTable> aspect;

  void describe(Fields& field);
};

/// The hull that hides highlights: an ellipse seen from above.
struct Hull {
  double length = 100.0, beam = 10.0;  ///< whole axes [m]

  void describe(Fields& field);
};

/// How the strength changes from ping to ping. The power of every highlight is exponential with its
/// strength as mean (1, 2) or chi-square with four degrees of freedom (3, 4), its phase uniform;
/// one draw lasts a scan (1, 3) or a ping (2, 4). Swerling, IRE Trans. IT-6, 269 (1960).
enum class Fluctuation { none, swerling_1, swerling_2, swerling_3, swerling_4 };
inline constexpr std::string_view fluctuation_words[] = {"none", "swerling-1", "swerling-2",
                                                         "swerling-3", "swerling-4"};
constexpr std::span<const std::string_view> words(Fluctuation /*any*/) { return fluctuation_words; }

/// A point, or a rigid body with highlights that is level and heads where it goes.
struct Target {
  std::string name = "target";
  Track track;                                      ///< of its reference point
  double strength_db = 10.0;                        ///< TS, without highlights and table [dB]
  int first_ping = 1;                               ///< the target is there from this ping …
  int last_ping = std::numeric_limits<int>::max();  ///< … to this one
  std::optional<double> heading;                    ///< [rad]; none: its course
  std::optional<AspectTable> aspect;                ///< of the whole, without highlights
  std::vector<Highlight> highlights;
  std::optional<Hull> hull;  ///< hides highlights; none: all are seen
  Fluctuation fluctuation = Fluctuation::none;
  int scan_pings = 1;  ///< pings of one transmitter in turn that make a scan

  void describe(Fields& field);
};

/// Where the bow points at a time [rad, clockwise from north].
[[nodiscard]] double heading_of(const Target& target, double time);

/// From the body's axes (forward, starboard, down) to the map's (east, north, down).
[[nodiscard]] Vec3 from_body(const Vec3& offset, double heading) noexcept;

/// The aspect of a pair of paths: of the bisector of the horizontal directions to where the sound
/// comes from and to where it goes, which is that of a sonar at both for nearby ones. Where they
/// are opposite (forward scattering) it is the first. \param in, out  directions of travel, any
/// length   \return [0, 2π)
[[nodiscard]] double aspect_of(const Vec3& in, const Vec3& out, double heading) noexcept;

/// Whether more than three quarters of a beam of hull lies in the way from a place on or in it.
/// \param offset  of the place, body's axes [m]   \param aspect  of the direction [rad]
[[nodiscard]] bool hidden(const Hull& hull, const Vec3& offset, double aspect) noexcept;

/// TS of the whole at one aspect, its highlights' powers added [dB].
[[nodiscard]] double strength_db(const Target& target, double aspect);
/// The same as a sonar at `place` sees it at a time.
[[nodiscard]] double strength_towards(const Target& target, const Vec3& place, double time);

}  // namespace asdic::detail
