#pragma once
#include <complex>
#include <optional>
#include <span>
#include <vector>

#include "core/units.h"
#include "sonar/scenario/noise_settings.h"

namespace asdic::detail {

/// Elevations of sound at an array, in steps that its beams do not resolve: what comes at an angle
/// is shared by the two nodes around it.
class ElevationNodes {
 public:
  /// \param phones  [n] [m]   \param wavelength  [m]
  ElevationNodes(std::span<const Vec3> phones, double wavelength);

  [[nodiscard]] std::size_t size() const noexcept { return sines_.size(); }
  [[nodiscard]] double elevation(std::size_t node) const noexcept;  ///< [rad]
  struct Place {
    std::size_t node = 0;  ///< below; the next one has the rest
    double share = 1.0;    ///< of this one
  };
  /// \param elevation  that sound comes from, positive from above [rad]
  [[nodiscard]] Place at(double elevation) const noexcept;
  [[nodiscard]] std::size_t nearest(double elevation) const noexcept;

 private:
  bool mirrored_;              // sound from above and from below is received alike
  std::vector<double> sines_;  // of the nodes, increasing
};

/// Conventional beams of all phones of an array, |w·e|² with w the beam and e the sound, over where
/// they look and where sound comes from: sectors of bearing, each a mean over itself, and nodes of
/// elevation.
class BeamBank {
 public:
  /// \param sectors  of bearing, all round from north
  BeamBank(std::vector<Vec3> phones, double frequency, double sound_speed, int sectors,
           const ElevationNodes& nodes, const NoiseField& noise);

  /// Every beam receives everything: there is one phone.
  [[nodiscard]] bool omnidirectional() const noexcept { return phones_.size() < 2; }
  /// What a beam receives, relative to what it looks at. \param bearing  where it looks [rad]
  /// \param node  of its elevation   \param received  [sectors × nodes]
  void beam(double bearing, std::size_t node, std::span<float> received) const;
  /// gain_over_noise_db() of that beam.
  [[nodiscard]] double gain_over_noise_db(double bearing, std::size_t node) const;

 private:
  [[nodiscard]] Vec3 slowness(double bearing, double elevation) const noexcept;
  void look_along_axis();

  std::vector<Vec3> phones_;
  double angular_frequency_, sound_speed_;
  int sectors_, parts_;  // bearings looked at in a sector
  const ElevationNodes& nodes_;
  std::vector<std::complex<double>> coherence_;  // Γ of the noise, [phones × phones]
  std::vector<float> real_, imaginary_;          // of e, [phones][sectors × parts × nodes]
  // Of a line instead: |w·e|² over the difference of cosines, and those of all rows.
  std::optional<Vec3> axis_;
  double cosine_step_ = 0.0;
  std::vector<float> line_, cosines_;
};

}  // namespace asdic::detail
