#pragma once
#include <optional>

#include "raytrace/beams/convergence.h"
#include "raytrace/cases/propagation_case.h"
#include "raytrace/cases/propagation_result.h"
#include "raytrace/parallel/progress.h"

namespace asdic::detail {

/// What became of the sum of all paths to a receiver.
struct RaySum {
  std::complex<double> value = 0.0;  ///< a pressure, or an intensity
  double error = 0.0;                ///< of it
  int paths = 0;
};

/// Whether a case asks for hats of its own number, Cartesian or ray-centred, forward from the
/// source and in water that is all within the box: then their limit is the sum of paths.
[[nodiscard]] bool narrows_to_paths(const PropagationCase& run_case);

/// A receiver's depth between flat boundaries: up to 1 mm beyond one, by rounding, it is on it;
/// further off there is no water.
[[nodiscard]] std::optional<double> depth_in_water(const Environment& ocean, double depth) noexcept;

/// Sums as a field, with the |ΔTL| that their errors may make at 95 % of the receivers that receive
/// anything. \param sums  [rows × ranges]
[[nodiscard]] ConvergedField field_of_sums(const std::vector<RaySum>& sums, bool coherent);

/// Whether both walls are smooth and reflect all angles alike, as do vacuum, a rigid wall and the
/// same water. The sum of images is then the wave equation's field and not only that of rays.
[[nodiscard]] bool mirrors_exactly(const PropagationCase& run_case) noexcept;

/// The field of a source in isovelocity water between flat boundaries, as a sum over its images: of
/// rays that take every path there is, in closed form. Nothing if the case is no such guide, asks
/// for beams whose limit is not the sum of paths, or has so many receivers and images that beams
/// are cheaper. Walls may reflect in any way, rough or smooth.
///
/// Images come in shells of four, k bounces off each wall and one more or less. They are added
/// until the largest |R_s R_b|^k of steeper paths bounds what is left to 10⁻⁵ of the root of the
/// summed intensity. A guide that loses nothing has no end of them: their tail is extrapolated
/// (coherent: Levin's u-transform; intensities: a power series in 1/k). Each image is reflected as
/// a plane wave is, which the note states. docs/theory/fields.md, "Images" \throws Interrupted
[[nodiscard]] std::optional<ConvergedField> image_field(const PropagationCase& run_case,
                                                        double source_depth,
                                                        const Progress& progress = {});

}  // namespace asdic::detail
