#pragma once
#include <map>
#include <memory>
#include <mutex>
#include <vector>

#include "reverb/patches.h"
#include "sonar/propagation_paths.h"

namespace asdic {

/// The paths to the surface in one plane, and the azimuth sectors that have them.
struct GroundSectors {
  std::shared_ptr<const GroundPaths> paths;
  std::vector<CellTilt> tilt;  ///< [cells], empty where the surface is level
  std::vector<int> sectors;    ///< of the ring
};

/// Where the fans of a platform meet the surface all around it.
///
/// A layered ocean has one plane for all sectors. Over a transect sector 0 begins at the transect's
/// bearing, and every two sectors mirrored about it share a plane: half as many planes as azimuths.
/// Planes are traced when first asked for and kept for a platform that stays (in a layered ocean:
/// that keeps its depth). Shared by threads; what comes out does not depend on what is kept.
class SurfaceGround {
 public:
  struct Settings {
    int azimuths = 36;
    double spacing = 50.0;      ///< of the ground grid [m]
    double max_range = 1e5;     ///< [m]
    double frequency = 1000.0;  ///< [Hz]
    PathLimits limits;
  };
  /// \param paths  must outlive this
  SurfaceGround(const PropagationPaths& paths, const Settings& settings);
  ~SurfaceGround();

  [[nodiscard]] std::shared_ptr<const std::vector<GroundSectors>> around(
      const Vec3& platform) const;
  [[nodiscard]] const Settings& settings() const noexcept { return settings_; }

 private:
  struct Entry;
  [[nodiscard]] std::vector<GroundSectors> trace(const Vec3& platform) const;

  const PropagationPaths& paths_;
  Settings settings_;
  mutable std::mutex lock_;
  mutable std::map<std::pair<double, double>, std::shared_ptr<Entry>> kept_;
};

}  // namespace asdic
