#pragma once
#include <string_view>
#include <variant>

#include "sonar/noise_spectra/knudsen.h"
#include "sonar/noise_spectra/table.h"
#include "sonar/noise_spectra/wenz.h"
#include "sonar/noise_spectra/white.h"

namespace asdic::detail {

/// Every law of ambient noise. A new one is its file and one name here.
using AnyNoise = std::variant<WhiteNoise, WenzNoise, KnudsenNoise, NoiseTable>;

/// Its name in scenario files.
[[nodiscard]] inline std::string_view name_of(const AnyNoise& noise) noexcept {
  return std::visit([](const auto& law) { return law.name; }, noise);
}

}  // namespace asdic::detail
