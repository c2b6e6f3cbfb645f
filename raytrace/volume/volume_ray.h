#pragma once
#include <array>
#include <complex>
#include <cstdint>
#include <span>
#include <vector>

#include "raytrace/ocean/arrivals.h"
#include "raytrace/volume/volume_ocean.h"

namespace asdic::detail {

using Mat32 = SmallMatrix<3, 2>;

/// A point of a ray in three dimensions, and how it moves when the ray is launched another way.
/// Columns of x_launch and p_launch are derivatives at a fixed travel time over the two components
/// of the launch direction in launch_basis(): the 2 × 2 spreading matrix in Cartesian coordinates.
struct VolumeState {
  Vec3 x = Vec3::Zero();           ///< [m]
  Vec3 p = Vec3::Zero();           ///< slowness, |p| = 1/c [s/m]
  Mat32 x_launch = Mat32::Zero();  ///< [m/rad]
  Mat32 p_launch = Mat32::Zero();  ///< [s/(m·rad)]
  double time = 0.0;               ///< τ [s]
  double length = 0.0;             ///< [m]
  double nepers = 0.0;             ///< absorption so far
};

/// What happened to a ray before.
struct VolumeHistory {
  std::uint64_t key = 0;     ///< shared by rays that met the same boundaries in the same order
  std::uint64_t facets = 0;  ///< shared by those that met the same facets of the floor
  int surface_bounces = 0, bottom_bounces = 0;
  int upper_turns = 0, lower_turns = 0;
  int caustics = 0;
  std::complex<double> reflection = 1.0;
  double scattered = 0.0;  ///< share of the energy that rough boundaries scattered about the ray
};

/// Where one leg of a ray, from a bounce to the next, comes closest to a receiver.
struct LegPass {
  VolumeState state;
  VolumeHistory history;
  double c = 0.0;           ///< there [m/s]
  double beyond = 0.0;      ///< how far it is off the ends of the leg, which is drawn out straight;
                            ///< 0: on it [m]
  std::size_t bounces = 0;  ///< before
};

/// The key of a history after one more bounce.
[[nodiscard]] constexpr std::uint64_t bounced_key(std::uint64_t key, BoundaryKind kind) noexcept {
  return (key ^ (kind == BoundaryKind::surface ? 0x51ULL : 0xB3ULL)) * 0x9E3779B97F4A7C15ULL + 1;
}

/// How far a ray is followed.
struct VolumeLimits {
  int max_surface_bounces = 3;
  int max_bottom_bounces = 3;
  std::size_t most_bounces = 512;  ///< off both together
  double longest = infinity;       ///< path [m]
  double faintest = 0.0;           ///< product of reflection magnitudes
  double tolerance = 1e-6;         ///< of a step, of the place [m]
  bool losses = true;              ///< reflection coefficients are worked out
};

/// A ray as its legs pass a receiver.
struct VolumeRay {
  double source_speed = 0.0;  ///< [m/s]
  double turned = 0.0;        ///< the most that its bearing differed from the first [rad]
  std::vector<LegPass> legs;  ///< leg i: after i bounces
  std::vector<Bounce> bounces;
  std::vector<Vec3> track;  ///< where asked for: places in order
};

/// A ray as it goes, to say how its legs pass any receiver: all that a search needs of a ray of its
/// mesh, single precision where that does.
struct VolumeCourse {
  struct Knot {
    Vec3 x, p;
    std::array<float, 6> x_launch, p_launch;  // column by column
    double time;
  };
  struct Leg {
    std::uint64_t key, facets;  // VolumeHistory's
    std::size_t begin, end;     // of its knots
    double left;                // of its amplitude after reflections and scattering
    double steep;               // weight of the depth in what is closest
  };
  double turned = 0.0;  // VolumeRay's
  std::vector<Knot> knots;
  std::vector<Leg> legs;
  [[nodiscard]] std::size_t bytes() const noexcept {
    return sizeof *this + knots.capacity() * sizeof(Knot) + legs.capacity() * sizeof(Leg);
  }
};

/// Where a leg of a course comes closest to a receiver.
struct CoursePass {
  Vec3 x;        ///< [m]
  Vec3 tangent;  ///< unit
  Mat32 x_launch;
};
[[nodiscard]] CoursePass course_pass(const VolumeCourse& course, std::size_t leg,
                                     const Vec3& receiver);

/// The unit vectors over which the launch direction is varied: the first raises it, the second
/// turns it clockwise.
[[nodiscard]] Mat32 launch_basis(const Vec3& direction) noexcept;

/// Follows rays through a volume by the eikonal equations, over travel time τ,
///
///   dx/dτ = c²p,   dp/dτ = −∇c/c,
///   dX/dτ = 2c(∇c·X)p + c²P,   dP/dτ = −(∇∇c·X)/c + ∇c(∇c·X)/c²,
///
/// X and P the derivatives of x and p over the launch direction. In uniform water rays are straight
/// and X grows linearly; elsewhere steps are those of Dormand and Prince (5th order). Červený,
/// Seismic Ray Theory (2001), ch. 4; Jensen et al. (2011), §3.2.
/// docs/theory/three-dimensional-rays.md
class VolumeTracer {
 public:
  VolumeTracer(const VolumeOcean& ocean, double frequency);

  /// \param direction  unit vector   \param receiver  what legs are to come close to
  /// \param out  its memory is reused
  void trace(const Vec3& from, const Vec3& direction, const Vec3& receiver,
             const VolumeLimits& limits, VolumeRay& out, bool with_track = false) const;
  /// The same for many receivers. \param hull  corners of what holds them all: the ray ends when it
  /// can come back to none
  void trace(const Vec3& from, const Vec3& direction, std::span<const Vec3> hull,
             const VolumeLimits& limits, VolumeCourse& out) const;

  [[nodiscard]] const VolumeOcean& ocean() const noexcept { return ocean_; }
  [[nodiscard]] double frequency() const noexcept { return frequency_; }

 private:
  class Run;

  const VolumeOcean& ocean_;
  double frequency_;
  DepthFunction attenuation_;
  double steepest_, spacing_, shallowest_, bending_;
};

/// Area of the ray tube across the ray per solid angle of its launch, with a sign that changes at
/// every fold and every bounce: det(X, t) [m²/sr].
[[nodiscard]] double tube_area(const Mat32& x_launch, const Vec3& tangent) noexcept;
[[nodiscard]] double tube_area(const VolumeState& state) noexcept;

}  // namespace asdic::detail
