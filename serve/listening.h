#pragma once
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "serve/live_scenario.h"
#include "sonar/ping/live_stream.h"

namespace asdic::detail::serve {

class BlockSink;
class SessionState;

/// What a session hears, from its first `listen` on: pings that overlap, in a scenario that changes
/// while they sound.
///
/// A change acts where and when it happens. Sound is sent as things are when it leaves, and struck
/// and received as they are then; what was handed out before stays as it was. So each ping is
/// received in windows of time, each by the scenario of its own: what belongs to the projector as
/// it was when the ping left, arrays and noise as they are in the window, wind and what targets are
/// like as they were half of the delay before it. Where things are is on their tracks, which keep
/// their past. All of it may be called by two threads at once, one of which takes blocks.
class Listening {
 public:
  /// How the sound is handed out.
  struct Blocks {
    std::int64_t samples = 1;              ///< of a block
    std::optional<std::int64_t> end;       ///< sample at which it ends; none: it does not
    bool scheduled = false;                ///< pings of the schedule are sent by themselves
    std::shared_ptr<BlockSink> sink = {};  ///< where the samples go; none: to the client
  };
  using Place = LiveStream::Place;
  struct Block {
    std::int64_t number = 0;  ///< of the session, from 0
    double time = 0.0;        ///< of its first sample [s]
    std::size_t channels = 0, samples = 0, components = 1;
    std::vector<float> pressure;  ///< [channels × samples × components] [Pa]
    Place place = {};             ///< of the phones at its first sample
    std::shared_ptr<BlockSink> sink = {};
  };

  /// How far it has been handed out. A command takes this once: blocks go on beside it.
  struct Heard {
    std::int64_t position = 0;  ///< the next sample
    double time = 0.0;          ///< its time [s]
    double oldest = 0.0;        ///< before that nothing that still sounds was sent or struck [s]
  };

  /// \param begin  [s]
  Listening(std::shared_ptr<const PingSimulator> simulator, LiveScenario::Changes changes,
            double begin);

  [[nodiscard]] double rate() const noexcept { return rate_; }
  [[nodiscard]] std::int64_t position() const;
  [[nodiscard]] double time() const;  ///< of the next sample [s]
  [[nodiscard]] Heard heard() const;
  /// A ping leaves at the sample next to its time.
  [[nodiscard]] double whole_samples(double time) const;

  /// From now on. What was not handed out before `from` is not any more. \param from  [s]
  void begin(const Blocks& blocks, double from);
  std::int64_t end();  ///< no more, until it begins again \return the next sample
  /// None: nobody listens.
  [[nodiscard]] std::optional<Blocks> blocks() const;
  /// By whoever sends scheduled pings: all that leave before a time are in the stream [s].
  void scheduled_until(double time);
  /// Whether the next block may be made as far as those go.
  [[nodiscard]] bool is_prepared() const;
  /// The end of the next block [s].
  [[nodiscard]] double next_end() const;
  [[nodiscard]] bool is_over() const;  ///< nobody listens, or there is no next block
  /// \param may  asked with the block's end [s]; a command that looks how far it is heard looks
  /// before that, or after the block   \return none: it is over, or it may not be
  [[nodiscard]] std::optional<Block> next(const std::function<bool(double end)>& may = [](double) {
    return true;
  });

  /// Adds a ping's sound. \param state  of the scenario for it, with what it has of its own
  /// \return its record, without pressure \throws InputError
  [[nodiscard]] PingRecord send(SessionState& session, int number, const Transmission& sent,
                                const LiveScenario::State& state);
  /// All that is received from a time on, as the session's scenario has become. \param strikes
  /// whether targets or the sea are of another kind, and not only elsewhere \throws InputError, and
  /// then nothing has changed
  void change(SessionState& session, double time, bool strikes);
  /// Makes what is heard up to a time, where changes have not been followed so far. \throws
  /// InputError
  void prepare(SessionState& session, double until);
  [[nodiscard]] bool lacks(double until) const;  ///< whether that has something to do
  [[nodiscard]] bool sounds() const {
    return !sounding().empty();
  }  ///< whether any ping still does

 private:
  struct Change {
    double time = 0.0;
    LiveScenario::Changes changes;
    bool strikes = false;
  };
  /// By which scenario a ping is received, up to a sample.
  struct Window {
    std::int64_t from = 0, to = 0;
    LiveScenario::Changes changes;
  };
  /// A ping that sounds: how it was sent.
  struct Sent {
    int ping = 1;
    Transmission sent;
    LiveScenario::Changes own;         // sections that are its own
    std::vector<Window> pending = {};  // that it does not sound by so far
  };
  [[nodiscard]] PingRecord sound_in(SessionState& session, const Sent& ping,
                                    const Window& window) const;
  void follow(Sent& ping, const PingRecord& sound);
  [[nodiscard]] LiveScenario::Changes composed_for(const Sent& ping, double time) const;
  [[nodiscard]] std::int64_t end_of_next() const;  // under mutex_
  void see_to_pending();
  [[nodiscard]] std::vector<Window> steps(const std::vector<Window>& windows,
                                          std::int64_t from) const;
  [[nodiscard]] std::vector<LiveStream::Sounding> sounding() const;
  [[nodiscard]] const Change& change_at(double time) const;
  [[nodiscard]] std::vector<Window> windows(const Sent& ping, std::int64_t from,
                                            std::int64_t end) const;
  void forget();

  double rate_;
  mutable std::mutex mutex_;  // of what a block is taken from
  LiveStream stream_;
  Blocks blocks_;
  bool active_ = false;
  std::int64_t number_ = 0;
  double scheduled_until_ = 0.0;
  std::int64_t sounded_until_ = std::numeric_limits<std::int64_t>::max();
  // Of the thread that carries out commands alone:
  std::vector<Change> changes_;  // at least one, by their times
  std::vector<Sent> sent_;
};

/// How long a towed line keeps where its tow point was [s].
[[nodiscard]] double tow_memory(const Scenario& scenario);

}  // namespace asdic::detail::serve
