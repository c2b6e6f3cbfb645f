#pragma once
#include <vector>

#include "io/bellhop/bellhop_files.h"
#include "io/compare/statistics.h"

namespace asdic::detail::compare {

struct ArrivalOptions {
  double max_delay_difference = 2e-3;  ///< of a pair [s]
  double below_strongest_db = 40.0;    ///< weaker arrivals at a receiver are left out
  double join_delay = 20e-6;    ///< neighbouring beams of one path are that close in delay [s];
  double join_angle_deg = 1.0;  ///< and in launch angle. A delay of 0 joins nothing
};

/// A path of B that A has not.
struct MissedPath {
  std::size_t source = 0, row = 0, range = 0;  ///< receiver, as indices into B's axes
  std::size_t plane = 0;                       ///< of the map (bellhop::MapPlaces)
  double level_db = 0.0;                       ///< re the strongest at that receiver
  bellhop::ArrivalRow path;
};

/// Two lists of arrivals at the same receivers; B is the reference, differences are A − B.
///
/// In each file the arrivals that are one path seen through neighbouring beams are joined first.
/// Then, at every receiver, paths with the same bounces are paired, the nearest in delay first. A
/// path counts when it is within `below_strongest_db` of the strongest of either file there.
struct ArrivalDifference {
  std::size_t receivers = 0;
  std::size_t rows_a = 0, rows_b = 0;  ///< arrivals as written, all of them
  std::size_t not_finite = 0;  ///< of these, those with a NaN or an infinity, which are left out
  std::size_t paths_a = 0, paths_b = 0;          ///< joined, and strong enough
  std::size_t matched = 0;                       ///< paths of B with a partner in A
  std::size_t strong_b = 0, strong_matched = 0;  ///< those within 20 dB of the strongest
  double energy_matched_pct = 100.0;             ///< of B's energy
  double energy_db = 0.0;                        ///< of A's paths over B's
  Spread amplitude_db, delay_us, phase_deg, launch_deg, arrival_deg;  ///< over the pairs
  Spread sum_db;                   ///< TL of all arrivals of a receiver added up at B's frequency
  std::vector<MissedPath> missed;  ///< of B, strongest first

  /// Of the rows of both files those that could be compared.
  [[nodiscard]] double compared_pct() const noexcept {
    return share_pct(rows_a + rows_b - not_finite, rows_a + rows_b);
  }
  [[nodiscard]] double matched_pct() const noexcept;
  [[nodiscard]] double strong_matched_pct() const noexcept;
};

/// Joins the beams of each path of one receiver: pressures are added at the frequency, delays and
/// angles averaged by amplitude. Rows with a number that is not finite are left out.
/// \return  sorted by surface bounces, bottom bounces, delay
[[nodiscard]] std::vector<bellhop::ArrivalRow> join_beams(
    const std::vector<bellhop::ArrivalRow>& arrivals, double frequency,
    const ArrivalOptions& options);

/// \throws InputError{where: "receivers"} if they are not the same
[[nodiscard]] ArrivalDifference compare_arrivals(const bellhop::ArrivalsFile& a,
                                                 const bellhop::ArrivalsFile& b,
                                                 const ArrivalOptions& options = {});

}  // namespace asdic::detail::compare
