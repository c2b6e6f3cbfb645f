#pragma once
#include <complex>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/units.h"
#include "processing/coverage/turned_sum.h"
#include "reverb/power/pulse_coherence.h"

namespace asdic::detail {

/// A path of one leg of an echo, as a cell of the picture needs it.
struct EchoLeg {
  std::complex<double> amplitude = 0.0;  ///< without what is sent towards it
  std::complex<double> sent = 1.0;       ///< towards it, relative to the axis
  double delay = 0.0;                    ///< to the cell's middle [s]
  Vec2 slowness = Vec2::Zero();          ///< ∂delay over the map [s/m]
  double elevation = 0.0;                ///< at the sonar, positive up [rad]
};

/// A cell of the map.
struct EchoCell {
  Vec2 outward = Vec2(0.0, 1.0);     ///< unit vector along which it is `length` long
  double length = 0.0, width = 0.0;  ///< [m]
  double falls_db = 0.0;             ///< standard deviation of a path's level, as it spreads [dB]
};

/// The echo of a point of strength 0 dB that lies anywhere in a cell.
struct EchoMean {
  double power = 0.0;       ///< re the source at 1 m, with what is sent
  double open_power = 0.0;  ///< as if the same were sent in all directions
  double delay = 0.0;       ///< of the loudest answer [s]
  double elevation = 0.0;   ///< at which its sound comes to the array, positive from above [rad]
  double spread_db = 0.0;   ///< standard deviation over the cell, as its paths interfere
  double phases_db = 0.0;   ///< the same where the phases of its paths are not known
};

/// The mean over a cell of what the matched filter answers, max over t of |Σ_pairs
/// A_out·D·A_back·R(t − τ)|², R the pulse's autocorrelation.
///
/// Where phases turn little over the cell it is a sum over places in it. Elsewhere it is the
/// greatest mean: two pairs whose phases turn against one another by Δ, as standard deviation, keep
/// e^{−½Δ²} of what they are together. Few pairs are added up one by one; of many, as come over
/// rough ground, the sums are those of TurnedSum, and energies are told in sixteenths of what the
/// filter resolves.
class EchoMeans {
 public:
  /// \param pulse  must outlive this
  /// \param bandwidth  of the pulse: its filter resolves delays of a half of 1/bandwidth [Hz]
  EchoMeans(double frequency, const PulseCoherence& pulse, double bandwidth)
      : frequency_(frequency), pulse_(pulse), resolved_(0.5 / bandwidth) {}

  [[nodiscard]] EchoMean operator()(std::span<const EchoLeg> out, std::span<const EchoLeg> back,
                                    const EchoCell& cell);

 private:
  struct Pair {
    std::complex<double> pressure, open;
    double delay, along, across, power, elevation;
  };
  struct Time {
    double at, elevation, energy;
  };
  void pair_up(std::span<const EchoLeg> out, std::span<const EchoLeg> back, const EchoCell& cell);
  void sort_by_power();
  void choose_times(double apart, std::size_t most);
  void list_times(double apart);
  void list_times_of_many(double apart);
  [[nodiscard]] bool turns_slowly() const;
  [[nodiscard]] EchoMean over_places();
  [[nodiscard]] EchoMean over_phases();
  void add_louder_times(EchoMean& found);

  double frequency_;
  const PulseCoherence& pulse_;
  double resolved_;  // [s]
  // Used again from cell to cell.
  std::vector<Pair> pairs_;
  std::vector<Pair> heard_;
  TurnedSum turned_sum_;
  std::vector<TurnedSum::Sound> turning_;
  std::vector<double> energies_, coherence_;
  std::vector<std::uint32_t> taken_;
  std::vector<std::pair<double, std::uint32_t>> order_;
  std::vector<Time> times_;
  std::vector<std::complex<double>> answers_, places_;
};

}  // namespace asdic::detail
