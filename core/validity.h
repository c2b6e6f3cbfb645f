#pragma once
#include <span>
#include <string>
#include <string_view>

namespace asdic::detail {

/// One quantity, and between which values of it a law's source vouches for the law.
struct ValidRange {
  std::string_view quantity;  ///< "frequency"
  std::string_view unit;      ///< "Hz"
  double low, high;
};

/// Where an empirical law holds, by its source. It stands beside the law's formula; `outside` is
/// the one place that reads it.
struct Validity {
  std::string_view law;     ///< "Chapman-Harris"
  std::string_view source;  ///< "JASA 34, 1592, 1962"
  std::span<const ValidRange> ranges;
};

/// What a law is asked about: values of a quantity from low to high.
struct Asked {
  std::string_view quantity;
  double low, high;
};

/// The first quantity that a law is asked about where it does not hold, in words: "frequency 100000
/// Hz is outside of 100 to 25000 Hz, where Knudsen's law holds (…)". "" where it holds. A quantity
/// that the law knows no range of is passed over.
[[nodiscard]] std::string outside(const Validity& validity, std::span<const Asked> asked);

}  // namespace asdic::detail
