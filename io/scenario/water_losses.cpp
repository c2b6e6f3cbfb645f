// Part of ocean.h: density, absorption, biology and attenuation of the water.
#include "core/quantities.h"
#include "core/text.h"
#include "io/scenario/ocean.h"
#include "io/settings/reader.h"

namespace asdic::detail::scenario {
namespace {

/// A law that knows nothing of the water.
template <class Law>
struct PlainLaw {
  static constexpr std::string_view name = Law::name;
  Law law = {};
  void describe(Fields&) {}
};

/// A law that knows the water.
template <class Law>
struct LawOfWater {
  static constexpr std::string_view name = Law::name;
  Law law = {};

  void describe(Fields& field) {
    field("temperature", law.temperature, quantity::temperature, "of the water");
    field("salinity", law.salinity, quantity::salinity, "of the water");
    field("ph", law.ph, {.noun = "pH", .low = 6.0, .high = 9.0}, "of the water");
    field("depth", law.depth, quantity::depth, "at which the law is evaluated");
  }
};

/// [environment.absorption], as it is where nothing is said.
struct AbsorptionTable {
  std::variant<PlainLaw<NoAbsorption>, PlainLaw<Thorp>, LawOfWater<FrancoisGarrison>,
               LawOfWater<AinslieMcColm>>
      law = PlainLaw<Thorp>{};

  void describe(Fields& field) { field.one_of("kind", law, "the law of what sea water absorbs"); }

  [[nodiscard]] Absorption build() const {
    return std::visit([](const auto& one) -> Absorption { return one.law; }, law);
  }
};

AbsorptionTable form_of_law(const NoAbsorption& law) { return {PlainLaw<NoAbsorption>{law}}; }
AbsorptionTable form_of_law(const Thorp& law) { return {PlainLaw<Thorp>{law}}; }
AbsorptionTable form_of_law(const FrancoisGarrison& law) {
  return {LawOfWater<FrancoisGarrison>{law}};
}
AbsorptionTable form_of_law(const AinslieMcColm& law) { return {LawOfWater<AinslieMcColm>{law}}; }

/// [[environment.biology]]
struct BiologyTable {
  BiologicalLayer layer = {};

  void describe(Fields& field) {
    field(required("top"), layer.top, quantity::water_depth, "of the layer");
    field(required("bottom"), layer.bottom, quantity::water_depth, "of the layer");
    if (field.checks() && !(layer.bottom > layer.top))
      field.fault("bottom", "a depth below the layer's top, " + to_text(layer.top) + " m");
    field(required("resonance"), layer.resonance, quantity::frequency, "of the swim bladders");
    field(required("quality_factor"), layer.quality,
          {.noun = "quality factor", .low = 0.1, .high = 1e4}, "of the resonance");
    field(required("strength_db_per_km"), layer.strength,
          {.noun = "strength", .unit = "dB/km", .low = 0.0, .high = 1e6}, "that is absorbed");
  }
};

using Samples = std::vector<double>;

std::optional<DepthFunction> depth_function(const Samples& depth, const Samples& value) {
  if (depth.empty()) return std::nullopt;
  return DepthFunction::table(depth, value);
}

Samples samples_of(std::span<const double> values) { return {values.begin(), values.end()}; }

/// water_density where it is a table: straight lines, two equal depths are a step.
struct DensityTable {
  Samples depth = {}, density = {};
  void describe(Fields& field) {
    field.columns({{"depth", depth, quantity::water_depth, "not falling; two alike are a step"},
                   {"density", density, quantity::density, "of the water at each depth"}},
                  {.file = true, .steps = true});
  }
};

/// [environment.attenuation]: a number, or a table of `depth` and numbers.
struct AttenuationTable {
  double constant = 0.0;
  Samples depth = {}, value = {};

  void describe(Fields& field) {
    constexpr Quantity loss{.noun = "attenuation", .unit = "dB/km", .low = 0.0, .high = 1e6};
    const auto table = [&](bool file) {
      field.columns({{"depth", depth, quantity::water_depth, "not falling; two alike are a step"},
                     {"db_per_km", value, loss, "at each depth, beside the absorption"}},
                    {.file = file, .steps = true});
    };
    Fields::Ways ways;
    if (const auto way = field.way(ways, {"file", "depth", "db_per_km"}, false)) table(true);
    if (const auto way = field.way(ways, {"depth", "db_per_km"}, !depth.empty())) table(false);
    if (const auto way = field.otherwise(ways, {"db_per_km"}))
      field(seldom("db_per_km"), constant, loss, "everywhere, beside the absorption");
  }
};

}  // namespace

void describe_density(Fields& field, Environment& ocean) {
  const DepthFunction& before = ocean.water_density;
  double constant = before.at(0.0);
  std::optional<DensityTable> table;
  if (!before.is_constant())
    table = DensityTable{samples_of(before.depths()), samples_of(before.values())};
  field("water_density", constant, quantity::density, table, "a number, or a table over depth");
  if (!field.reads()) return;
  ocean.water_density = constant;
  if (table) ocean.water_density = DepthFunction::table(table->depth, table->density);
}

namespace {

void describe_law(Fields& field, AbsorptionTable& absorption) {
  field("absorption", absorption, "what sea water takes out of sound");
}

AbsorptionTable table_of(const Absorption& absorption) {
  return std::visit([](const auto& law) { return form_of_law(law); }, absorption);
}

}  // namespace

void describe_absorption(Fields& field, const Environment& ocean) {
  AbsorptionTable absorption = table_of(ocean.absorption);
  describe_law(field, absorption);
}

void describe_losses(Fields& field, Environment& ocean) {
  AbsorptionTable absorption;
  if (!field.reads() && !field.exhaustive()) absorption = table_of(ocean.absorption);
  describe_law(field, absorption);

  std::vector<BiologyTable> biology;
  for (const BiologicalLayer& layer : ocean.biology) biology.push_back({layer});
  field("biology", biology, "layers of fish with swim bladders");

  const DepthFunction& before = ocean.attenuation_db_per_km;
  AttenuationTable attenuation{.constant = before.is_constant() ? before.at(0.0) : 0.0,
                               .depth = samples_of(before.depths()),
                               .value = samples_of(before.values())};
  field("attenuation", attenuation, "what else the water takes out of sound");
  if (!field.reads()) return;
  ocean.absorption = absorption.build();
  ocean.biology.clear();
  for (const BiologyTable& one : biology) ocean.biology.push_back(one.layer);
  ocean.attenuation_db_per_km = depth_function(attenuation.depth, attenuation.value)
                                    .value_or(DepthFunction(attenuation.constant));
}

}  // namespace asdic::detail::scenario
