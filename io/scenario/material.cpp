// Part of ocean.h: what is behind a boundary.
#include "io/scenario/materials/materials.h"
#include "io/scenario/ocean.h"
#include "io/settings/reader.h"

namespace asdic::detail::scenario {
namespace {

constexpr std::string_view what_kind = "what is behind the boundary";

}  // namespace

BoundaryMaterial read_material(TomlTable& table, const OceanReading& reading,
                               const WaterAtBoundary& water, bool vacuum_unless_given) {
  KnownSettings known{.numbers = {{"frequency", reading.frequency},
                                  {"water.speed", water.speed},
                                  {"water.density", water.density}},
                      .folder = reading.folder};
  AnyMaterialForm form;
  TomlReader(table, known).one_of(vacuum_unless_given ? "kind" : required("kind"), form, what_kind);
  const MaterialPlace place{table, reading, water};
  return std::visit([&](const auto& one) { return BoundaryMaterial(one.build(place)); }, form);
}

void describe_material(Fields& field, const BoundaryMaterial& material, SettingKey kind) {
  AnyMaterialForm form;
  find_form(material, form);
  field.one_of(kind, form, what_kind);
}

}  // namespace asdic::detail::scenario
