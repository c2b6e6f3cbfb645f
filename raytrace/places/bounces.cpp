#include "raytrace/places/bounces.h"

#include <algorithm>
#include <cmath>

namespace asdic::detail {

void Bounces::include(const Bounces& other) noexcept {
  surface = std::max(surface, other.surface);
  bottom = std::max(bottom, other.bottom);
  left_out_db = std::fmax(left_out_db, other.left_out_db);
}

}  // namespace asdic::detail
