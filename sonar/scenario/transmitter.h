#pragma once
#include <complex>
#include <optional>
#include <string>
#include <vector>

#include "core/units.h"
#include "reverb/transmit_pattern.h"
#include "sonar/signal/pulse.h"

namespace asdic {

enum class Taper { omnidirectional, rectangular, hann };

/// One of several projectors that send the same pulse.
struct Projector {
  Vec3 offset = Vec3::Zero();  ///< from the transmitter's place, in its frame [m]
  double amplitude = 1.0;
  double phase = 0.0;  ///< of what it sends [rad]
  double delay = 0.0;  ///< [s]
};

/// Level over bearing and elevation, bilinear in dB; round the circle in bearing, the outer rows
/// going on in elevation.
struct BeamTable {
  std::vector<double> bearings;    ///< [n ≥ 1] strictly increasing within one turn [rad]
  std::vector<double> elevations;  ///< [m ≥ 1] strictly increasing, positive up [rad]
  std::vector<double> level_db;    ///< [n × m] re the source level
};

/// What the bearings of a transmitter's projectors, table and steering count from.
enum class BearingFrame { north, heading };

/// The projector: a vertical line with a taper, steered in elevation and the same all round; or, if
/// there are any, a list of projectors; or a table.
struct Transmitter {
  double source_level_db =
      220.0;  ///< SL [dB re 1 µPa rms at 1 m]: peak envelope/√2 of the pulse before its window
  double elevation = 0.0;                  ///< of the beam's axis, positive up [rad]
  double beamwidth = 0.10471975511965978;  ///< full −3 dB width of the unsteered line [rad]
  Taper taper = Taper::hann;
  std::string name = "transmitter";
  int platform = 0;                    ///< that carries it, an index
  Vec3 offset = Vec3::Zero();          ///< from the platform [m]
  std::optional<PulseSettings> pulse;  ///< none: the scenario's
  double first_ping_time = 0.0;        ///< since the start of the scenario [s]
  std::optional<double> interval;      ///< from ping to ping [s]; none: the schedule's
  std::vector<double> elevations;      ///< of each ping [rad], repeated as needed; empty: the
                                       ///< schedule's, and without those `elevation`
  std::vector<Projector> projectors;
  std::optional<BeamTable> table;
  double bearing = 0.0;  ///< that projectors are steered to, or that the table is turned to [rad]
  BearingFrame frame = BearingFrame::north;  ///< of bearings and offsets; heading: the platform's
                                             ///< course, offsets (starboard, forward, down)
};

/// Far-field amplitude pattern of a transmitter.
///
/// A vertical line: 1 on its axis; real, with the side lobes' signs. Hann: sinc(u)/(1 − u²);
/// rectangular: sinc(u); u = (L/λ)(sin θ − sin θ₀), sinc(u) = sin(πu)/(πu). The length follows from
/// the beamwidth: L/λ = u₃/sin(width/2), u₃ = 0.7203 (Hann), 0.4429 (rectangular), λ at the
/// reference wavelength.
/// Projectors: Σ w_n e^{ik(d − d₀)·x_n − iωt_n}/Σ|w_n|, d₀ the direction that it is steered to (by
/// delays): 1 there, unless phases and delays of its own turn it away. λ is that at the source.
/// Source: docs/theory/projector.md
class BeamPattern final : public TransmitPattern {
 public:
  /// \param wavelength  at the source [m]   \param sound_speed  there [m/s], for delays
  /// \param heading  of its platform [rad]
  /// \param reference  wavelength to which a line's beamwidth refers [m]; 0: `wavelength`
  BeamPattern(const Transmitter& transmitter, double wavelength, double sound_speed = 1500.0,
              double heading = 0.0, double reference = 0.0);

  /// Of a vertical line; of others the root of the mean square over bearings.
  /// \param elevation  of launch, positive up [rad]
  [[nodiscard]] double operator()(double elevation) const noexcept;
  [[nodiscard]] std::complex<double> towards(double bearing,
                                             double elevation) const noexcept override;
  [[nodiscard]] bool all_round() const noexcept override { return elements_.empty() && !table_; }
  [[nodiscard]] bool add_to(ExactKey& key) const override;
  /// Delay between its parts as the far field sees them, at most [s].
  [[nodiscard]] double longest_delay() const noexcept;
  [[nodiscard]] double line_length() const noexcept {
    return length_over_wavelength_ * wavelength_;
  }  ///< [m]

 private:
  [[nodiscard]] double line(double elevation) const noexcept;

  struct Element {
    Vec3 place;  // on the map, over the wavelength
    std::complex<double> weight;
  };
  Taper taper_;
  double wavelength_, sound_speed_, length_over_wavelength_ = 0.0, sin_axis_ = 0.0;
  double turned_ = 0.0;  // bearing of the table's zero
  std::vector<Element> elements_;
  std::optional<BeamTable> table_;
};

}  // namespace asdic
