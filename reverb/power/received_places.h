#pragma once
#include <complex>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "reverb/fields/scattering_field.h"
#include "reverb/power/path_interference.h"

namespace asdic::detail {

/// What one place sends back by one pair of paths, or by a pair and its reciprocal, whose delays
/// are the same.
struct Received {
  double delay = 0.0, extent = 0.0;  ///< of the piece of ground around the place [s]
  double power = 0.0;                ///< mean over an array: found with its covariance
  std::complex<double> one = 0.0, other = 0.0;
  /// Of the sound, as the array meets it [s/m].
  Vec3 one_slowness = Vec3::Zero(), other_slowness = Vec3::Zero();
  double one_length = infinity, other_length = infinity;  ///< of the way back [m]
  double doppler = 1.0;                ///< frequency received over frequency sent
  bool azimuthally_symmetric = false;  ///< stands for all bearings
};

/// A piece of ground, in whose middle the pairs of paths are looked at.
struct Ground {
  Vec2 middle = Vec2::Zero();                    ///< [m]
  Vec2 outward = Vec2::Zero();                   ///< unit vector along which it is `length` long
  double length = 1.0, width = 0.0, area = 1.0;  ///< [m], [m], [m²]
  double ring = 1.0;         ///< area of all that is received at its range: what is inaudible [m²]
  std::uint64_t chance = 0;  ///< which path stands for each bundle
  /// Places on it, of equal areas, each received by itself; none: all as one.
  std::span<const Vec2> places = {};
};

/// Memory that receiving a place takes: used again from place to place.
struct ReceptionMemory {
  /// A pair of paths by which a place is received, and what is received by it.
  struct By {
    PathPair* pair;
    PathPair* other;  // its reciprocal, if both are received as one
    Received received;
  };
  PathPairs pairs;
  PlaceSounds sounds;
  std::vector<By> by;
};

/// Adds what a piece of ground sends back. Sounds that come by several paths interfere, as under a
/// source close to the surface (Lloyd's mirror): the mean over the piece, the array and the pulse
/// is put into their powers. docs/theory/reverberation.md, "Covariance"
///
/// Places on a piece share its pairs and their amplitudes. Each has its own directions and Doppler
/// factors, and the delays change from place to place by the slownesses along the ground. What a
/// place sends back along one path follows each other.
/// \param azimuthally_symmetric  it is a whole circle
void receive(const ScatteringField& field, const Ground& ground, const AudibleLimits& limits,
             const PathInterference& interference, bool azimuthally_symmetric,
             ReceptionMemory& memory, std::vector<Received>& received);

}  // namespace asdic::detail
