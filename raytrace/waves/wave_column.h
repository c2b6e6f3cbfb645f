#pragma once
#include <algorithm>
#include <array>
#include <complex>
#include <span>
#include <vector>

#include "raytrace/ocean/environment.h"
#include "raytrace/waves/depth_wave.h"
#include "raytrace/waves/depth_waves.h"

namespace asdic::detail {

/// Attenuation of the field one period further out, in a sum over wavenumbers: 80 dB [Np].
inline constexpr double suppressed_by_a_period = 9.21;

/// A layered ocean as its depth-separated wave equation sees it, cut for one source and a number of
/// receivers:
///
///   g″ + ((ω/c − iα)² − ξ²)·g = −2·δ(z − z_s),   p(r) = ∫ ξ·g(ξ)·J₀(ξr) dξ
///
/// p relative to 1 m, e^{+iωt}. Boundaries reflect by the coefficients that rays have
/// (reflection_at()). Layers are of 1/c² linear in depth, with the mean and the slope that the
/// profile has there, and so thin that a wave's phase is off by 0.002 rad at a turn.
/// docs/theory/waves.md
class WaveColumn {
 public:
  /// \param environment  is_layered(), kept by reference   \param receivers  [n] depths, any order;
  /// outside of the water there is no sound [m]
  WaveColumn(const Environment& environment, double frequency, double source_depth,
             std::span<const double> receivers);
  /// One for all places: cut by the profile alone, so that the field is smooth in the depths of
  /// both ends; these lie within layers. For above() and below().
  /// \param cut_for  frequency whose layers it has, equal or nearly so
  WaveColumn(const Environment& environment, double frequency, double cut_for);

  /// g(ξ) at every receiver [m]. Im ξ > 0, or some loss somewhere: else modes are poles.
  /// \param growth  [lanes × n] memory for it   \param g  [used lanes × n], receivers fastest
  void kernels(const Wavenumbers& xi, std::span<double> growth,
               std::span<std::complex<double>> g) const noexcept;

  /// What the surface and the bottom each let be at one depth, derivatives downwards.
  struct Solutions {
    DepthWave above, below;
  };
  /// At the source, the first receiver and the slowest depth of their duct: where the speed has the
  /// minimum that both are sloping down to.
  struct AtDepths {
    Solutions source, receiver, slowest;
  };
  /// \return one for each lane
  [[nodiscard]] std::array<AtDepths, DepthWaves::count> solutions(
      const Wavenumbers& xi) const noexcept;

  /// Reflection coefficient of the water between surface and bottom for a wave from below, when
  /// neither returns anything: 1 where the wave turns, and that of corners and bends elsewhere.
  [[nodiscard]] double returned_by_the_water(double xi) const noexcept;

  /// What the surface lets be at an edge, its derivative downwards; and the bottom, upwards. Beyond
  /// where a wave has died out (350 dB) nothing is looked at.
  [[nodiscard]] DepthWaves above(const Wavenumbers& xi, std::size_t edge) const noexcept;
  [[nodiscard]] DepthWaves below(const Wavenumbers& xi, std::size_t edge) const noexcept;
  /// Follow the first down from an edge to a depth, and the second up.
  void descend(DepthWaves& waves, const Wavenumbers& xi, std::size_t edge, double depth) const;
  void ascend(DepthWaves& waves, const Wavenumbers& xi, std::size_t edge, double depth) const;
  /// The layer that holds a depth, counted from the top.
  [[nodiscard]] std::size_t layer_at(double depth) const noexcept;
  [[nodiscard]] double edge(std::size_t number) const noexcept { return edges_[number]; }

