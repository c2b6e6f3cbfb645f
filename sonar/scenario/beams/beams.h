#pragma once
#include <utility>
#include <variant>

#include "sonar/scenario/beams/line_beam.h"
#include "sonar/scenario/beams/projector_beam.h"
#include "sonar/scenario/beams/table_beam.h"

namespace asdic::detail {

template <TransmitBeam... B>
using OneOfBeams = std::variant<B...>;
/// Every beam of a transmitter. A new one is its files and one name here
/// (docs/develop/recipes.md).
using AnyBeam = OneOfBeams<LineBeam, ProjectorBeam, TableBeam>;

/// Whether it can be steered in elevation.
template <TransmitBeam... B>
[[nodiscard]] bool steers(const std::variant<B...>& beam) noexcept {
  return std::visit([](const auto& one) { return one.steers; }, beam);
}

template <class>
struct PatternsOf;
template <class... B>
struct PatternsOf<std::variant<B...>> {
  using type = std::variant<decltype(std::declval<const B&>().pattern(BeamMount{}))...>;
};
/// Their patterns, in the same order.
using AnyBeamPattern = PatternsOf<AnyBeam>::type;

}  // namespace asdic::detail
