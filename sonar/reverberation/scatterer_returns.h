#pragma once
#include <complex>
#include <cstdint>

#include "reverb/fields/met_scatterer.h"
#include "sonar/paths/return_source.h"

namespace asdic::detail {

/// Adds what an array receives of a pair of paths through a scatterer, with an amplitude at each
/// point of the band. \param pair  one of the pairs   \param weight  of the scatterer
void add_return(const ScatteringField& field, const PathPairs& pairs, const PathPair& pair,
                const MetScatterer& met, std::complex<double> weight, ReturnBlock& into);

/// Adds the returns of every scatterer of the rings begin … end − 1, each by all its pairs of paths
/// and with a complex Gaussian weight.
void add_scatterers(const ScatteringField& field, const ScattererMeeting& meeting,
                    std::uint32_t begin, std::uint32_t end, ReturnBlock& into);

}  // namespace asdic::detail
