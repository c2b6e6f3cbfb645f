#include "sonar/paths/shared_propagation.h"

#include <algorithm>

#include "raytrace/volume/area_volume.h"
#include "raytrace/volume/transect_volume.h"

namespace asdic::detail {
namespace {

constexpr std::size_t most_oceans = 16;

}  // namespace

std::shared_ptr<const VolumeOcean> volume_of(const Environment& ocean, const Transect& transect,
                                             const std::shared_ptr<const Area>& area,
                                             int dimension) {
  if (dimension != 3) return nullptr;
  if (area) return std::make_shared<const AreaVolume>(area);
  if (is_layered(ocean)) return nullptr;
  return std::make_shared<const TransectVolume>(ocean, transect);
}

SharedPropagation::SharedPropagation(std::size_t most_bytes)
    : memory_(std::make_shared<PropagationMemory>(most_bytes)) {}

SharedPropagation::Paths SharedPropagation::find(const Environment& ocean, const Transect& transect,
                                                 const Area* area, int dimension) {
  const auto place = std::find_if(oceans_.begin(), oceans_.end(), [&](const Paths& paths) {
    return paths->transect() == transect && paths->area().get() == area &&
           paths->along_transect().environment() == ocean &&
           (paths->volume() != nullptr) == (dimension == 3 && !paths->layered());
  });
  if (place == oceans_.end()) return nullptr;
  oceans_.splice(oceans_.begin(), oceans_, place);
  return oceans_.front();
}

std::shared_ptr<const PropagationPaths> SharedPropagation::paths(
    const Environment& ocean, const Transect& transect, const std::shared_ptr<const Area>& area,
    bool* known, int dimension) {
  if (known != nullptr) *known = true;
  {
    const std::scoped_lock lock(lock_);
    if (auto kept = find(ocean, transect, area.get(), dimension)) return kept;
  }
  auto made = std::make_shared<const PropagationPaths>(ocean, transect, area, memory_,
                                                       volume_of(ocean, transect, area, dimension));
  const std::scoped_lock lock(lock_);
  if (auto kept = find(ocean, transect, area.get(), dimension))
    return kept;  // another thread was faster
  if (known != nullptr) *known = false;
  oceans_.push_front(std::move(made));
  if (oceans_.size() > most_oceans) oceans_.pop_back();
  return oceans_.front();
}

}  // namespace asdic::detail
