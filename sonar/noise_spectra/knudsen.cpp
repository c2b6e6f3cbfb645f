#include "sonar/noise_spectra/knudsen.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <span>

#include "core/fields.h"
#include "core/quantities.h"

namespace asdic::detail {
namespace {

constexpr double knot = 1852.0 / 3600.0;  // [m/s]

/// Straight between (x, y), constant beyond.
double straight_between(std::span<const double> x, std::span<const double> y, double at) noexcept {
  if (!(at > x.front())) return y.front();
  if (at >= x.back()) return y.back();
  const auto i = static_cast<std::size_t>(std::upper_bound(x.begin(), x.end(), at) - x.begin()) - 1;
  return std::lerp(y[i], y[i + 1], (at - x[i]) / (x[i + 1] - x[i]));
}

/// What the user should know of a wind that has no sea state of its own.
std::string note_of_wind(double wind_speed) {
  const std::array<Asked, 1> asked{{{"wind speed", wind_speed, wind_speed}}};
  const std::string text = outside(KnudsenNoise::validity(), asked);
  return text.empty() ? "" : "noise.wind_speed: " + text;
}

}  // namespace

void KnudsenNoise::describe(Fields& field) {
  if (const Only with(field, field.finds("wind_speed") || field.exhaustive(),
                      {.key = "wind_speed"});
      with)
    field.excludes("wind_speed", {"sea_state"});
  if (field.reads() || field.exhaustive()) {  // files may give the wind in its place
    double wind_speed = 0.0;
    field(inherited("wind_speed", "environment.wind_speed"), wind_speed, quantity::wind_speed,
          "of which the sea state is taken");
    if (field.reads()) sea_state = sea_state_of_wind(wind_speed);
    if (field.reads() && !field.finds("sea_state"))
      if (const std::string note = note_of_wind(wind_speed); !note.empty()) field.note(note);
  }
  field(by_default("sea_state", "of the wind"), sea_state,
        {.noun = "sea state", .low = 0.0, .high = 6.0}, "in place of the wind's");
}

double KnudsenNoise::level_at(double frequency) const noexcept {
  constexpr std::array sea_states = {0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0};
  constexpr std::array at_1_khz = {44.0, 55.0, 61.5, 64.5, 66.5, 68.5, 70.0};  // [dB]
  return straight_between(sea_states, at_1_khz, sea_state) -
         17.0 * std::log10(std::max(frequency, 100.0) / 1000.0);
}

const Validity& KnudsenNoise::validity() noexcept {
  static constexpr ValidRange ranges[] = {{"frequency", "Hz", 100.0, 25000.0},
                                          {"wind speed", "m/s", 0.0, 30.5 * knot}};
  static constexpr Validity validity{"Knudsen's noise", "J. Mar. Res. 7, 410, 1948", ranges};
  return validity;
}

std::string KnudsenNoise::text() const {
  char text[64];
  std::snprintf(text, sizeof text, "Knudsen, sea state %.2g", sea_state);
  return text;
}

double KnudsenNoise::sea_state_of_wind(double wind_speed) noexcept {
  constexpr std::array knots = {0.5, 2.0, 5.0, 8.5, 13.5, 19.0, 24.5, 30.5};
  constexpr std::array sea_states = {0.0, 0.5, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0};
  return straight_between(knots, sea_states, wind_speed / knot);
}

}  // namespace asdic::detail
