#pragma once
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "raytrace/places/bounces.h"
#include "raytrace/places/propagation_paths.h"
#include "sonar/scenario/scenario.h"

namespace asdic::detail {

/// Bounces off either boundary that "auto" follows at least.
inline constexpr int fewest_bounces = 3;

/// What a scenario searches for. \param enough  bounces where the settings leave that open: those
/// that hold all but a little of the sound are told by enough_bounces()
[[nodiscard]] PathLimits limits_of(const PropagationSettings& settings,
                                   int enough = fewest_bounces) noexcept;

/// What "auto" may leave out of a level: more is told as a warning once it is `tolerable_db`.
inline constexpr double negligible_db = 0.05, tolerable_db = 0.1;

/// Paths to one place over a map, above which no more bounces are tried.
inline constexpr std::size_t many_paths = 256;

/// Bounces off either boundary that "auto" follows at most over slopes and fronts, where every one
/// takes longer marches, and between two places in layered water, where all bounces of four times
/// as many paths are held.
inline constexpr int most_over_slopes = 96, most_between_places = 768;

/// What reaches a place or comes back from the ground, in segments of delay (or of whatever else
/// may miss it), by the bounces of the path that has more of them.
class EnergyByBounces {
 public:
  /// \param latest  end of the last segment [s]   \param most  bounces   \param floor  what may be
  /// missing of a segment whatever is received there
  EnergyByBounces(std::size_t segments, double latest, int most, double floor);

  void add(double delay, int bounces, double energy);
  /// What is missing of the segment that misses most, if no more bounces are followed [dB]: 0 where
  /// that is below the floor.
  [[nodiscard]] double left_out_db(int bounces) const;
  /// The fewest bounces, from fewest_bounces on, that leave out no more [dB].
  [[nodiscard]] int enough(double db) const;
  /// left_out_db(); of a search that was given up, no less than its last half added: what is beyond
  /// adds about as much again.
  [[nodiscard]] double estimate_db(int bounces, bool converged) const;
  /// Whether those of more than half of the bounces are so weak that still more will not count, or
  /// nothing was found that has as many as were allowed: there is no more.
  [[nodiscard]] bool converged(double db) const {
    return !any_has_most_ || left_out_db(most_ / 2) <= 0.5 * db;
  }

 private:
  double latest_;
  int most_;
  double floor_;
  bool any_has_most_ = false;
  std::vector<double> energy_;  // [segments × (most + 1)]
};

/// What a search for bounces has received: of all paths, and of those beyond the numbers asked for.
class ReceivedBounces {
 public:
  ReceivedBounces(std::size_t segments, double latest, int most, double floor, const Bounces& asked)
      : by_most_(segments, latest, most, floor),
        by_numbers_(segments, latest, 1, floor),
        asked_(asked) {}

  void add(double delay, int surface, int bottom, double energy);
  [[nodiscard]] std::size_t paths() const noexcept { return paths_; }
  [[nodiscard]] const EnergyByBounces& by_most() const noexcept { return by_most_; }
  [[nodiscard]] const EnergyByBounces& by_numbers() const noexcept { return by_numbers_; }

 private:
  EnergyByBounces by_most_, by_numbers_;  // by_numbers_: 0 within, 1 beyond
  Bounces asked_;
  std::size_t paths_ = 0;
};

/// How many bounces are looked for, and where.
struct BounceSearch {
  int first = 2 * fewest_bounces;  ///< tried first
  double growth = 2.0;             ///< then so many times as many
  int most = 768;                  ///< tried at most
  /// Of a try that is the last: over rough ground paths multiply with every bounce. Followed are
  /// then the bounces of the try before.
  std::size_t most_paths = std::numeric_limits<std::size_t>::max();
  double tolerance_db = negligible_db;
  std::size_t segments = 1;
  double latest = std::numeric_limits<double>::infinity();  ///< end of the segments
  double floor = 0.0;                                       ///< as of EnergyByBounces
};

/// Whether the settings say how many off either boundary.
[[nodiscard]] bool in_numbers(const PropagationSettings& settings) noexcept;
/// What is asked for; where that is in numbers, without them: what there is to be received.
[[nodiscard]] PropagationSettings unlimited(const PropagationSettings& settings) noexcept;
/// Bounces that the settings ask for, of which nothing is estimated.
[[nodiscard]] Bounces as_asked(const PropagationSettings& settings,
                               int enough = fewest_bounces) noexcept;
/// What a scenario searches for, once it is known how many are enough.
[[nodiscard]] PathLimits limits_of(const PropagationSettings& settings,
                                   const Bounces& enough) noexcept;

/// Doubles the bounces until twice as many add next to nothing. Numbers of the settings are kept,
/// and what they leave out is estimated. docs/theory/eigenrays.md, "Enough bounces"
/// \param look  adds what there is within limits
[[nodiscard]] Bounces search_bounces(
    const PropagationSettings& settings, const BounceSearch& search,
    const std::function<void(const PathLimits&, ReceivedBounces&)>& look);

/// What a user should know of a sound that lacks bounces, in one line; "" where next to nothing is
/// missing. \param sound  "an echo"
[[nodiscard]] std::string lacking(const PropagationSettings& settings, const Bounces& followed,
                                  const char* sound);
/// The same of searches in three dimensions that were ended for their cost; "" of none.
[[nodiscard]] std::string ended_early(std::size_t searches);

/// Of the paths between two places that arrive by a time after they left [s]. Numbers of the
/// settings are kept.
/// \param judged  what numbers leave out is estimated, too
[[nodiscard]] Bounces enough_bounces(const PropagationPaths& paths,
                                     const PropagationSettings& settings, const Vec3& from,
                                     const Vec3& to, double frequency, double latest,
                                     bool judged = false);

}  // namespace asdic::detail
