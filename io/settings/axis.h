#pragma once
#include <span>
#include <vector>

namespace asdic::detail {

/// Largest `count` of { first, last, count }.
inline constexpr int most_on_an_axis = 10'000'000;

/// `count` values from first to last, both included: what { first, last, count } stands for.
[[nodiscard]] std::vector<double> evenly_spaced(double first, double last, std::size_t count);

/// Whether { first, last, count } says the same as these, bit for bit, and in fewer words.
[[nodiscard]] bool are_evenly_spaced(std::span<const double> values);

}  // namespace asdic::detail
