#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "raytrace/beams/beam.h"
#include "raytrace/tracing/ray_tracer.h"

namespace asdic::detail {

/// The crossings of one ray with the columns of a grid of receivers, an array for each quantity, so
/// that loops over them vectorise. Memory is reused from ray to ray.
struct Crossings {
  double source_speed = 0.0;          ///< c₀ [m/s]
  std::vector<std::uint32_t> column;  ///< [n]
  std::vector<double> depth;          ///< [n] [m]
  std::vector<double> cosine, sine;   ///< [n] of the angle below the horizon; cosine < 0: backwards
  std::vector<double> speed;          ///< [n] c [m/s]
  std::vector<double> time;           ///< [n] τ [s]
  std::vector<double> q, dq_ds;       ///< [n] ∂n/∂α [m/rad] and its growth c·p [1/rad]
  std::vector<double> level;          ///< [n] |reflections|·exp(−∫α ds)·spread_across
  std::vector<double> phase;          ///< [n] of reflections and caustics [rad]
  std::vector<double> mirror;         ///< [n] −1 after an odd number of reflections, else 1

  std::vector<std::uint32_t> bounces;  ///< [n] off the bottom, and 65536 × off the surface; of
                                       ///< marched rays alone, else empty

  [[nodiscard]] std::size_t size() const noexcept { return column.size(); }
  void resize(std::size_t n);  ///< all but the bounces
};

/// Those with every n-th column from `first` on, which are columns 0, 1, 2, … then.
void pick_columns(const Crossings& from, std::size_t first, std::size_t every, Crossings& out);

/// The crossings of a traced ray.
void find_crossings(const BeamSetting& setting, const RayTrajectory& ray,
                    std::span<const double> ranges, Crossings& out);

/// The same as a ray is marched, without storing it.
class MarchedCrossings final : public RangeVisitor {
 public:
  MarchedCrossings(const BeamSetting& setting, Crossings& out) : setting_(setting), out_(out) {
    out_.resize(0), out_.bounces.clear();
  }
  void pass(std::size_t column, const RayState& y, const RayHistory& history) override;

 private:
  const BeamSetting& setting_;
  Crossings& out_;
};

}  // namespace asdic::detail
