#pragma once
#include <concepts>
#include <string>
#include <string_view>

#include "core/validity.h"

namespace asdic::detail {

class Fields;

/// A law of ambient noise: its level over frequency.
template <class T>
concept NoiseSpectrum = std::copyable<T> &&
    requires(T& law, const T& constant, Fields& field, double frequency) {
  { T::name } -> std::convertible_to<std::string_view>;  // in scenario files
  law.describe(field);
  /// Spectral level [dB re 1 µPa²/Hz]. \param frequency  ≥ 0 [Hz]
  { constant.level_at(frequency) }
  noexcept->std::same_as<double>;
  /// At which frequencies [Hz] its source vouches for it, in words of core/validity.h.
  { T::validity() }
  noexcept->std::same_as<const Validity&>;
  /// Its name and parameters, for people.
  { constant.text() } -> std::same_as<std::string>;
};

}  // namespace asdic::detail
