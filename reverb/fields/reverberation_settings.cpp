#include "reverb/fields/reverberation_settings.h"

#include "core/fields.h"
#include "core/quantities.h"
#include "core/text.h"

namespace asdic::detail {
namespace {

/// The table of the surface: whether it scatters, its law and its scatterers.
struct SurfaceScatterers {
  ReverberationSettings& settings;

  void describe(Fields& field) {
    field("enabled", settings.surface_scatters, "whether the surface scatters");
    field.one_of("kind", settings.surface, "the law of scattering");
    settings.surface_field.describe(field);
  }
};

/// That of the bottom, whose scatterers do not move.
struct BottomScatterers {
  AnyBottomScattering law = {};
  ScattererStatistics statistics = ReverberationSettings{}.bottom_field.statistics;

  void describe(Fields& field) {
    field.one_of("kind", law, "the law of scattering");
    statistics.describe(field);
  }
};

/// Two depths, with the water around them where they are checked.
void describe_depths(Fields& field, double& top, double& bottom) {
  std::vector<double> depth = {top, bottom};
  field(required("depth"), depth, quantity::depth, "of its top and its bottom");
  if (field.checks()) {
    constexpr const char* two = "two depths, the deeper one last";
    if (depth.size() != 2) field.fault("depth", two);
    if (depth[1] <= depth[0])
      field.fault("depth", two, to_text(depth[0]) + " m and " + to_text(depth[1]) + " m");
    const double surface = field.known("environment.shallowest"),
                 ground = field.known("environment.deepest");
    if (depth[0] < surface || depth[1] > ground)
      field.fault("depth", "a layer between the surface (" + to_text(surface) +
                               " m) and the bottom (" + to_text(ground) + " m)");
  }
  if (field.reads()) top = depth[0], bottom = depth[1];
}

}  // namespace

void ScattererField::describe(Fields& field) {
  motion.describe(field);
  statistics.describe(field);
}

void VolumeLayer::describe(Fields& setting) {
  describe_depths(setting, top, bottom);
  Quantity strength = quantity::scattering_strength;
  strength.reference = "1/m";
  setting(required("strength_db"), strength_db, strength, "for backscattering of a unit volume");
  setting(by_default("sheets", "one for every 50 m, thinner near the platforms"), sheets, 1, 1000,
          "that stand for it");
  field.describe(setting);
}

void SeabedScattering::describe(Fields& field) {
  field(required("class"), number, -1'000'000, 1'000'000,
        "number of the kind in the map of environment.area.seabed");
  field.one_of(required("kind"), law, "the law of scattering");
}

void ReverberationSettings::describe(Fields& field) {
  field("enabled", enabled, "whether there is any");
  field("azimuths", azimuths, 1, 3600, "sectors of a ring, at least");
  field("resolve_azimuth", resolve_azimuth, "as many as array and Doppler resolve, if more");
  field("scatterers_per_cell", scatterers_per_cell, 1, 1000, "of ring and sector");
  field("synthesis", synthesis, "how the sound of scatterers is made");
  field("most_returns", most_returns, 1000, 1'000'000'000,
        "of a ping at one array; beyond, sectors are synthesised");
  field(by_default("ground_spacing", "by the bandwidth of the pulse"), ground_spacing,
        {.noun = "spacing", .unit = "m", .low = 0.01, .high = 1e5}, "of the rings");
  SurfaceScatterers sea{*this};
  field("surface", sea, "what the surface scatters");
  auto ground =
      bottom ? std::optional(BottomScatterers{*bottom, bottom_field.statistics}) : std::nullopt;
  field("bottom", ground, "what the bottom scatters; without it nothing");
  if (field.reads()) {
    bottom = ground ? std::optional(ground->law) : std::nullopt;
    bottom_field.statistics = ground.value_or(BottomScatterers{}).statistics;
  }
  field("seabed", seabed, "kinds of sea floor that scatter by laws of their own");
  if (field.checks() && !seabed.empty() && !bottom)
    field.fault("seabed", "[reverberation.bottom] beside it, for all other kinds");
  field("volume", volume, "layers of the water that scatter");
}

}  // namespace asdic::detail
