#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "app/output.h"
#include "raytrace/cases/propagation_case.h"
#include "raytrace/paths/trace_ray.h"

namespace asdic::detail::app {

/// A fan that was traced, or eigenrays.
struct RaysResult {
  ResultOrigin origin{};
  PropagationCase run_case{};  ///< its ocean, frequency and sources
  /// [sources]; several only for a .ray file: all else tells of one
  std::vector<std::vector<RayPath>> rays_of_source{};

  [[nodiscard]] double source_depth() const { return run_case.source_depths.front(); }  ///< [m]
  [[nodiscard]] const std::vector<RayPath>& rays() const { return rays_of_source.front(); }
};

[[nodiscard]] std::string rays_table(const RaysResult& result);
/// docs/formats/rays.md
[[nodiscard]] std::string rays_json(const RaysResult& result);
/// docs/formats/rays.md, or a .ray file, by the name's ending \throws RunError
void write_rays_file(OutputFile&& to, const RaysResult& result);

}  // namespace asdic::detail::app
