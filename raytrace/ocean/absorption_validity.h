#pragma once
#include <optional>

#include "core/validity.h"
#include "raytrace/ocean/absorption.h"

namespace asdic::detail {

/// Where a law of absorption holds; none: it is none. \param frequency  that it is asked at: what
/// dissolves in the water counts for less above 500 kHz [Hz]
[[nodiscard]] std::optional<Validity> validity(const Absorption& absorption, double frequency);

}  // namespace asdic::detail
