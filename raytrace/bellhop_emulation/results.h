#pragma once
#include <memory>

#include "raytrace/bellhop_emulation/bellhop_emulation.h"
#include "raytrace/bellhop_emulation/sinks.h"

namespace asdic::detail::bellhop_emulation {

/// What one source has given so far.
struct SourceResults {
  SourceResults(const PropagationCase& run_case, const BellhopEmulationOptions& options);

  /// Scales what was summed (spreading over range, Cerveny's beam factor) and appends it.
  void append_to(PropagationResult& result, double source_speed, double spacing);

  const PropagationCase& run_case;
  std::size_t rows = 0, columns = 0;
  std::unique_ptr<FieldSums<float>> field32;  ///< one of the two, for a field
  std::unique_ptr<FieldSums<double>> field64;
  std::unique_ptr<ArrivalStore<float>> arrivals32;  ///< one of the two, for arrivals
  std::unique_ptr<ArrivalStore<double>> arrivals64;
  bool eigenrays = false;
  std::vector<RayPath> rays;

 private:
  template <class Real>
  void append_field(const FieldSums<Real>& sums, PropagationResult& result,
                    double beam_factor) const;
  template <class Real>
  void append_arrivals(const ArrivalStore<Real>& store, PropagationResult& result) const;
};

/// The first `count` points of a ray as a path.
[[nodiscard]] RayPath path_of(const LiteralRay& ray, std::size_t count);

}  // namespace asdic::detail::bellhop_emulation
