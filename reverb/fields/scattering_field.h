#pragma once
#include <cstdint>
#include <vector>

#include "raytrace/places/bounces.h"
#include "reverb/fields/reverberation_settings.h"
#include "reverb/fields/scatterer_field.h"
#include "reverb/pairs/scattering_sheet.h"

namespace asdic::detail {

/// No water carries sound so slowly [m/s].
inline constexpr double slowest_sea = 1400.0;

/// How the sound of a field's scatterers is made.
enum class ReceivedBy {
  scatterers,  ///< one after the other
  covariance,  ///< drawn from their covariance (sonar/reverberation/reverberation_covariance.h)
  streams      ///< as streams of noise (reverb/power/reverberation_streams.h)
};

/// The scatterers of one boundary or layer, as one ping meets them.
struct ScatteringField {
  ScatteringSheet sheet;
  ScattererGrid grid;
  ScattererField field;  ///< motion and statistics
  Draw weights;          ///< purpose of their draws
  std::uint64_t boundary = 0;
  double depth = 0.0;      ///< near the ends [m]
  double thickness = 0.0;  ///< of a sheet of the volume [m]
  ReceivedBy received_by = ReceivedBy::scatterers;
  int bearings = 36;                ///< that its covariance looks at, at least
  double divided_below = infinity;  ///< cells beyond this range from the anchor are whole [m]
  Bounces bounces = {};             ///< that were followed
  /// Every ping draws it anew although its weights last: they are too many to be received one by
  /// one, and the platform leaves their sums behind.
  bool drawn_anew = false;
  /// Its weights never change and nobody moves, so that every ping receives the same sums of them.
  bool stays = false;
  double share = 1.0;  ///< of its pressure that is received; the rest is of other anchors' fields

  [[nodiscard]] double ring_area(std::uint32_t ring) const noexcept;  ///< [m²]
  /// That area as it counts in what is received: times share² [m²].
  [[nodiscard]] double received_area(std::uint32_t ring) const noexcept {
    return share * share * ring_area(ring);
  }
  /// Of a sector's middle, clockwise from north [rad].
  [[nodiscard]] double bearing(int sector) const noexcept;
  /// The middle of a cell [m].
  [[nodiscard]] Vec2 centre(std::uint32_t ring, int sector) const noexcept;
  /// The same at every bearing: not where a platform has left the anchor behind, since rings around
  /// it are not hers then.
  [[nodiscard]] bool azimuthally_symmetric() const noexcept;
  /// Scatterers of a cell. It is seen from source and receiver under no more than twice the angle
  /// of a sector: near them, far from the anchor, it is divided.
  [[nodiscard]] std::uint32_t copies_of(std::uint32_t ring, int sector) const;
  /// The sectors in whose middle pairs are looked at where not every scatterer is.
  [[nodiscard]] std::vector<int> sample_sectors() const;
  /// The sector in place of one of those, at a ring: over an area all sectors have their turn.
  /// \param count  of sample_sectors()
  [[nodiscard]] int sector_of_ring(int sample, std::size_t count,
                                   std::uint32_t ring) const noexcept;
};

}  // namespace asdic::detail
