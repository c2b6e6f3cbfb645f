#pragma once
#include <variant>

#include "sonar/scenario/shapes/positions.h"
#include "sonar/scenario/shapes/straight.h"
#include "sonar/scenario/shapes/towed.h"

namespace asdic::detail {

/// A way to say where the phones are: name, describe, and build(), which places them.
template <class S>
concept PhoneShape = Described<S> && requires(const S& shape, ReceiverArray& array) {
  { S::name } -> std::convertible_to<std::string_view>;
  shape.build(array);
};
template <PhoneShape... S>
using OneOfShapes = std::variant<S...>;
/// Every array shape. A new one is its file and one name here (docs/develop/recipes.md).
using AnyArrayShape =
    OneOfShapes<HorizontalShape, VerticalShape, LineShape, PositionsShape, TowedShape>;

}  // namespace asdic::detail
