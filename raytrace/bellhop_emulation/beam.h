#pragma once
#include <cstddef>

#include "raytrace/bellhop_emulation/literal_ray.h"
#include "raytrace/cases/propagation_case.h"

namespace asdic::detail::bellhop_emulation {

/// A ray and what makes a beam of it.
struct Beam {
  const LiteralRay& ray;
  double frequency = 0.0;                          ///< [Hz]
  double source_speed = 0.0;                       ///< c₀ [m/s]
  double spacing = 0.0;                            ///< dα, mean spacing of the fan [rad]
  double step = 0.0;                               ///< STEP [m]
  double surface_depth = 0.0, bottom_depth = 0.0;  ///< over which images are mirrored [m]
  SourceKind source = SourceKind::point;
  bool apart = false;  ///< for arrivals or eigenrays, not for a sum

  [[nodiscard]] double omega() const noexcept { return 2.0 * pi * frequency; }
  /// q of a ray whose beam is 1 m wide: |q|/q₀ is the distance to the neighbouring ray.
  [[nodiscard]] double q0() const noexcept { return source_speed / spacing; }
  /// Ratio1 = √|cos α| of a point source, 1 of a line.
  [[nodiscard]] double launch_factor() const noexcept;
};

/// A part of the receivers: columns are ranges; an irregular grid has one row.
struct ReceiverBlock {
  const ReceiverGrid& grid;
  std::size_t column_begin = 0, column_end = 0;
  std::size_t row_begin = 0, row_end = 0;

  [[nodiscard]] double depth(std::size_t row, std::size_t column) const noexcept {
    return grid.depths[grid.irregular ? column : row];
  }
};

/// What one segment of one beam brings to one receiver.
struct Contribution {
  std::size_t row = 0, column = 0;
  std::size_t segment = 0;            ///< from point segment − 1 to point segment
  double amplitude = 0.0;             ///< on the axis of the beam, spreading by range left out
  double weight = 0.0;                ///< across the beam
  double intensity_factor = 1.0;      ///< intensities add (amplitude² · weight · this)
  double phase = 0.0;                 ///< reflections and caustics [rad]
  std::complex<double> tau;           ///< [s]
  double arrival_declination = 0.0;   ///< of the segment's chord [rad], positive down
  const LiteralPoint* end = nullptr;  ///< the segment's end
};

/// Where contributions go.
class BeamSink {
 public:
  virtual ~BeamSink() = default;
  virtual void take(const Contribution& c) = 0;
  /// Of a beam that is no ray tube: a pressure on its axis or beside it, spreading by range left
  /// out, and a weight: pressures add p·weight, intensities |p|²·weight.
  virtual void take_pressure(std::size_t row, std::size_t column, std::complex<double> p,
                             double weight) = 0;
};

/// The phase that caustics have added up to the beginning of a segment, and what a receiver gets.
class CausticPhase {
 public:
  /// \param before  q before the ray begins
  explicit CausticPhase(double before = 0.0) noexcept : before_(before) {}
  /// To be called with q at the beginning of every segment in turn.
  void pass(double q) noexcept {
    if (changed(q)) phase_ += 0.5 * pi;
    before_ = q;
  }
  /// The caustics' phase at a receiver where q is as given.
  [[nodiscard]] double at(double q) const noexcept {
    return changed(q) ? phase_ + 0.5 * pi : phase_;
  }
  /// The same with the reflections', but *without* them where q
  /// has changed sign since the segment's beginning. That is BELLHOP's, and an error.
  [[nodiscard]] double at(double q, double reflections) const noexcept {
    return changed(q) ? at(q) : reflections + phase_;
  }

 private:
  [[nodiscard]] bool changed(double q) const noexcept {
    return (q <= 0.0 && before_ > 0.0) || (q >= 0.0 && before_ < 0.0);
  }
  double phase_ = 0.0, before_;
};

/// Lays a beam of its kind over a block of receivers. The contributions come in the order of the
/// segments.
void add_cartesian_hat(const Beam& beam, const ReceiverBlock& block, BeamSink& sink);
void add_cartesian_gaussian(const Beam& beam, const ReceiverBlock& block, BeamSink& sink);
void add_ray_centred_hat(const Beam& beam, const ReceiverBlock& block, BeamSink& sink);
void add_ray_centred_gaussian(const Beam& beam, const ReceiverBlock& block, BeamSink& sink);
void add_simple_gaussian(const Beam& beam, const ReceiverBlock& block, BeamSink& sink);
void add_cerveny_cartesian(const Beam& beam, const CervenyBeams& kind, const ReceiverBlock& block,
                           BeamSink& sink);
void add_cerveny_ray_centred(const Beam& beam, const CervenyBeams& kind, const ReceiverBlock& block,
                             BeamSink& sink);

}  // namespace asdic::detail::bellhop_emulation
