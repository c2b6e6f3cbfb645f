#pragma once
#include <cstdint>
#include <span>

#include "core/random.h"

namespace asdic::detail {

/// Many independent normals (mean 0, variance 1) at once, of the stream (seed, purpose,
/// realisation, entity): Philox blocks and Box–Muller, sixteen blocks to a step, no library calls
/// in the loop.
///
/// Value i depends on i and the stream alone: a longer span begins with the shorter one's values,
/// and any thread gives the same bits. The largest magnitude is 6.7 (32-bit uniforms). Not the
/// values of RandomStream::normal(), though out of the same blocks.
/// \param first  index in the stream of values[0], a multiple of 64
void fill_normal(std::span<float> values, std::uint64_t seed, Draw purpose,
                 std::uint32_t realisation, std::uint64_t entity, std::uint64_t first = 0);

}  // namespace asdic::detail
