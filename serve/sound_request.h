#pragma once
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/fields.h"
#include "io/text/toml_value.h"

namespace asdic::detail::serve {

/// Which legs of a sound's way are meant.
enum class AskedLegs { both, target, array };
inline constexpr std::string_view leg_words[] = {"both", "target", "array"};
constexpr std::span<const std::string_view> words(AskedLegs /*any*/) { return leg_words; }

/// The command `arrivals`. Angles are in degrees here and below, as `asdic arrivals` has them: so
/// that both tell the same bits.
struct ArrivalsRequest {
  std::optional<double> time;  ///< [s]
  AskedLegs leg = AskedLegs::both;
  std::string target;  ///< its name; empty: all
  std::optional<double> receiver_depth, range, source_depth, frequency, bearing_deg;

  void describe(Fields& field);
};

/// The command `rays`.
struct RaysRequest {
  std::optional<double> time;
  double from_deg = -20.0, to_deg = 20.0;
  int count = 41;
  std::vector<double> elevations_deg;
  double range = 50e3;
  std::optional<double> source_depth, bearing_deg;
  int bounces = 100;

  void describe(Fields& field);
  /// Launch elevations [rad].
  [[nodiscard]] std::vector<double> elevations() const;
};

/// The command `field`, but for its table `run`.
struct FieldRequest {
  std::optional<double> time;

  void describe(Fields& field);
};

/// What a command says. \param more  keys of its own that are read elsewhere
/// \throws Refusal ("value")
template <class Request>
[[nodiscard]] Request read_request(const TomlValue& fields,
                                   std::span<const std::string_view> more = {});

}  // namespace asdic::detail::serve
