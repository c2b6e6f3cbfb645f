#include "sonar/scenario/noise_settings.h"

#include "core/fields.h"
#include "core/quantities.h"
#include "core/text.h"

namespace asdic::detail {
namespace {

/// A level over elevation, as a table of its own.
struct NoiseProfile {
  NoiseDirections& directions;

  void describe(Fields& field) {
    auto& [exponent, elevation, level_db] = directions;
    field(required("elevation"), elevation, quantity::elevation,
          "increasing, positive where noise comes from above");
    field(required("level_db"), level_db, quantity::level,
          "at each elevation, of power per solid angle, up to a constant");
    if (!field.checks()) return;
    if (elevation.size() < 2) field.fault("elevation", "at least two elevations", "one");
    if (level_db.size() != elevation.size())
      field.fault("level_db", "as many values as elevations, " + std::to_string(elevation.size()));
    for (std::size_t i = 1; i < elevation.size(); ++i)
      if (elevation[i] <= elevation[i - 1])
        field.fault("elevation[" + std::to_string(i) + "]", "an elevation above the one before it");
  }
};

}  // namespace

void NoiseField::describe(Fields& field) {
  field("coherence", coherence, "of the noise of one phone with another's");
  if (const auto only = field.only("coherence", coherence, NoiseCoherence::surface))
    field("dipole_exponent", directions.dipole_exponent,
          {.noun = "exponent", .low = 0.5, .high = 10.0},
          "of the cosine with which a source of the sheet radiates");
  if (const auto only = field.only("coherence", coherence, NoiseCoherence::profile)) {
    NoiseProfile profile{directions};
    field("profile", profile, "where the noise comes from");
  }
}

void NoiseSettings::describe(Fields& field) {
  if (field.reads()) {  // without one of these there is no noise
    bool any = false;
    for (const char* key : {"spectral_level_db", "kind", "coherence", "thermal"})
      any = field.finds(key) || any;
    if (!any) return law.reset();
  }
  if (!law && !field.reads() && !field.exhaustive()) return;
  AnyNoise spectrum = law.value_or(WhiteNoise{});
  field.one_of("kind", spectrum, "the law of its level over frequency");
  if (!std::holds_alternative<WhiteNoise>(spectrum))
    field.excludes("kind = " + in_quotes(name_of(spectrum)), {"spectral_level_db"});
  if (field.reads()) {
    law = spectrum;
    thermal = std::holds_alternative<WenzNoise>(spectrum);  // whose curves leave it out
  }
  field(by_default("thermal", "true of wenz, else false"), thermal,
        "whether the water's thermal noise is added");
  NoiseField between{coherence, directions};
  between.describe(field);
  if (field.reads()) coherence = between.coherence, directions = between.directions;
}

std::optional<double> NoiseSettings::flat_level_db() const noexcept {
  const WhiteNoise* const white = law ? std::get_if<WhiteNoise>(&*law) : nullptr;
  return white == nullptr || thermal ? std::nullopt : std::optional(white->spectral_level_db);
}

}  // namespace asdic::detail
