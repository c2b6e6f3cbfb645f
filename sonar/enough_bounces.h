#pragma once
#include <limits>
#include <vector>

#include "sonar/propagation_paths.h"

namespace asdic {

/// What "auto" may leave out of a level: more is told as a warning once it is `tolerable_db`.
inline constexpr double negligible_db = 0.05, tolerable_db = 0.1;

/// How many bounces are followed off either boundary, and an estimate of how much of the level is
/// missing for it [dB].
struct Bounces {
  int surface = 0, bottom = 0;
  double left_out_db = std::numeric_limits<double>::quiet_NaN();  ///< none: not a number

  /// The more of both.
  void include(const Bounces& other) noexcept;
};

/// What reaches a place or comes back from the ground, in stretches of delay, by the bounces of the
/// path that has more of them.
class EnergyByBounces {
 public:
  /// \param latest  end of the last stretch [s]   \param most  bounces   \param floor  what may be
  /// missing of a stretch whatever is heard there
  EnergyByBounces(std::size_t stretches, double latest, int most, double floor);

  void add(double delay, int bounces, double energy);
  /// What is missing of the stretch that misses most, if no more bounces are followed [dB]: 0 where
  /// that is below the floor.
  [[nodiscard]] double left_out_db(int bounces) const;
  /// The fewest bounces, from fewest_bounces on, that leave out no more [dB].
  [[nodiscard]] int enough(double db) const;
  /// left_out_db(); of a search that was given up, no less than its last half added: what is beyond
  /// adds about as much again.
  [[nodiscard]] double estimate_db(int bounces, bool converged) const;
  /// Whether those of more than half of the bounces are so weak that still more will not count.
  [[nodiscard]] bool converged(double db) const { return left_out_db(most_ / 2) <= 0.5 * db; }

 private:
  double latest_;
  int most_;
  double floor_;
  std::vector<double> energy_;  // [stretches × (most + 1)]
};

/// Whether the settings say how many off either boundary.
[[nodiscard]] bool in_numbers(const PropagationSettings& settings) noexcept;
/// What is asked for; where that is in numbers, without them: what there is to be heard.
[[nodiscard]] PropagationSettings unlimited(const PropagationSettings& settings) noexcept;
/// Bounces that the settings ask for, of which nothing is estimated.
[[nodiscard]] Bounces as_asked(const PropagationSettings& settings,
                               int enough = fewest_bounces) noexcept;
/// What a scenario searches for, once it is known how many are enough.
[[nodiscard]] PathLimits limits_of(const PropagationSettings& settings,
                                   const Bounces& enough) noexcept;

/// Of the paths between two places that arrive by a time after they left [s]: doubled until twice
/// as many bounces add next to nothing. Numbers of the settings are kept.
/// docs/theory/eigenrays.md, "Enough bounces"
/// \param judged  what numbers leave out is estimated, too; not over slopes
[[nodiscard]] Bounces enough_bounces(const PropagationPaths& paths,
                                     const PropagationSettings& settings, const Vec3& from,
                                     const Vec3& to, double frequency, double latest,
                                     bool judged = false);

}  // namespace asdic