  /// (ω/c − iα)² at one depth [1/m²] and its slope there, the mean of both sides of a corner
  /// [1/m³].
  struct Squared {
    std::complex<double> k2;
    double slope;
  };
  [[nodiscard]] Squared at_slowest() const noexcept { return squared(slowest_edge_); }
  [[nodiscard]] Squared at_source() const noexcept { return squared(source_edge_); }
  [[nodiscard]] Squared at_receiver() const noexcept { return squared(edge_of_.front()); }
  /// Whether both ends, the source and the first receiver, lie above the slowest depth or the lower
  /// one at it; or below it.
  [[nodiscard]] bool ends_are_above() const noexcept {
    const auto [upper, lower] = std::minmax(source_edge_, edge_of_.front());
    return upper < slowest_edge_ && lower <= slowest_edge_;
  }
  [[nodiscard]] bool ends_are_below() const noexcept {
    const auto [upper, lower] = std::minmax(source_edge_, edge_of_.front());
    return upper >= slowest_edge_ && lower > slowest_edge_;
  }

  [[nodiscard]] std::size_t layers() const noexcept { return layers_.size(); }
  /// The period that a sum over wavenumbers may have, over its furthest range. Nearer the real axis
  /// where a reflection coefficient is tabulated, because it is not analytic at the rows.
  [[nodiscard]] double ranges_of_a_period() const noexcept;
  /// ω over the lowest and the highest speed [1/m].
  [[nodiscard]] double largest_wavenumber() const noexcept { return largest_; }
  [[nodiscard]] double smallest_wavenumber() const noexcept { return smallest_; }
  /// The largest wavenumber of all that reaches source and receivers, waves along the boundaries
  /// included [1/m].
  [[nodiscard]] double slowest_wavenumber() const;

 private:
  void cut(double from, double to, double omega);
  void find_wavenumbers();
  [[nodiscard]] bool fades(std::size_t layer, double xi, double& decay) const noexcept;
  /// The wave that above() and below() follow from the surface or the bottom, or from where a wave
  /// of that wavenumber has died out (350 dB). \param edge  where it is wanted; becomes where it is
  /// Waves that start at edges of their own, followed from the first of these to the last edge.
  /// \param keep  is called at each edge from `first` on
  template <class Keep>
  void follow_down(const Wavenumbers& xi, std::size_t first, std::size_t last, Keep&& keep) const;
  template <class Keep>
  void follow_up(const Wavenumbers& xi, std::size_t first, std::size_t last, Keep&& keep) const;
  [[nodiscard]] DepthWave upper_start(std::complex<double> xi, std::size_t& edge) const noexcept;
  [[nodiscard]] DepthWave lower_start(std::complex<double> xi, std::size_t& edge) const noexcept;
  [[nodiscard]] std::size_t slowest_edge() const noexcept;
  [[nodiscard]] WaveLayer layer(double from, double to) const noexcept;
  [[nodiscard]] Squared squared(std::size_t edge) const noexcept;
  /// The wave beside a boundary, at the column's edge, its derivative away from it.
  [[nodiscard]] DepthWave beside(const Boundary& boundary, std::complex<double> xi,
                                 std::complex<double> k2) const noexcept;

  const Environment& environment_;
  double frequency_, omega_;
  DepthFunction loss_;                // [Np/m]
  std::vector<WaveLayer> layers_;     // downwards
  std::vector<double> edges_;         // [layers + 1] their depths [m]
  std::vector<std::size_t> edge_of_;  // [n] of each receiver; none: none_
  std::vector<std::size_t> order_;    // [n] receivers from the top downwards
  std::size_t source_edge_ = 0, slowest_edge_ = 0;
  double largest_ = 0.0, smallest_ = 0.0;
};

/// The plane-wave reflection coefficient of a boundary at horizontal wavenumber ξ: that of rays,
/// reflection_coefficient(), continued to complex angles where it is a formula. A measured table
/// has real angles only. \param w  vertical wavenumber beside the boundary [1/m]
[[nodiscard]] std::complex<double> reflection_at(const Boundary& boundary,
                                                 const WaterAtBoundary& water, double omega,
                                                 std::complex<double> xi,
                                                 std::complex<double> w) noexcept;

}  // namespace asdic::detail
