#include "sonar/paths/shared_propagation.h"

#include <algorithm>

namespace asdic::detail {
namespace {

constexpr std::size_t most_oceans = 16;

}  // namespace

SharedPropagation::SharedPropagation(std::size_t most_bytes)
    : memory_(std::make_shared<PropagationMemory>(most_bytes)) {}

SharedPropagation::Paths SharedPropagation::find(const Environment& ocean, const Transect& transect,
                                                 const Area* area) {
  const auto place = std::find_if(oceans_.begin(), oceans_.end(), [&](const Paths& paths) {
    return paths->transect() == transect && paths->area().get() == area &&
           paths->along_transect().environment() == ocean;
  });
  if (place == oceans_.end()) return nullptr;
  oceans_.splice(oceans_.begin(), oceans_, place);
  return oceans_.front();
}

std::shared_ptr<const PropagationPaths> SharedPropagation::paths(
    const Environment& ocean, const Transect& transect, const std::shared_ptr<const Area>& area,
    bool* known) {
  if (known != nullptr) *known = true;
  {
    const std::scoped_lock lock(lock_);
    if (auto kept = find(ocean, transect, area.get())) return kept;
  }
  auto made = std::make_shared<const PropagationPaths>(ocean, transect, area, memory_);
  const std::scoped_lock lock(lock_);
  if (auto kept = find(ocean, transect, area.get())) return kept;  // another thread was faster
  if (known != nullptr) *known = false;
  oceans_.push_front(std::move(made));
  if (oceans_.size() > most_oceans) oceans_.pop_back();
  return oceans_.front();
}

}  // namespace asdic::detail
