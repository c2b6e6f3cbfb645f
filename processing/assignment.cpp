#include "processing/assignment.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace asdic::detail {

std::vector<int> assign(std::span<const double> cost, int rows, int columns) {
  // A square problem: what is not allowed, and what has no partner, costs more than all else.
  const int n = std::max(rows, columns);
  double sum = 1.0;
  for (const double c : cost)
    if (std::isfinite(c)) sum += std::abs(c);
  const auto price = [&](int i, int j) {
    if (i >= rows || j >= columns) return sum;
    const double c = cost[static_cast<std::size_t>(i) * static_cast<std::size_t>(columns) +
                          static_cast<std::size_t>(j)];
    return std::isfinite(c) ? c : sum;
  };
  // Potentials u, v and the row that holds each column; index 0 is a dummy.
  const auto size = static_cast<std::size_t>(n) + 1;
  std::vector<double> u(size, 0.0), v(size, 0.0);
  std::vector<int> holder(size, 0), way(size, 0);
  for (int i = 1; i <= n; ++i) {
    holder[0] = i;
    int column = 0;
    std::vector<double> least(size, std::numeric_limits<double>::infinity());
    std::vector<char> used(size, 0);
    do {  // grow the tree of alternating paths until a free column is met
      used[static_cast<std::size_t>(column)] = 1;
      const int row = holder[static_cast<std::size_t>(column)];
      double delta = std::numeric_limits<double>::infinity();
      int next = 0;
      for (int j = 1; j <= n; ++j) {
        const auto at = static_cast<std::size_t>(j);
        if (used[at]) continue;
        const double reduced = price(row - 1, j - 1) - u[static_cast<std::size_t>(row)] - v[at];
        if (reduced < least[at]) {
          least[at] = reduced;
          way[at] = column;
        }
        if (least[at] < delta) {
          delta = least[at];
          next = j;
        }
      }
      for (int j = 0; j <= n; ++j) {
        const auto at = static_cast<std::size_t>(j);
        if (used[at]) {
          u[static_cast<std::size_t>(holder[at])] += delta;
          v[at] -= delta;
        } else {
          least[at] -= delta;
        }
      }
      column = next;
    } while (holder[static_cast<std::size_t>(column)] != 0);
    do {
      const int before = way[static_cast<std::size_t>(column)];
      holder[static_cast<std::size_t>(column)] = holder[static_cast<std::size_t>(before)];
      column = before;
    } while (column != 0);
  }
  std::vector<int> result(static_cast<std::size_t>(rows), -1);
  for (int j = 1; j <= columns; ++j) {
    const int row = holder[static_cast<std::size_t>(j)] - 1;
    if (row >= 0 && row < rows &&
        std::isfinite(cost[static_cast<std::size_t>(row * columns + j - 1)]))
      result[static_cast<std::size_t>(row)] = j - 1;
  }
  return result;
}

}  // namespace asdic::detail
