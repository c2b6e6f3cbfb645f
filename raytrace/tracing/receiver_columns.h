#pragma once
#include <cstdint>
#include <span>
#include <vector>

namespace asdic::detail {

/// A point where sound is received, in the plane of the transect.
struct ReceiverPoint {
  double range = 0.0;  ///< along the transect [m]
  double depth = 0.0;  ///< [m]
};

/// Receivers that share a range: a fan crosses their column once for all of them.
struct ReceiverColumn {
  double range = 0.0;                  ///< [m]
  std::vector<double> depths;          ///< [n] increasing [m]
  std::vector<std::uint32_t> indices;  ///< [n] of the receivers as given

  /// Indices [first, last) into `depths` of the receivers between two depths, ends included.
  struct Between {
    std::size_t first, last;
    [[nodiscard]] bool empty() const noexcept { return first >= last; }
  };
  [[nodiscard]] Between between(double low, double high) const noexcept;
};

/// Receivers anywhere, sorted into columns of increasing range.
[[nodiscard]] std::vector<ReceiverColumn> make_columns(std::span<const ReceiverPoint> receivers);

}  // namespace asdic::detail
