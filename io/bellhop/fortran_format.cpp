#include "io/bellhop/fortran_format.h"

#include <charconv>
#include <cmath>
#include <string_view>

namespace asdic::detail::bellhop {
namespace {

constexpr double powers_of_ten[] = {1e0, 1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,
                                    1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16, 1e17};

/// G format: fixed point with so many digits and blanks in place of the exponent if 0.1 ≤ |x| <
/// 10^digits, else scientific. \param width  without the blank before it
void append_real(std::string& text, double value, int digits, int exponent_digits,
                 std::size_t width) {
  char buffer[64];
  char* const end = buffer + sizeof buffer - 1;
  const double size = std::abs(value);
  std::size_t trailing = 0;
  char* last = buffer;
  if (!std::isfinite(value)) {
    const std::string_view word = std::isnan(value) ? "NaN"
                                  : value > 0.0     ? "Infinity"
                                                    : "-Infinity";
    last = buffer + word.copy(buffer, word.size());
  } else if (size == 0.0 || (size >= 0.1 && size < powers_of_ten[digits])) {
    int whole = size == 0.0 ? 1 : 0;  // digits before the point
    while (size >= powers_of_ten[whole]) ++whole;
    last = std::to_chars(buffer, end, value, std::chars_format::fixed, digits - whole).ptr;
    if (whole == digits) *last++ = '.';
    trailing = std::size_t(exponent_digits) + 2;
  } else {
    last = std::to_chars(buffer, end, value, std::chars_format::scientific, digits - 1).ptr;
    char* exponent = last;
    while (*--exponent != 'e') {
    }
    *exponent = 'E';
    char* const first_digit = exponent + 2;
    for (auto n = last - first_digit; n < exponent_digits; ++n, ++last) {
      for (char* c = last; c > first_digit; --c) *c = c[-1];
      *first_digit = '0';
    }
  }
  const auto length = std::size_t(last - buffer);
  const std::size_t room = width > length + trailing ? width - length - trailing : 0;
  text.append(room + 1, ' ').append(buffer, length).append(trailing, ' ');
}

}  // namespace

void append_real4(std::string& text, float value) { append_real(text, double(value), 9, 2, 16); }

void append_real8(std::string& text, double value) { append_real(text, value, 17, 3, 25); }

void append_integer(std::string& text, std::int64_t value) {
  char buffer[24];
  const char* const last = std::to_chars(buffer, buffer + sizeof buffer, value).ptr;
  const auto length = std::size_t(last - buffer);
  text.append(length < 11 ? 12 - length : 1, ' ').append(buffer, length);
}

}  // namespace asdic::detail::bellhop
