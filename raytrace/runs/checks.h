#pragma once
#include "raytrace/propagation_case.h"

namespace asdic {

/// What every run asks of a case: water that is deep enough, sources in it, a fan with width.
/// \throws InputError naming the first thing that makes no sense
void check_sources(const PropagationCase& run_case);

/// And receivers, for runs that have any. \throws InputError
void check_receivers(const PropagationCase& run_case);

}  // namespace asdic
