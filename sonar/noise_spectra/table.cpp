#include "sonar/noise_spectra/table.h"

#include <algorithm>
#include <cmath>

#include "core/fields.h"
#include "core/quantities.h"

namespace asdic::detail {

void NoiseTable::describe(Fields& field) {
  field.columns({{"frequency", frequency, quantity::frequency, "rising"},
                 {"level_db", level_db, quantity::level_re("1 µPa²/Hz"), "at each frequency"}},
                {.increasing = true, .file = true});
}

double NoiseTable::level_at(double at) const noexcept {
  const auto& f = frequency;
  if (!(at > f.front())) return level_db.front();
  if (at >= f.back()) return level_db.back();
  const auto i = static_cast<std::size_t>(std::upper_bound(f.begin(), f.end(), at) - f.begin()) - 1;
  return std::lerp(level_db[i], level_db[i + 1], std::log(at / f[i]) / std::log(f[i + 1] / f[i]));
}

const Validity& NoiseTable::validity() noexcept {
  static constexpr Validity everywhere{};
  return everywhere;
}

}  // namespace asdic::detail
