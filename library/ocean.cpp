#include "asdic/ocean.h"

#include "io/climatology/climatology.h"
#include "library/access.h"

namespace asdic {

Ocean ocean(const OceanPlace& place) {
  if (place.bearing_deg.has_value() != place.range.has_value())
    throw InputError(place.range ? "bearing_deg" : "range", "nothing",
                     "a value: bearing_deg and range go together");
  const detail::OceanSources sources = place.data.empty()
                                           ? detail::default_ocean_sources()
                                           : detail::default_ocean_sources(place.data);
  return translated(
      [&] {
        const detail::OceanSample sample =
            detail::sample_ocean(sources, place.latitude_deg, place.longitude_deg, place.month);
        std::optional<detail::OceanSection> section;
        if (place.range)
          section = detail::sample_section(sources, place.latitude_deg, place.longitude_deg,
                                           *place.bearing_deg, *place.range, place.month);
        Ocean found{.scenario = Scenario::parse(detail::write_scenario_fragment(sample, section)),
                    .water_depth = sample.water_depth,
                    .wind_speed = sample.wind_speed,
                    .origins = sample.origins,
                    .notes = sample.notes};
        if (section)
          found.notes.insert(found.notes.end(), section->notes.begin(), section->notes.end());
        return found;
      },
      {sources.hydrography, sources.bathymetry, sources.wind});
}

}  // namespace asdic
