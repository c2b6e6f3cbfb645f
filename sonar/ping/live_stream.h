#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "sonar/ping/ping.h"
#include "sonar/ping/ping_record.h"

namespace asdic::detail {

/// What all phones receive from some time on, without gaps: the sound of pings that overlap, the
/// sea's noise and ships, through the receivers. It is handed out part by part, in order, and may
/// be changed from any sample on that has not been handed out: nothing that comes later changes
/// what went before. The same bits come out whatever the parts' lengths. Sample n is that of n /
/// rate since the start of the scenario. Memory: the records of the pings that still sound.
class LiveStream {
 public:
  /// A ping whose sound is not over.
  struct Sounding {
    int ping = 1;
    Transmission sent;
    std::int64_t first = 0;  ///< sample at which its leading edge leaves
    std::int64_t end = 0;    ///< of its record
    int platform = 0;        ///< that carries its transmitter, an index
    std::int64_t over = 0;   ///< first sample after the pulse has left
  };

  /// \param simulator  of what surrounds the phones; its scenario is a continuous one
  /// \param first      sample, as counted from the scenario's start
  LiveStream(std::shared_ptr<const PingSimulator> simulator, std::int64_t first);

  [[nodiscard]] std::int64_t position() const noexcept { return position_; }  ///< the next sample
  [[nodiscard]] double rate() const noexcept { return rate_; }
  [[nodiscard]] std::size_t channels() const noexcept { return channels_; }
  [[nodiscard]] std::size_t components() const noexcept { return width_; }  ///< of a sample
  [[nodiscard]] double time_of(std::int64_t sample) const noexcept {
    return double(sample) / rate_;
  }
  /// The first sample that is not before a time.
  [[nodiscard]] std::int64_t sample_at(double time) const noexcept;
  /// The sample nearest to a time: pings leave at samples.
  [[nodiscard]] std::int64_t nearest_sample(double time) const noexcept;

  /// Adds what is received of a ping. Its pressure is moved out of the record. \param sound  of
  /// PingSimulator::sound(), of a ping that leaves at a sample (not before position()) and has a
  /// later number than those before it   \param pulse  its duration [s]
  void add(PingRecord& sound, const Transmission& sent, double pulse);
  /// From sample `from` up to, not including, `to` a ping sounds otherwise. \param from  not before
  /// position()
  void replace(int ping, const PingRecord& sound, std::int64_t from, std::int64_t to);
  /// From a sample on, what surrounds the phones, and their electronics, are another simulator's.
  void surround(std::shared_ptr<const PingSimulator> simulator, std::int64_t from);

  /// The next samples. Whatever it throws, none of them has been taken then.
  /// \return [channels × samples × components] [Pa]
  [[nodiscard]] std::vector<float> take(std::size_t samples);

  /// What lies before a sample is not handed out.
  void skip_to(std::int64_t sample);

  /// By whose scenario, and in the shape of which ping, the phones lie at the next sample.
  struct Place {
    std::shared_ptr<const PingSimulator> simulator;
    int ping = 1;
  };
  [[nodiscard]] Place place() const;

  /// Those that are not over, in the order of their numbers.
  [[nodiscard]] std::vector<Sounding> sounding() const;
  [[nodiscard]] std::size_t bytes() const noexcept;  ///< that they take

 private:
  struct Ping {
    Sounding about;
    std::vector<float> pressure;  // [channels × samples × components]
  };
  /// Who makes what is around, from a sample on, while arrays have the shape of one ping.
  struct Stage {
    std::int64_t from = 0;
    std::shared_ptr<const PingSimulator> simulator;
    int ping = 1;
    std::int64_t piece = -1;                    // of the surroundings, that is made
    std::vector<float> around = {};             // it: [channels × samples × components]
    ReceiverElectronics::Carried carried = {};  // of the one after it
  };
  void begin_stage(Stage stage);
  void forget();
  [[nodiscard]] Stage& stage_at(std::int64_t sample);
  void make_piece(Stage& stage, std::int64_t number) const;
  /// Puts samples begin … end − 1, of one piece of a stage, into rows of `row` samples from `at`
  /// on.
  void take_part(const Stage& stage, std::int64_t begin, std::int64_t end, std::span<float> rows,
                 std::size_t row, std::size_t at) const;

  double rate_;
  std::size_t channels_, width_;
  std::int64_t piece_;  // samples of the surroundings that are made at once
  std::int64_t position_;
  std::vector<Ping> pings_;
  std::vector<Stage> stages_;  // at least one, by their beginnings
};

}  // namespace asdic::detail
