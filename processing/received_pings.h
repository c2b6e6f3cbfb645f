#pragma once
#include <cstddef>
#include <vector>

#include "processing/ping_processor.h"
#include "processing/scoring.h"
#include "sonar/scenario/scenario.h"

namespace asdic::detail {

/// Pings of one scenario as a receiver receives them, with the truth to hold detections against:
/// rows in the order in which they were sent.
class ReceivedPings {
 public:
  ReceivedPings() = default;
  ReceivedPings(const ReceivedPings&) = delete;
  ReceivedPings& operator=(const ReceivedPings&) = delete;
  virtual ~ReceivedPings() = default;

  [[nodiscard]] virtual const Scenario& scenario() const noexcept = 0;
  [[nodiscard]] virtual std::size_t pings() const noexcept = 0;  ///< rows
  /// The row of a ping's number. \throws InputError if there is none
  [[nodiscard]] virtual std::size_t row_of(int number) const = 0;
  [[nodiscard]] virtual double ping_time(std::size_t row) const noexcept = 0;
  [[nodiscard]] virtual int transmitter(std::size_t row) const noexcept = 0;
  /// When the recording of a row ends, after the ping's start [s].
  [[nodiscard]] virtual double end(std::size_t row) const = 0;
  /// Samples that are not finite are taken as silence, and counted.
  [[nodiscard]] virtual ArrayRecording recording(std::size_t row, int array) const = 0;
  /// Samples of the recording read last that were not finite.
  [[nodiscard]] virtual std::size_t not_finite() const noexcept = 0;
  [[nodiscard]] virtual std::vector<TrueEcho> echoes(std::size_t row, int array) const = 0;
  /// The targets where the echo strikes them; those without an echo where they are when it starts.
  [[nodiscard]] virtual std::vector<TrueTarget> targets(
      std::size_t row, const std::vector<TrueEcho>& echoes) const = 0;
};

}  // namespace asdic::detail
