#pragma once
#include <cstddef>
#include <utility>
#include <vector>

#include "processing/listening_band.h"
#include "processing/replica.h"
#include "sonar/synthesis/synthesis.h"

namespace asdic::detail {

/// One way of a transmission straight to the array, without a target.
struct KnownPath {
  double delay = 0.0;     ///< of the leading edge at the reference place [s], on the record's clock
  double slowness = 0.0;  ///< horizontal: delay per range [s/m]
  double slowness_down = 0.0;  ///< delay per depth of the phone [s/m]
  double power = 0.0;          ///< |amplitude|²
};

/// A transmission that a record may hold, and how its ways change while it lasts: the delay at
/// phone n and time t is delay + slowness·range + slowness_down·depth, both of them of
/// `moments` and counted from the reference place.
struct KnownBlast {
  const Replica* pulse = nullptr;
  std::vector<KnownPath> paths;
  std::vector<double> moments;             ///< evenly spaced, rising [s]
  std::vector<std::vector<double>> range;  ///< [phones][moments] [m]
  std::vector<std::vector<double>> depth;  ///< [phones][moments] [m]
};

/// What became of the blasts in one record.
struct BlastCancellation {
  std::size_t known = 0;      ///< transmissions that lie in the record
  std::size_t cancelled = 0;  ///< of these, those of which something was found and taken out
  double before_db = 0.0, after_db = 0.0;  ///< level while they last, mean of the phones [dB re
                                           ///< 1 µPa]; what is left is mostly noise and echoes
  double blind = 0.0;   ///< delays of one transmission that were taken out with it, altogether [s]
  double beside = 0.0;  ///< how far on either side of its ways at the most [s]
  int parts = 1;        ///< of a pulse, that were fitted by themselves, at the most
  bool narrowed = false;  ///< its paths last longer than what is taken out
  double faded = 0.0;     ///< at either end of the record, and beside what is blanked [s]

  [[nodiscard]] double lowered_db() const noexcept { return before_db - after_db; }
  /// On either side of a way: what the fit takes, and what it resolves. [ms]
  [[nodiscard]] double blind_ms() const noexcept { return 1e3 * beside; }
};

/// Takes transmissions that are known out of a record, phone by phone, before anything else.
///
/// Ways whose delays are closer than their pulse resolves are a group. The record is warped in time
/// so that the group's loudest way stands still, and what a short filter of free coefficients makes
/// of the replica is fitted by least squares and subtracted; group by group, the strongest first,
/// three times over (SAGE). Where one filter for the whole pulse leaves more than noise it may
/// change with time, in half-overlapping parts. What lies in the fitted span goes with it, echoes
/// too: `blind`. Source: docs/theory/continuous.md
/// \param band     that the record was cut to   \param blanked  when it holds nothing [s]
void cancel_blasts(Baseband& record, const ListeningBand& band, std::span<const KnownBlast> blasts,
                   std::span<const std::pair<double, double>> blanked, BlastCancellation& result);

}  // namespace asdic::detail
