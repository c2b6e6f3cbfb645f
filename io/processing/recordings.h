#pragma once
#include <cstddef>
#include <filesystem>
#include <optional>
#include <vector>

#include "io/ping/ping_file.h"
#include "processing/ping_processor.h"
#include "processing/received_pings.h"
#include "processing/scoring.h"
#include "sonar/scenario/scenario.h"

namespace asdic::detail {

/// What a ping file holds for a receiver: each array's recording of each ping, the pulses, the
/// scenario, and the truth to hold detections against. Passband and complex baseband, single pings
/// and continuous records.
class PingRecordings final : public ReceivedPings {
 public:
  /// \param scenario_path  stands for the file's own scenario in messages, and gives the folder of
  /// files that it names; none: the ping file's folder
  /// \throws InputError if it is not a ping file, or its scenario cannot be read
  explicit PingRecordings(const std::filesystem::path& path,
                          const std::optional<std::filesystem::path>& scenario_path = {});

  [[nodiscard]] const Scenario& scenario() const noexcept override { return scenario_; }
  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }
  [[nodiscard]] std::size_t pings() const noexcept override { return numbers_.size(); }
  /// Number of the ping in a row, from 1. \param row  from 0
  [[nodiscard]] int number(std::size_t row) const noexcept { return numbers_[row]; }
  /// The row of a ping. \throws InputError ("ping") if there is none
  [[nodiscard]] std::size_t row_of(int number) const override;
  [[nodiscard]] double ping_time(std::size_t row) const noexcept override { return times_[row]; }
  [[nodiscard]] int transmitter(std::size_t row) const noexcept override {
    return transmitters_.empty() ? 0 : transmitters_[row];
  }

  /// [transmitters] what each sends
  [[nodiscard]] std::vector<Replica> replicas() const;
  /// Samples that are not finite are taken as silence, and counted.
  /// \throws InputError if none of them is finite: that is no recording
  [[nodiscard]] ArrayRecording recording(std::size_t row, int array) const override;
  /// Samples of the recording read last that were not finite.
  [[nodiscard]] std::size_t not_finite() const noexcept override { return not_finite_; }
  /// When the recording of a row ends, after the ping's start [s].
  [[nodiscard]] double end(std::size_t row) const override;

  /// In a continuous record with those of other pings that are received in its time (another_ping).
  [[nodiscard]] std::vector<TrueEcho> echoes(std::size_t row, int array) const override;
  /// The targets where the echo strikes them, half an echo's way after the ping; those without an
  /// echo where they are when it starts.
  [[nodiscard]] std::vector<TrueTarget> targets(std::size_t row,
                                                const std::vector<TrueEcho>& echoes) const override;

 private:
  [[nodiscard]] bool complex_samples() const noexcept { return shape_.size() == 4; }
  void read_direct_sound();
  /// How many samples of which rows make a recording: one row, or several of a continuous one.
  struct Piece {
    std::size_t row, samples;
  };
  [[nodiscard]] std::vector<Piece> pieces(std::size_t row) const;

  std::filesystem::path path_;
  Hdf5File file_;
  Scenario scenario_;
  Shape shape_;
  std::vector<int> numbers_, transmitters_;
  std::vector<double> times_;
  std::vector<std::int64_t> valid_;
  double rate_ = 0.0, start_ = 0.0;
  std::optional<double> carrier_;
  bool continuous_ = false;
  std::vector<TrueEcho> all_echoes_;
  std::vector<int> echo_ping_, echo_array_;
  mutable std::size_t not_finite_ = 0;
};

}  // namespace asdic::detail
