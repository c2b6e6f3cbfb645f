#pragma once
#include <complex>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "raytrace/beams/crossings.h"
#include "raytrace/tracing/ray_tracer.h"

namespace asdic::detail {

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

  /// The ray where it enters a layer.
  struct Pass {
    double r, s, z, cosine, tau, q;
    double rate;    // dq/dr = p/ξ
    double bend;    // ξg
    double length;  // of the ray, up to here
  };
  /// What changes at boundaries and caustics only.
  struct Piece {
    std::size_t pass;                                            // from this one on
    double level = 1.0, phase = 0.0, mirror = 1.0, sense = 1.0;  // sense: the sign of q
  };
  /// Memory of one thread.
  struct Workspace {
    std::vector<double> sine, jump, reach, time;  // [nodes] twice, [layers] twice
    std::vector<Pass> pass;                       // [passes + 1]: the last is where it ends
    std::size_t passes = 0;
    std::vector<Piece> piece;
    std::vector<std::int32_t> pass_of;  // [columns + some]
    std::vector<double> length;         // [columns + some] of the ray up to each
    bool flat = true;                   // series will do for every arc
  };

  /// \return false: this ray (vertical, backwards, level, …) is one for the RayTracer
  bool find(double launch_elevation, Workspace& work, Crossings& out) const;

 private:
  LayeredCrossings() = default;
  bool pass_layers(double xi, Workspace& work) const;
  void follow(double sine, double xi, Workspace& work) const;
  std::size_t find_layers(Workspace& work) const;
  template <bool absorbing>
  void cross(double xi, std::size_t n, Workspace& work, Crossings& out) const;
  void fill_pieces(std::size_t n, Workspace& work, Crossings& out) const;
  [[nodiscard]] std::size_t column_at(double range, std::size_t column) const noexcept;
  [[nodiscard]] std::size_t first_layer(double sine) const noexcept;

  const Environment* environment_ = nullptr;
  std::vector<double> depth_, speed_, gradient_;  // [nodes], [nodes], [layers]
  std::span<const double> ranges_;
  std::vector<double> padded_ranges_;   // [columns + some]
  std::vector<std::uint32_t> columns_;  // 0, 1, 2, …
  double columns_per_metre_ = 0.0;
  double source_depth_ = 0.0, source_speed_ = 0.0;
  std::size_t source_layer_ = 0;
  bool source_on_node_ = false;  // the node above source_layer_
  double alpha_ = 0.0;           // [Np/m]
  double frequency_ = 0.0;       // [Hz]
  double faintest_ = 0.0;
};

}  // namespace asdic::detail
