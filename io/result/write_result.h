#pragma once
#include <optional>

#include "io/hdf5/hdf5_output.h"
#include "io/result/result_file.h"
#include "raytrace/propagation.h"

namespace asdic::detail {

/// How BELLHOP's kinds of file are written. None: as the result has it.
struct BellhopWriting {
  std::optional<bool> wide{};    ///< numbers of 8 bytes in the head of .shd and .arr
  std::optional<bool> binary{};  ///< arrivals
};

/// Writes a field, arrivals or rays: HDF5, or by the name's ending .shd, .arr or .ray.
/// \param earth  where its plane is
/// \throws InputError for a name of another kind, RunError
void write_result(OutputFile&& to, PropagationFile&& result, const BellhopWriting& how = {},
                  const EarthLine& earth = {});

/// What a run was asked for, as such a file holds it.
[[nodiscard]] PropagationFile propagation_file(const PropagationCase& run_case,
                                               PropagationResult&& found);

}  // namespace asdic::detail
