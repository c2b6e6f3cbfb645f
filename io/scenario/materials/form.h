#pragma once
#include <concepts>
#include <string_view>
#include <type_traits>
#include <variant>

#include "core/fields.h"
#include "io/scenario/ocean.h"
#include "io/text/toml_table.h"
#include "raytrace/ocean/boundary.h"

namespace asdic::detail::scenario {

/// Where a form was read, and what is around it.
struct MaterialPlace {
  const TomlTable& table;
  const OceanReading& reading;
  const WaterAtBoundary& water;
};

/// A way to say what is behind a boundary, a kind of [environment.bottom].
template <class F>
concept MaterialForm = Described<F> && std::copyable<F> &&
    requires(const F& form, const MaterialPlace& place) {
  { F::name } -> std::convertible_to<std::string_view>;  // in scenario files
  /// The material that it says. \throws InputError at a key of the table
  { form.build(place) } -> std::convertible_to<BoundaryMaterial>;
};
/// One that finds itself in a material, one of BoundaryMaterial: files are written so.
template <class F, class Material>
concept FormOf = MaterialForm<F> && requires(const Material& material) {
  /// What builds it again, bit for bit.
  { F::of(material) } -> std::same_as<F>;
};

template <MaterialForm... F>
using OneOfForms = std::variant<F...>;

/// The form of a list that has a material's bits.
template <MaterialForm... F>
void find_form(const BoundaryMaterial& material, std::variant<F...>& form) {
  const auto find = [&](const auto& one) {
    using Material = std::decay_t<decltype(one)>;
    static_assert((FormOf<F, Material> || ...), "files are written of it");
    const auto look_for = [&](auto type) {
      using Form = typename decltype(type)::type;
      if constexpr (FormOf<Form, Material>) form = Form::of(one);
    };
    (look_for(std::type_identity<F>{}), ...);
  };
  std::visit(find, material);
}

}  // namespace asdic::detail::scenario
