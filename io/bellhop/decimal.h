#pragma once
#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <string>

namespace asdic::detail::bellhop {

/// The shortest text of a number that reads back as it.
inline std::string decimal(double value) {
  char digits[32];
  return {digits, std::to_chars(digits, digits + sizeof digits, value).ptr};
}

/// The shortest text that a reader turns into `wanted`; if none does, the one that comes nearest.
/// \param guess  what should be written were there no rounding   \param read  what the reader makes
/// of a number in the file
template <class Read>
std::string decimal_read_as(double wanted, double guess, Read read) {
  char digits[40];
  std::string nearest = decimal(guess);
  double miss = std::abs(read(guess) - wanted);
  const auto is_it = [&](double value, int n) {
    char* const end =
        std::to_chars(digits, digits + sizeof digits, value, std::chars_format::general, n).ptr;
    double written = 0.0;
    std::from_chars(digits, end, written);
    const double error = std::abs(read(written) - wanted);
    if (error < miss || error == 0.0) nearest = decimal(written);
    miss = std::min(miss, error);
    return error == 0.0;
  };
  for (int n = 1; n <= 17; ++n)
    if (is_it(guess, n)) return nearest;
  // rounding on the way: a few neighbours, in double and in single precision
  const double spacing[] = {std::abs(guess) * std::numeric_limits<double>::epsilon() * 0.5,
                            std::abs(guess) * double(std::numeric_limits<float>::epsilon()) * 0.25};
  for (const double h : spacing)
    for (int i = 1; i <= 8; ++i)
      if (is_it(guess + i * h, 17) || is_it(guess - i * h, 17)) return nearest;
  return nearest;
}

}  // namespace asdic::detail::bellhop
