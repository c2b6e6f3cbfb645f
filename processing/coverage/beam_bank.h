#pragma once
#include <complex>
#include <optional>
#include <span>
#include <vector>

#include "core/units.h"
#include "processing/coverage/pulse_band.h"
#include "sonar/scenario/noise_settings.h"

namespace asdic::detail {

/// Elevations of sound at an array, in steps that its beams do not resolve: what comes at an angle
/// is shared by the two nodes around it.
class ElevationNodes {
 public:
  /// \param phones  [n] [m]   \param wavelength  [m]   \param way  a level length that resolves as
  /// phones do: of a ship under way, whose filters tell directions by their Doppler shift [m]
  ElevationNodes(std::span<const Vec3> phones, double wavelength, double way = 0.0);

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
/// elevation. The mean over the pulse's band, as its matched filter hears it, whose replica is that
/// of what rests where the beam looks.
class BeamBank {
 public:
  /// \param sectors  of bearing, all round from north   \param closing  velocities of source and
  /// array together [m/s]
  BeamBank(std::vector<Vec3> phones, const PulseBand& band, double frequency, double sound_speed,
           int sectors, const ElevationNodes& nodes, const NoiseField& noise, const Vec2& closing);

  /// Every beam receives everything: there is one phone, and at rest.
  [[nodiscard]] bool omnidirectional() const noexcept {
    return phones_.size() < 2 && shifts_.empty();
  }
  /// By how much sound from elsewhere may be answered early or late, for its shift and for the way
  /// along the phones [s].
  [[nodiscard]] double smear() const noexcept { return smear_; }
  /// What a beam receives, relative to what it looks at, and what of that is beside its main lobe.
  struct Beam {
    std::vector<float> all, aside;  // [sectors × nodes]
  };
  /// \param bearing  where it looks [rad]   \param node  of its elevation
  [[nodiscard]] Beam beam(double bearing, std::size_t node) const;
  /// gain_over_noise_db() of that beam.
  [[nodiscard]] double gain_over_noise_db(double bearing, std::size_t node) const;

 private:
  [[nodiscard]] Vec3 slowness(double bearing, double elevation) const noexcept;
  [[nodiscard]] double shift(const Vec3& towards) const noexcept;
  void look_along_axis(const PulseBand& band);
  void look_all_round(const PulseBand& band);
  [[nodiscard]] bool shifts_along_axis(const PulseBand& band) const;
  void find_shifts(const PulseBand& band);
  void receive_all_round(const Vec3& slowness, std::span<float> rows) const;
  void pass(const Vec3& looks, std::span<float> rows) const;

  std::vector<Vec3> phones_;
  double angular_frequency_, sound_speed_;
  int sectors_, parts_;  // bearings looked at in a sector
  const ElevationNodes& nodes_;
  std::vector<std::complex<double>> coherence_;  // Γ of the noise, [phones × phones]
  std::vector<PulseBand::Line> lines_;
  std::vector<double> shares_;
  std::vector<float> real_, imaginary_;  // of e, [lines][phones][sectors × parts × nodes]
  // Of a line instead: |w·e|² over the difference of cosines, and those of all rows.
  std::optional<Vec3> axis_;
  double cosine_step_ = 0.0, main_lobe_ = 2.0;  // of a line: half its width in cosines
  std::vector<float> line_, cosines_;
  // Of a ship under way: Doppler shifts of all rows, and what passes over their difference.
  Vec2 closing_;
  double smear_ = 0.0, shift_step_ = 1.0;  // [s], [Hz]
  std::vector<float> shifts_, passes_;
};

}  // namespace asdic::detail
