#pragma once
#include <string_view>
#include <variant>

namespace asdic::detail {

struct NoAbsorption {
  static constexpr std::string_view name = "none";

  [[nodiscard]] bool operator==(const NoAbsorption&) const = default;
};

/// Thorp's formula as in Jensen et al. (2011), eq. (1.47): 3.3e-3 + 0.11F/(1+F) + 44F/(4100+F) +
/// 3e-4F dB/km, F = f²/kHz².
struct Thorp {
  static constexpr std::string_view name = "thorp";

  [[nodiscard]] bool operator==(const Thorp&) const = default;
};

/// Francois & Garrison, JASA 72, 896 and 1879 (1982): boric acid, magnesium sulphate and pure
/// water.
struct FrancoisGarrison {
  static constexpr std::string_view name = "francois-garrison";
  double temperature = 10.0;  ///< [°C]
  double salinity = 35.0;     ///< [psu]
  double ph = 8.0;
  double depth = 0.0;  ///< the one depth at which the law is evaluated [m]

  [[nodiscard]] bool operator==(const FrancoisGarrison&) const = default;
};

/// Ainslie & McColm, JASA 103, 1671 (1998): Francois & Garrison's three parts, simplified to within
/// 10 % of them.
struct AinslieMcColm {
  static constexpr std::string_view name = "ainslie-mccolm";
  double temperature = 10.0;  ///< [°C]
  double salinity = 35.0;     ///< [psu]
  double ph = 8.0;
  double depth = 0.0;  ///< the one depth at which the law is evaluated [m]

  [[nodiscard]] bool operator==(const AinslieMcColm&) const = default;
};

/// Fish with swim bladders: between two depths they take a₀ / ((1 − f₀²/f²)² + 1/Q²) dB/km out of
/// the wave. Weston, in Proc. Acoustic Interactions with the Underwater Environment (1967);
/// Diachok, JASA 105, 2107 (1999).
struct BiologicalLayer {
  double top = 0.0, bottom = 0.0;  ///< [m]
  double resonance = 1000.0;       ///< f₀ [Hz]
  double quality = 5.0;            ///< Q
  double strength = 0.0;           ///< a₀ [dB/km]

  [[nodiscard]] bool operator==(const BiologicalLayer&) const = default;
};

using Absorption = std::variant<NoAbsorption, Thorp, FrancoisGarrison, AinslieMcColm>;

/// Calls f(std::string_view name, double value) for what a law knows of the water: temperature
/// [°C], salinity [psu], pH, depth [m]; for none where it knows nothing.
template <class F>
void for_each_water_property(const Absorption& absorption, F&& f) {
  std::visit(
      [&](const auto& law) {
        if constexpr (requires { law.salinity; }) {
          f("temperature", law.temperature);
          f("salinity", law.salinity);
          f("pH", law.ph);
          f("depth", law.depth);
        }
      },
      absorption);
}

/// Absorption at one frequency [dB/km]. \param frequency [Hz]
[[nodiscard]] double absorption_db_per_km(const Absorption& absorption, double frequency) noexcept;

/// What a layer adds inside its depths [dB/km].
[[nodiscard]] double absorption_db_per_km(const BiologicalLayer& layer, double frequency) noexcept;

}  // namespace asdic::detail
