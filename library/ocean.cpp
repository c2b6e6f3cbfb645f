#include "asdic/ocean.h"

#include "io/climatology/climatology.h"
#include "io/hdf5/own_files.h"
#include "library/access.h"

namespace asdic {
namespace {

detail::OceanRequest request_of(const OceanPlace& place) {
  detail::OceanRequest request{.latitude = place.latitude_deg,
                               .longitude = place.longitude_deg,
                               .when = {.month = place.month},
                               .bearing_deg = place.bearing_deg.value_or(0.0),
                               .range = place.range.value_or(0.0),
                               .step = place.step};
  if (place.date.empty()) return request;
  request.when.date = detail::parse_moment(place.date);
  if (!request.when.date)
    throw InputError("date", '"' + place.date + '"', "a date by ISO 8601: \"2024-02-29\"");
  return request;
}

detail::OceanSources sources_of(const OceanPlace& place) {
  using detail::data_files;
  return detail::or_default({.temperature = data_files(place.temperature),
                             .salinity = data_files(place.salinity),
                             .sound_speed = data_files(place.sound_speed),
                             .bathymetry = data_files(place.bathymetry),
                             .wind = data_files(place.wind),
                             .sediment = data_files(place.sediment)},
                            place.data.empty() ? detail::default_ocean_sources()
                                               : detail::default_ocean_sources(place.data));
}

void check(const OceanPlace& place) {
  if (place.bearing_deg.has_value() != place.range.has_value())
    throw InputError(place.range ? "bearing_deg" : "range", "nothing",
                     "a value: bearing_deg and range go together");
  if (place.step && !place.range)
    throw InputError("step", "a place", "a track: bearing_deg and range");
  if (place.area && place.range)
    throw InputError("area", "a track", "an area, or bearing_deg and range");
  if (place.area.has_value() == place.output.empty())
    throw InputError("output", place.output.empty() ? "nothing" : place.output.string(),
                     "the name of a .toml for an area, and for nothing else");
}

}  // namespace

Ocean ocean(const OceanPlace& place) {
  check(place);
  const detail::OceanSources sources = translated([&] { return sources_of(place); });
  const std::vector<std::filesystem::path> files = sources.paths();
  const auto work = [&] {
    const detail::OceanRequest request = request_of(place);
    detail::OceanSample sample = detail::sample_ocean(sources, request);
    Ocean found{.water_depth = sample.water_depth,
                .wind_speed = sample.wind_speed,
                .origins = sample.origins,
                .notes = sample.notes};
    const auto add = [&](const std::vector<std::string>& notes) {
      found.notes.insert(found.notes.end(), notes.begin(), notes.end());
    };
    if (place.area) {
      std::filesystem::path maps = place.output;
      maps.replace_extension(".nc");
      detail::OutputFile fragment(
          place.output, {.own = detail::own::scenario, .inputs = files, .option = "output"});
      const detail::OceanArea area =
          detail::write_ocean_area(sources, request, sample, *place.area,
                                   detail::OutputFile(maps, {.own = detail::own::hdf5,
                                                             .worth = detail::own::pings,
                                                             .inputs = files,
                                                             .option = "output"}));
      fragment.write(detail::write_area_fragment(sample, area));
      add(area.notes);
      found.scenario = Scenario::read(place.output);
      return found;
    }
    std::optional<detail::OceanSection> section;
    if (place.range) section = detail::sample_section(sources, request);
    found.scenario = Scenario::parse(detail::write_scenario_fragment(sample, section));
    if (section) add(section->notes);
    return found;
  };
  return translated(work, files);
}

}  // namespace asdic
