#pragma once
#include <span>
#include <vector>

namespace asdic::detail {

/// The cheapest way to give each row at most one column: as many pairs as possible without any of
/// infinite cost, and of those the least sum (Hungarian method; Kuhn, Nav. Res. Log. Q. 2, 83
/// (1955), in the O(n³) form of Jonker & Volgenant). \param cost  [rows × columns], ∞: not allowed
/// \return [rows] column, −1: none
[[nodiscard]] std::vector<int> assign(std::span<const double> cost, int rows, int columns);

}  // namespace asdic::detail
