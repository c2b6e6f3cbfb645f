#pragma once
#include <vector>

#include "io/scenario/materials/form.h"

namespace asdic::detail::scenario {

/// A layer of [[…layer]].
struct LayerTable {
  FloorLayer layer = {};
  void describe(Fields& field);
};

/// [[…layer]] from the water down, over the half space of the table itself.
struct LayeredForm {
  static constexpr std::string_view name = LayeredFloor::name;
  FloorLayer below = {};
  std::vector<LayerTable> layers = {};

  void describe(Fields& field);
  [[nodiscard]] LayeredFloor build(const MaterialPlace&) const;
  [[nodiscard]] static LayeredForm of(const LayeredFloor& floor);
};
static_assert(FormOf<LayeredForm, LayeredFloor>);

}  // namespace asdic::detail::scenario
