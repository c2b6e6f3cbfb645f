#pragma once
#include <complex>
#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "io/result/field_file.h"
#include "io/result/result_root.h"
#include "raytrace/area/earth_places.h"
#include "raytrace/cases/propagation_case.h"
#include "raytrace/paths/trace_ray.h"
#include "raytrace/propagation.h"
#include "sonar/ping/ping_record.h"

// What `asdic arrivals`, `rays` and `field` print as JSON, and `asdic serve` answers.
namespace asdic::detail {

/// Eigenrays that were found, and for what.
struct ArrivalsResult {
  ResultOrigin origin;
  std::vector<std::string> targets;  ///< their names
  int ping = 1;
  double frequency = 0.0;                           ///< [Hz]
  bool to_receiver = false;                         ///< one leg, from a source to a free receiver
  double source_depth = 0.0, receiver_depth = 0.0;  ///< of that leg [m]
  std::vector<Leg> legs;
  EarthPlaces earth{};  ///< where their map is
};

/// A fan that was traced, or eigenrays.
struct RaysResult {
  ResultOrigin origin{};
  PropagationCase run_case{};  ///< its ocean, frequency and sources
  /// [sources]; several only for a .ray file: all else tells of one
  std::vector<std::vector<RayPath>> rays_of_source{};

  [[nodiscard]] double source_depth() const { return run_case.source_depths.front(); }  ///< [m]
  [[nodiscard]] const std::vector<RayPath>& rays() const { return rays_of_source.front(); }
};

/// A field that was computed, and what of.
struct FieldResult {
  ResultOrigin origin{};
  PropagationCase run_case{};
  FieldData data{};
  std::filesystem::path output{};
  std::vector<std::string> notes{};
};

/// Bounces of a path that are listed one by one. A guide without loss has paths of thousands.
inline constexpr std::size_t most_listed_bounces = 256;
[[nodiscard]] std::span<const Bounce> listed_bounces(const Arrival& arrival);
[[nodiscard]] const char* name_of(ArrivalKind kind);
/// Transmission losses where there is sound, sorted [dB].
[[nodiscard]] std::vector<double> losses_of(const std::vector<std::complex<float>>& pressure);
/// \param received  of so many receivers [%]
[[nodiscard]] double silent_pct(std::size_t receivers, std::size_t received);

[[nodiscard]] FieldData field_data(const PropagationCase& run_case, PropagationResult&& result);

/// docs/formats/arrivals.md
[[nodiscard]] std::string arrivals_json(const ArrivalsResult& result);
/// The part of it for one list of paths.
[[nodiscard]] std::string paths_json(const Arrivals& arrivals);
/// docs/formats/rays.md
[[nodiscard]] std::string rays_json(const RaysResult& result);
/// docs/formats/field.md
[[nodiscard]] std::string field_json(const FieldResult& result);

}  // namespace asdic::detail
