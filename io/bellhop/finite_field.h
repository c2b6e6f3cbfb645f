#pragma once
#include <complex>
#include <span>

namespace asdic::detail {

/// The gate that every field passes before it is written, whatever the format: a file holds a
/// number at every receiver, or is not written.
/// \throws RunError that says at how many of them there is none
void require_finite(std::span<const std::complex<float>> pressure);

}  // namespace asdic::detail
