#pragma once
#include <functional>
#include <memory>
#include <string_view>
#include <utility>

#include "core/memory_budget.h"
#include "raytrace/paths/eigenrays.h"
#include "raytrace/places/propagation_paths.h"
#include "sonar/echoes/echo.h"
#include "sonar/noise/ambient_noise.h"
#include "sonar/noise/interference.h"
#include "sonar/paths/shared_propagation.h"
#include "sonar/ping/ping_record.h"
#include "sonar/ping/receiver_electronics.h"
#include "sonar/reverberation/phone_groups.h"
#include "sonar/reverberation/reverberation_model.h"
#include "sonar/scenario/ping_geometry.h"
#include "sonar/scenario/scenario.h"
#include "sonar/scenario/transmission.h"
#include "sonar/signal/pulse.h"

namespace asdic::detail {

struct TwoStepBand;

/// Some of the samples of a record.
struct SampleRange {
  std::ptrdiff_t first = 0;
  std::size_t count = 0;
};

/// Simulates the pings of one scenario. Built once (the ocean, the pulse); simulate() is const in
/// effect and may be called from many threads at once, for any ping in any order: the same bits
/// come out.
class PingSimulator {
 public:
  /// Says which part of a ping's record is wanted, once its echoes and legs are in it.
  using ChoosePart = std::function<SampleRange(const PingRecord&)>;

  /// \param shared  what simulators of equal oceans have in common; none: nothing. It never changes
  /// what comes out \param budget  of a ping \throws InputError naming the key at fault
  /// ("pings.sample_rate", "pulse.duration", …)
  explicit PingSimulator(Scenario scenario,
                         const std::shared_ptr<SharedPropagation>& shared = nullptr,
                         MemoryBudget budget = {});

  /// The record of one ping by itself, as it goes into a file of separate pings. \param ping
  /// counted from 1
  [[nodiscard]] PingRecord simulate(int ping) const;
  /// The same for a ping that is sent when and how the schedule does not say (serve/session.h).
  /// \param ping  its number from 1, by which random numbers are drawn
  [[nodiscard]] PingRecord simulate(int ping, const Transmission& sent) const;
  /// The same of which only a part is made: samples of the record as it would be, of another draw
  /// of noise and scatterers. The whole where the part would not be alike: of receivers that ring,
  /// of a stream, where the sender blanks it, and without noise. \param part  is asked once
  [[nodiscard]] PingRecord simulate(int ping, const ChoosePart& part) const;
  /// From now on nobody compares what is received with another ping, or another array: a
  /// realisation has one ping. Scatterers that keep their weights are then drawn as those that do
  /// not.
  void receives_one_ping() noexcept { one_ping_ = true; }
  /// Which step a ping is at, for whoever watches. \param done  the share of its steps that is done
  using TellStep = std::function<void(int ping, double done, std::string_view doing)>;
  /// From now on each ping tells its steps, from its own thread.
  void tell_steps(TellStep tell) { tell_step_ = std::move(tell); }
  /// The same before noise, blanking and the receivers: what is received of this ping alone.
  /// Streams add these up (sonar/ping/live_stream.h). \param heard  part of the record that is
  /// asked for: the rest may be anything
  [[nodiscard]] PingRecord sound(int ping) const { return sound(ping, transmission(ping)); }
  [[nodiscard]] PingRecord sound(int ping, const Transmission& sent, const ChoosePart& part = {},
                                 const HeardPart& heard = {}) const;

  /// Samples of a stream, counted from the start of the scenario.
  struct StreamPart {
    int ping = 1;  ///< the latest: arrays have its shapes
    std::int64_t first = 0;
    std::size_t samples = 0;
  };
  /// The sea's noise and ships in part of a stream, through the receivers. \param carried  of the
  /// part before it, and for the next; empty: it is the first   \return [channels × samples ×
  /// components] [Pa]
  [[nodiscard]] std::vector<float> surroundings(const StreamPart& part,
                                                ReceiverElectronics::Carried& carried) const;
  /// How ships are received at a part's first sample.
  [[nodiscard]] std::vector<ReceivedPath> ships(const StreamPart& part) const;
  /// Phones of a platform receive nothing in some samples of a record: it sends. \param samples
  /// [channels × row × components]   \param begin, end  within the row
  void blank(int platform, std::span<float> samples, std::size_t begin, std::size_t end) const;
  /// Analogue-to-digital conversion of all that is received.
  void convert(std::span<float> samples, std::size_t row) const;

  /// What a study asks of a ping when it asks for no samples: legs, echoes and the summary of
  /// simulate(), bit for bit, and the places of things. Nothing is synthesised and no noise is
  /// drawn: pressure, level series, patches and interference stay empty.
  [[nodiscard]] PingRecord levels(int ping) const;

  /// An array's reverberation as streams of noise, of which means over draws are sums.
  struct MeanSea {
    std::shared_ptr<const ReverberationStreams> streams;  ///< none: there is no reverberation
    std::vector<Vec3> phones;    ///< from the point where their delays are [m]
    double peak_pressure = 0.0;  ///< of what is sent, at 1 m [Pa]
  };
  /// \throws InputError where simulate() receives something else: scatterers with a texture or
  /// weights that last, one amplitude for each frequency, receivers that ring, pings that go on
  [[nodiscard]] MeanSea mean_sea(int ping, int array) const;

  /// What simulate() asks for before it makes a ping: what that takes at its peak, by what takes
  /// it, within its budget. Traces the paths to scatterers. \throws MemoryError if that is
  /// too much, as simulate() does
  [[nodiscard]] MemoryBudget memory(int ping = 1) const;

