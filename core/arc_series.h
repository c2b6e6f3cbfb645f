#pragma once

namespace asdic::detail {

/// (atanh x)/x and (asin x)/x by their series, for numbers or lanes of them with |x| <
/// short_series, to rounding: a layer changes the speed by a few per cent.
inline constexpr double short_series = 0.06;

template <class T>
inline T atanh_series(const T& x) {  // next term x¹⁴/15 = 1e-18
  const T y = x * x;
  return 1.0 +
         y * (1.0 / 3 + y * (1.0 / 5 + y * (1.0 / 7 + y * (1.0 / 9 + y * (1.0 / 11 + y / 13.0)))));
}

template <class T>
inline T asin_series(const T& x) {
  const T y = x * x;
  return 1.0 + y * (1.0 / 6 +
                    y * (3.0 / 40 +
                         y * (15.0 / 336 +
                              y * (105.0 / 3456 + y * (945.0 / 42240 + y * (10395.0 / 599040))))));
}

}  // namespace asdic::detail
