#pragma once
#include <cstddef>
#include <list>
#include <memory>
#include <mutex>

#include "raytrace/places/propagation_paths.h"

namespace asdic::detail {

/// The ocean that a scenario's rays go through in three dimensions; null in two, or where the ocean
/// is layered. \throws InputError ("environment.surface.shape") if its surface is not flat
[[nodiscard]] std::shared_ptr<const VolumeOcean> volume_of(const Environment& ocean,
                                                           const Transect& transect,
                                                           const std::shared_ptr<const Area>& area,
                                                           int dimension);

/// Propagation that simulators of one ocean share, so that a study or a served session traces
/// nothing twice: the ocean's solver, eigenrays between places, the paths from places to scattering
/// boundaries, what is expected of reverberation, plans of the synthesis and the shapes of echoes
/// whose delays are curves. All of it is found again by the very numbers it depends on
/// (core/propagation_memory.h), so nothing that is kept or forgotten changes a bit of what comes
/// out. Shared by threads; memory is bounded.
///
/// What varies decides what is traced again. Noise, seeds, phases, strengths, headings, wind,
/// waveforms of the same centre frequency: nothing (but what is expected of reverberation is worked
/// out anew for another wind, law, beam or pulse). A target that moves: its own eigenrays.
/// A transmitter or an array whose depth changes: its paths to the boundaries as well. A profile, a
/// boundary: everything.
class SharedPropagation {
 public:
  /// \param most_bytes  of what is kept apart from the oceans, of which the latest 16 are kept
  explicit SharedPropagation(std::size_t most_bytes = std::size_t{512} << 20);

  /// The paths of an ocean: those that are there if one is equal, number by number; else new ones.
  /// \param known  is told which   \param dimension  2 or 3, of rays
  [[nodiscard]] std::shared_ptr<const PropagationPaths> paths(
      const Environment& ocean, const Transect& transect,
      const std::shared_ptr<const Area>& area = nullptr, bool* known = nullptr, int dimension = 2);

  [[nodiscard]] std::size_t bytes() const { return memory_->bytes(); }  ///< kept at present

 private:
  using Paths = std::shared_ptr<const PropagationPaths>;
  /// Null if there is none that is equal.
  [[nodiscard]] Paths find(const Environment& ocean, const Transect& transect, const Area* area,
                           int dimension);

  std::shared_ptr<PropagationMemory> memory_;
  std::mutex lock_;
  std::list<Paths> oceans_;  // the latest used first
};

}  // namespace asdic::detail
