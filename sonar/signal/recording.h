#pragma once
#include <cstddef>
#include <limits>
#include <span>

namespace asdic::detail {

/// When, how finely and about which carrier the phones record. t = 0 is the leading edge of the
/// pulse at the projector.
struct Recording {
  double sample_rate = 16000.0;  ///< [Hz]
  double start = 0.0;            ///< of the first sample [s]
  std::size_t samples = 0;       ///< of each phone
  double carrier = 0.0;          ///< of complex baseband samples [Hz]; 0: real pressure
  double epoch = 0.0;            ///< when the pulse left, on the clock that the carrier runs by [s]

  [[nodiscard]] bool is_complex() const noexcept { return carrier > 0.0; }
  [[nodiscard]] std::size_t components() const noexcept { return is_complex() ? 2 : 1; }
};

/// What of a record is asked for [s after the ping]: the rest of it may be anything.
struct HeardPart {
  double from = -std::numeric_limits<double>::infinity();
  double to = std::numeric_limits<double>::infinity();

  /// Whether a sound of that time may be heard.
  [[nodiscard]] bool meets(double begin, double end) const noexcept {
    return end >= from && begin <= to;
  }
};

/// The samples of one ping's record, for what adds to them.
struct RecordSamples {
  int ping = 1;             ///< counted from 1
  double start_time = 0.0;  ///< of the ping in the scenario [s]
  Recording recording;
  std::size_t channels = 0;   ///< of all arrays
  std::span<float> pressure;  ///< [channels × samples × components of the recording] [Pa]
};

}  // namespace asdic::detail
