#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "raytrace/ray_path.h"
#include "sonar/scenario.h"

namespace asdic::app {

/// A fan that was traced.
struct RaysResult {
  const Scenario* scenario = nullptr;
  double source_depth = 0.0;  ///< [m]
  std::vector<RayPath> rays;
};

[[nodiscard]] std::string rays_table(const RaysResult& result);
/// docs/formats/rays.md
[[nodiscard]] std::string rays_json(const RaysResult& result);
/// docs/formats/rays.md \throws RunError
void write_rays_file(const std::filesystem::path& path, const RaysResult& result);

}  // namespace asdic::app
