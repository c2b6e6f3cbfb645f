#pragma once
#include <array>
#include <complex>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "core/random.h"
#include "core/units.h"

namespace asdic::detail {

class Fields;

/// How the weights of the scatterers are drawn.
struct ScattererStatistics {
  /// The correlation of a scatterer's weight at two times is exp(−(Δt/coherence_time)²). 0: every
  /// ping has weights of its own; infinite: they never change. [s]
  double coherence_time = 0.0;
  std::optional<double> k_shape;      ///< ν of the gamma-distributed texture; none: Rayleigh
  double correlation_length = 500.0;  ///< of the texture: constant in squares of that side [m]

  void describe(Fields& field);
};

/// Scatterers of the sea: a polar grid around an anchor place, one or more scatterers a cell.
///
/// They belong to the world: a cell's places and weights are keyed by the seed, the anchor and the
/// cell, not by who looks. Ring i lies from i·spacing to (i + 1)·spacing, sector k from
/// first_bearing + 2πk/azimuths.
struct ScattererGrid {
  Vec2 anchor = Vec2::Zero();  ///< where it is now [m]
  std::uint64_t identity = 0;  ///< of the anchor (in the frame of the water) and the boundary
  double spacing = 1.0;        ///< of the rings [m]
  int azimuths = 36;
  int per_cell = 1;            ///< scatterers a cell
  double first_bearing = 0.0;  ///< clockwise from north [rad]
  std::uint32_t rings = 0;
};

/// Names one scatterer: cell, which of how many in it.
struct ScattererKey {
  std::uint32_t ring = 0, sector = 0, copies = 1, copy = 0;

  /// A number of 64 bits that no other scatterer of the sea has (but for one chance in 2⁶⁴ a pair).
  [[nodiscard]] std::uint64_t entity(std::uint64_t identity) const noexcept;
};

/// One scatterer as its draws place it.
struct Scatterer {
  Vec2 place = Vec2::Zero();  ///< [m]
  double area = 0.0;          ///< that it stands for [m²]
  double depth_share = 0.5;   ///< where in its sheet it lies, 0 top … 1 bottom
  double fate = 0.5;          ///< uniform in (0, 1): which Bragg wave it meets
};

/// Where a scatterer lies: copies of a cell share it in strips of bearing; within its strip a
/// scatterer lies anywhere with the same chance per area. \param entity  of the key
[[nodiscard]] Scatterer place_scatterer(const ScattererGrid& grid, const ScattererKey& key,
                                        std::uint64_t entity, std::uint64_t seed) noexcept;

/// The complex Gaussian weights of one field at one time, E|w|² = 1.
///
/// With a coherence time T the weight is a moving average of keyed normals w_j on a time grid of
/// step T/√2·¾, w(t) = Σ h(t − t_j) w_j/√Σh², h(u) = exp(−2u²/T²): no recursion, the same at any
/// time whatever was asked before, and ⟨w(t) w*(t′)⟩ = exp(−((t − t′)/T)²).
class ScattererWeights {
 public:
  /// \param time  since the start of the scenario [s]   \param ping  the key when every ping has
  /// its own weights
  ScattererWeights(const ScattererStatistics& statistics, Draw purpose, std::uint64_t seed,
                   double time, std::uint32_t ping);

  [[nodiscard]] std::complex<double> operator()(std::uint64_t entity) const noexcept;

  static constexpr int most_nodes = 7;

 private:
  Draw purpose_;
  std::uint64_t seed_;
  std::uint32_t first_ = 0;  // realisation of node 0
  int nodes_ = 1;
  std::array<double, most_nodes> share_{1.0};
};

/// √ of the texture at a place: amplitude that clutter has there over the mean, its square
/// gamma-distributed with shape ν and mean 1; 1 without a shape. \param place  in the frame of the
/// field, from its anchor's origin [m]
[[nodiscard]] double texture_amplitude(const ScattererStatistics& statistics, const Vec2& place,
                                       std::uint64_t boundary, std::uint64_t seed) noexcept;

/// A place that a field of scatterers is laid around, and how much of that field is received.
struct Anchor {
  Vec2 place = Vec2::Zero();   ///< now [m]
  std::uint64_t identity = 0;  ///< of the place in the water
  double share = 1.0;  ///< of its field's pressure; Σ share² = 1 over the anchors of a pair
};

/// The anchors of the field that two ends receive: the points of a square lattice in the frame of
/// the water, which drifts with the current, next to the ends' middle. Between points, in a strip a
/// tenth of a pitch wide, one sea goes over into the other: both are received, with the shares cos
/// α and sin α, α from 0 to π/2 across the strip (four where strips cross). So two pairs of ends d
/// apart share the correlation cos(½π·d/strip) at least, wherever they are, and no step is
/// received. docs/theory/reverberation.md, "Identity" \param first  the middle at time 0, a point
/// of the lattice   \param now  at `time` \param pitch  above 0 [m]   \param blended  false: the
/// nearest point alone \return the nearest first
[[nodiscard]] std::vector<Anchor> anchors_of(const Vec2& first, const Vec2& now, double time,
                                             const Vec2& current, double pitch,
                                             std::uint64_t boundary, bool blended);

}  // namespace asdic::detail