  /// What the bounces that are followed leave out of a scenario.
  struct JudgedPaths {
    Bounces followed;                   ///< the most that any sound is given, and what is left out
    std::vector<std::string> warnings;  ///< where that is more than a little
  };
  /// Estimates it for each transmitter's first ping, and adds the warnings to the scenario's notes.
  JudgedPaths judge_paths();

  [[nodiscard]] const Scenario& scenario() const noexcept { return scenario_; }
  /// Of the ocean as the scenario gives it, along its transect where it has one.
  [[nodiscard]] const EigenraySolver& ocean() const noexcept { return paths_->along_transect(); }
  [[nodiscard]] const PropagationPaths& paths() const noexcept { return *paths_; }
  [[nodiscard]] const Pulse& pulse(int transmitter = 0) const noexcept {
    return pulses_[static_cast<std::size_t>(transmitter)];
  }
  [[nodiscard]] int pings() const noexcept {
    return static_cast<int>(transmissions_.size());
  }  ///< of all transmitters
  /// \param ping  counted from 1
  [[nodiscard]] const Transmission& transmission(int ping) const noexcept {
    return transmissions_[static_cast<std::size_t>(ping - 1)];
  }
  /// Where everything is while it sounds.
  [[nodiscard]] PingGeometry geometry(int ping) const {
    return {scenario_, transmission(ping), ping};
  }
  [[nodiscard]] Transmitter transmitter(int ping) const;  ///< with the elevation of that ping
  [[nodiscard]] double ground_spacing() const;  ///< of the reverberation's ground grid [m]
  /// Around a place, in which its paths are followed; 1: the same at every bearing.
  [[nodiscard]] int reverberation_planes() const;

 private:
  [[nodiscard]] PingRecord blank_record(const PingGeometry& geometry) const;
  /// What a ping is for all who receive it.
  struct Emission {
    PingGeometry geometry;
    Transmitter projector;
    const Pulse& pulse;
    BeamPattern pattern;
  };
  /// Echoes and direct blasts: those that are received path by path, and sounds of all phones, of
  /// targets with very many paths.
  struct SparseReturns {
    std::vector<EchoPath> paths;
    std::vector<Baseband> many;
  };
  /// Puts them into the record, too, with their legs.
  SparseReturns sparse_returns(const EchoContext& context, const Emission& emission,
                               PingRecord& record) const;
  /// Largest envelope of a target's echoes as they add (SummaryParts::peak).
  [[nodiscard]] double peak_of(const Emission& emission, int array,
                               std::span<const EchoPath> echoes, PingRecord& record) const;
  [[nodiscard]] Emission emit(const Transmission& sent, int ping) const;
  /// Parts of the pulse's band for echoes of many paths; empty: amplitudes at the centre serve the
  /// whole band.
  /// \param loudest  the loudest of these echoes   \param last  time of the last one [s]
  [[nodiscard]] TwoStepBand band_of(const EchoContext& context, const Emission& emission,
                                    const PingRecord& record, std::span<const EchoPath> loudest,
                                    double last) const;
  [[nodiscard]] EchoContext echo_context(const Emission& emission, int array,
                                         PingRecord& record) const;
  [[nodiscard]] ReverberationContext reverberation_context(const Emission& emission, int array,
                                                           PingRecord& record,
                                                           std::span<const Vec3> phones,
                                                           std::span<const BandPoint> band,
                                                           MemoryBudget* budget) const;
  [[nodiscard]] PingReverberation reverberation(const Emission& emission, int array,
                                                PingRecord& record, std::span<const Vec3> phones,
                                                std::span<const BandPoint> band,
                                                MemoryBudget budget, bool plane_waves = true) const;
  [[nodiscard]] Front front_of_reverberation(const Emission& emission, int array) const;
  [[nodiscard]] PhoneGroups plane_wave_fit(const Emission& emission, int array) const;
  [[nodiscard]] PhoneGroups reverberation_groups(const Emission& emission, int array,
                                                 PhoneGroups whole,
                                                 const PingReverberation& received) const;
  [[nodiscard]] Baseband sea_of_groups(const Synthesizer& synthesizer, const Emission& emission,
                                       int array, PingRecord& record, const PhoneGroups& groups,
                                       std::span<const BandPoint> band,
                                       const MemoryBudget& budget) const;
  [[nodiscard]] Bounces judged_echoes(const PingGeometry& geometry, int array) const;
  [[nodiscard]] Bounces judged_reverberation(const Emission& emission, int array) const;
  [[nodiscard]] double most_samples() const;
  [[nodiscard]] MemoryNeed synthesis_need(const Synthesizer& synthesizer) const;
  /// Adds what does not come of a ping: noise through the receivers, blanking, conversion.
  void complete(PingRecord& record) const;
  [[nodiscard]] std::vector<float> surroundings(const PingRecord& record, std::int64_t first,
                                                std::int64_t samples) const;
  void at_step(int ping, double done, std::string_view doing) const {
    if (tell_step_) tell_step_(ping, done, doing);
  }

  Scenario scenario_;
  MemoryBudget budget_;  // of each ping
  std::vector<Transmission> transmissions_;
  std::vector<Pulse> pulses_;  // [transmitters]
  bool known_ocean_ = false;   // written before paths_
  std::shared_ptr<const PropagationPaths> paths_;
  AmbientNoise noise_;
  Interference interference_;
  ReceiverElectronics receivers_;
  std::unique_ptr<ReverberationModel> reverberation_;
  double max_doppler_ = 0.0;
  double latest_ = 0.0;  // end of a ping's record [s]
  bool one_ping_ = false;
  TellStep tell_step_;
};

}  // namespace asdic::detail
