#pragma once
#include <complex>
#include <optional>
#include <span>
#include <vector>

#include "raytrace/beams/crossings.h"
#include "raytrace/tracing/ray_tracer.h"

namespace asdic {

/// Crossings in a layered ocean whose speed is linear in depth between samples, with flat
/// boundaries and the same loss at every depth: closed forms, no marching. What RayTracer and
/// find_crossings find, for a fortieth of the price. Const, shared by threads.
///
/// In a layer with gradient g a ray of slowness ξ is an arc along which sin θ falls linearly with
/// range: with Δ = r − r_a,
///
///   sin θ = sin θ_a − ξgΔ,   z = z_a + Δ·(sin θ_a + sin θ)/(cos θ_a + cos θ),
///   τ = τ_a + atanh(w)/g,  w = ξgΔ/(1 − sin θ_a sin θ),   q = q_a + pΔ/ξ
///
/// and where g jumps by δ, p falls by q·δ·ξ²/sin θ; a reflection is a jump to −g.
/// docs/theory/fields.md
class LayeredCrossings {
 public:
  /// Empty if the ocean is not of this kind. \param ranges  of the columns, increasing, ≥ 0; must
  /// outlive this
  static std::optional<LayeredCrossings> make(const Environment& environment, double frequency,
                                              double source_depth, std::span<const double> ranges,
                                              const TraceLimits& limits);

  /// Memory of one thread.
  struct Workspace {
    std::vector<double> sine, jump, reach, time;        // [nodes] twice, [layers] twice
    std::vector<double> r, s, z, cosine, tau, q, p, g;  // [columns] the layer's begin
    std::vector<double> length;                         // [columns] of the ray, up to it
  };

  /// \return false: this ray (vertical, backwards, level, …) is one for the RayTracer
  bool find(double launch_elevation, Workspace& work, Crossings& out) const;

 private:
  LayeredCrossings() = default;
  void absorb(double xi, std::size_t n, Workspace& work, Crossings& out) const;
  [[nodiscard]] std::size_t first_layer(double sine) const noexcept;

  const Environment* environment_ = nullptr;
  std::vector<double> depth_, speed_, gradient_;  // [nodes], [nodes], [layers]
  std::span<const double> ranges_;
  double source_depth_ = 0.0, source_speed_ = 0.0;
  std::size_t source_layer_ = 0;
  bool source_on_node_ = false;  // the node above source_layer_
  double alpha_ = 0.0;           // [Np/m]
  double faintest_ = 0.0;
};

}  // namespace asdic
