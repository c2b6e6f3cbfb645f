#pragma once
#include <complex>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "raytrace/math/bessel_table.h"
#include "reverb/pairs/scattering_sheet.h"
#include "reverb/power/phone_mean.h"
#include "reverb/power/pulse_coherence.h"

namespace asdic::detail {

/// Who receives sounds of one place that come by different paths, and so how far they add up in
/// phase: through a pulse, and as a mean over the phones.
class PathInterference {
 public:
  /// \param phones  relative to the array's reference point [m]; none: one phone there
  /// \param frequency  [Hz]   \param azimuthally_symmetric  of the mean over bearings
  PathInterference(std::span<const Vec3> phones, double frequency, const PulseCoherence& pulse,
                   bool azimuthally_symmetric);
  [[nodiscard]] double frequency() const noexcept { return frequency_; }
  [[nodiscard]] const PulseCoherence& pulse() const noexcept { return pulse_; }
  /// Mean over phones of e^{−iω(s_a − s_b)·x}. \param apart  s_a − s_b [s/m]
  [[nodiscard]] std::complex<double> over_phones(const Vec3& apart) const noexcept;

 private:
  const PulseCoherence& pulse_;
  double frequency_;
  double reach_ = 0.0;                 // of the furthest
  std::optional<PhoneMean> phones_;    // not over bearings
  std::optional<BesselTable> bessel_;  // of the mean over bearings
  /// Phones that differ in bearing alone, for that mean.
  struct Ring {
    double radius = 0.0, height = 0.0;  // times the frequency
    double share = 0.0;                 // of the phones
  };
  std::vector<Ring> rings_;
};

/// A piece of ground that sends sounds back, or of a layer.
struct GroundPiece {
  Vec2 outward = Vec2(0.0, 1.0);     ///< unit vector along which it is `length` long
  double length = 0.0, width = 0.0;  ///< [m]
  double thickness = 0.0;            ///< [m]
};

/// How far the phases of sounds turn over a piece: standard deviations, of what is even over its
/// sides, for a slope of their delay [rad per s/m].
struct PiecePhases {
  double along = 0.0, across = 0.0, through = 0.0;
  /// \param frequency  [Hz]
  PiecePhases(const GroundPiece& piece, double frequency) noexcept;
};

/// The sounds of one place by all pairs of paths, each a part of something that is received: a pair
/// by itself, or with its reciprocal. Used again from place to place.
class PlaceSounds {
 public:
  void clear() noexcept { sounds_.clear(); }
  /// \param part  of which it is one. Pairs that stand for bundles add by energy and are left out
  /// \param slowness  as the array meets it [s/m]
  void add(const ScatteringSheet& sheet, const PathPair& pair, const GroundPiece& piece,
           double doppler, const Vec3& slowness, std::size_t part);
  /// Of the amplitudes of each part: what it is together with the others over what it is alone, as
  /// a mean over the piece, the phones and the pulse. The 144 strongest sounds interfere, all pairs
  /// of twelve groups.
  /// docs/theory/reverberation.md, "Covariance" \param parts  how many
  [[nodiscard]] std::span<const double> gains(const PathInterference& interference,
                                              const GroundPiece& piece, std::size_t parts);

 private:
  struct Sound {
    std::complex<double> amplitude = 0.0;  // with the phase of its delay
    double delay = 0.0;                    // [s]
    double along = 0.0, across = 0.0;  // ∂delay over the ground, outward and beside that [s/m]
    double through = 0.0;              // the same over the depth [s/m]
    double doppler = 1.0;
    Vec3 slowness = Vec3::Zero();
    std::size_t part = 0;
    bool first = true;  // of its part, in the order of delays
  };
  class Between;
  /// \param lasting  sounds that are further apart do not interfere [s]
  void add_up(const Between& between, double lasting);
  void share_out(std::size_t begin, std::size_t end);

  std::vector<Sound> sounds_;
  double origin_ = 0.0;                          // of the phases [s]
  std::vector<double> alone_, between_, gains_;  // [parts]
};

/// ∂delay of a pair over the ground, towards a direction [s/m].
[[nodiscard]] double steepness(const PathPair& pair, const Vec2& towards) noexcept;

}  // namespace asdic::detail
