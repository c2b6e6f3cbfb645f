#pragma once
#include "io/bellhop/bellhop_files.h"
#include "io/bellhop/case_reader.h"
#include "raytrace/propagation.h"

/// Answers of a run as the files of BELLHOP hold them.
namespace asdic::detail::bellhop {

/// The field. A point source's coherent pressure has the other sign there than here (−1/√r against
/// the sum of the arrivals), and so have the roots of its intensities.
/// \throws InputError if the run made no field
[[nodiscard]] ShadeFile shade_file(const PropagationCase& run_case, PropagationResult result,
                                   Dialect dialect = Dialect::fortran);

/// The arrivals: |amplitude| without absorption, which goes into the imaginary delay, and the phase
/// of reflections and caustics, unwrapped as far as bounces and caustics tell. Delays are rounded
/// to single precision by the file.
[[nodiscard]] ArrivalsFile arrivals_file(const PropagationCase& run_case,
                                         const PropagationResult& result, bool binary,
                                         Dialect dialect = Dialect::fortran);

/// The same of a case that was read, with all its planes: a case of BELLHOP3D has files of
/// BELLHOP3D. \param result  of run_all_planes()
[[nodiscard]] ShadeFile shade_file(const Input& input, PropagationResult result, Dialect dialect);
[[nodiscard]] ArrivalsFile arrivals_file(const Input& input, const PropagationResult& result,
                                         Dialect dialect);

/// The rays, source by source, by increasing declination.
[[nodiscard]] RayFile ray_file(const PropagationCase& run_case, const PropagationResult& result);

}  // namespace asdic::detail::bellhop
