#pragma once
#include "io/scenario/materials/form.h"

namespace asdic::detail::scenario {

/// A material without settings.
template <class Material>
struct BareForm {
  static constexpr std::string_view name = Material::name;

  void describe(Fields&) {}
  [[nodiscard]] Material build(const MaterialPlace&) const { return {}; }
  [[nodiscard]] static BareForm of(const Material&) { return {}; }
};
static_assert(FormOf<BareForm<Vacuum>, Vacuum> && FormOf<BareForm<Rigid>, Rigid>);

}  // namespace asdic::detail::scenario
