#pragma once
#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <shared_mutex>
#include <span>
#include <unordered_map>
#include <vector>

#include "raytrace/ocean/path_limits.h"
#include "raytrace/volume/volume_ray.h"

namespace asdic::detail {

/// The longest path that a search follows in water where rays bend [m]: three times the way and
/// ten times the depth more. In uniform water bounces alone end a ray.
[[nodiscard]] double longest_path(const VolumeOcean& ocean, const Vec3& from, const Vec3& to);

/// Rays of a source in a mesh of launch directions, traced once for any number of receivers on one
/// bearing. Directions are cut into cells of elevation and azimuth, the azimuths as far from the
/// bearing as bounces off the steepest floor can turn a ray. Rays within cells are traced when they
/// are first asked for, and kept while there is room. Shared by threads; what comes out does not
/// depend on what was asked before. docs/theory/three-dimensional-rays.md
class VolumeFan {
 public:
  static constexpr int cuts = 7;  ///< a cell is cut in halves so often, each way

  /// \param receivers  at least one, on one bearing from the source; the search for one of them
  /// takes in paths to all. \param told  the share of rays that are traced; false: no more
  /// \throws Interrupted  where told() says so
  VolumeFan(const VolumeTracer& tracer, const Vec3& from, std::span<const Vec3> receivers,
            const PathLimits& limits, const std::function<bool(double)>& told = {});

  [[nodiscard]] const VolumeTracer& tracer() const noexcept { return tracer_; }
  [[nodiscard]] const PathLimits& limits() const noexcept { return limits_; }
  [[nodiscard]] const Vec3& from() const noexcept { return from_; }
  [[nodiscard]] std::size_t rays() const noexcept { return rays_; }  ///< of whole cells
  /// Cells where families part are cut so often, though no root is near.
  [[nodiscard]] int cuts_of_borders() const noexcept { return border_cuts_; }

  /// Rows of cells, from the lowest elevation up, and cells of a row either side of the bearing.
  [[nodiscard]] int rows() const noexcept { return int(rows_.size()) - 1; }
  [[nodiscard]] int columns_of(int row) const noexcept;
  /// By places on the finest lattice: cell · 2^cuts.
  [[nodiscard]] double elevation(int row) const noexcept;
  [[nodiscard]] double azimuth(int column) const noexcept;
  [[nodiscard]] std::shared_ptr<const VolumeCourse> course(int row, int column) const;

  /// Legs of a cell that may come near a receiver. \param near  [legs] is set. \return false: none
  bool legs_near(int row, int column, const Vec3& to, std::vector<char>& near) const;

 private:
  /// What the legs of a cell's rays fill, with about three cells of it around: along the
  /// receivers' bearing, aside, down.
  struct Box {
    std::array<float, 3> low, high;
  };
  struct Cell {
    std::size_t begin = 0, end = 0;  // of its boxes
    Box whole{};
  };
  struct Kept {
    std::shared_mutex lock;
    std::unordered_map<std::uint64_t, std::shared_ptr<const VolumeCourse>> courses;
  };

  [[nodiscard]] double turn(double steepest) const noexcept;
  [[nodiscard]] VolumeLimits ray_limits() const noexcept;
  [[nodiscard]] std::shared_ptr<const VolumeCourse> traced(int row, int column) const;
  void measure_turns();
  void trace_corners(const std::function<bool(double)>& told);
  void put_boxes();
  [[nodiscard]] Vec3 beside_line(const Vec3& place) const noexcept;
  [[nodiscard]] Box box_of(const VolumeCourse& course, const VolumeCourse::Leg& leg,
                           double cell) const;

  const VolumeTracer& tracer_;
  Vec3 from_;
  std::vector<Vec3> hull_;
  PathLimits limits_;
  double longest_ = 0.0, bearing_ = 0.0;
  Vec2 along_ = Vec2::UnitY();  // unit vector of the bearing, east and north
  double slope_ = 0.0, by_water_ = 0.0, slowing_ = 1.0;  // for turn()
  int border_cuts_ = 0;
  std::vector<double> turns_;  // of rays of a row, at most, by a coarse ring [rad]
  std::vector<double> rows_;   // elevations between which cells lie [rad]
  int columns_ = 0;
  double d_azimuth_ = 0.0, coarse_ = 0.0;
  std::size_t rays_ = 0;
  std::vector<std::size_t> first_of_row_;
  std::vector<Cell> cells_;
  std::vector<Box> boxes_;
  mutable std::array<Kept, 16> kept_;
  mutable std::atomic<std::size_t> bytes_{0};
};

}  // namespace asdic::detail
