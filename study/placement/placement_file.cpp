#include "study/placement/placement_file.h"

#include <cmath>

#include "core/error.h"
#include "io/hdf5/earth.h"
#include "io/hdf5/hdf5_output.h"
#include "io/hdf5/scale.h"
#include "io/ping/provenance.h"

namespace asdic::detail::study {
namespace {

constexpr const char* filetype = "asdic placement";

std::int64_t whole(std::size_t n) { return static_cast<std::int64_t>(n); }

/// Indices along a dimension, as its scale.
void write_numbers(Hdf5File& file, const std::string& name, std::size_t count,
                   const std::string& meaning) {
  std::vector<std::int32_t> numbers(count);
  for (std::size_t i = 0; i < count; ++i) numbers[i] = static_cast<std::int32_t>(i);
  write_scale(file, name, name, numbers, meaning);
}

template <class T>
void write_along(Hdf5File& file, const std::string& name, const std::vector<T>& values,
                 const std::vector<std::string>& scales, const Shape& shape,
                 const std::string& meaning, const std::string& unit = "", const Meaning& cf = {}) {
  file.write<T>(name, values, shape);
  describe(file, name, meaning, unit, cf);
  file.attach_scales(name, scales);
}

/// place_east, place_north, place_latitude, place_longitude; cell_east, cell_north, cell_latitude,
/// cell_longitude.
void write_places(Hdf5File& file, const std::string& thing, const std::vector<Vec2>& places,
                  const std::string& whose, const EarthPlaces& earth) {
  std::vector<double> east, north;
  for (const Vec2& at : places) {
    east.push_back(at.x());
    north.push_back(at.y());
  }
  const Shape shape = {places.size()};
  write_along(file, thing + "_east", east, {thing}, shape, "east " + whose, "m");
  write_along(file, thing + "_north", north, {thing}, shape, "north " + whose, "m");
  write_on_earth(file, earth, thing + "_", whose, places, shape, {thing});
}

/// Places and options of a set: sensor_place, sensor_option; other_place, other_option.
void write_set(Hdf5File& file, const std::string& thing, const Placement& found,
               const SensorSet& set, const std::string& whose) {
  std::vector<std::int32_t> places, options;
  for (const std::size_t one : set) {
    places.push_back(static_cast<std::int32_t>(found.problem.candidates[one].place));
    options.push_back(static_cast<std::int32_t>(found.problem.candidates[one].option));
  }
  write_numbers(file, thing, set.size(), "number of a sensor " + whose);
  write_along(file, thing + "_place", places, {thing}, {set.size()}, "place of a sensor " + whose);
  write_along(file, thing + "_option", options, {thing}, {set.size()},
              "option of a sensor " + whose);
}

void write_answer(Hdf5File& file, const PlacementPlan& plan, const Placement& found) {
  const PlacementChoice& choice = found.choice;
  const auto number = [&](const char* key, double value) { file.set_attribute("", key, value); };
  const auto count = [&](const char* key, std::size_t n) { file.set_attribute("", key, whole(n)); };
  count("sensors", plan.sensors);
  count("at_least", plan.at_least);
  count("multistatic", plan.multistatic ? 1 : 0);
  number("false_alarm_probability", plan.wishes.false_alarm_probability);
  file.set_attribute("", "map_error", map_error_words[static_cast<std::size_t>(plan.map_error)]);
  count("draws", plan.draws);
  count("judging_draws", plan.judging);
  file.set_attribute("", "seed", std::to_string(plan.inputs.seed));
  number("sets", found.sets);
  count("proved", choice.proved ? 1 : 0);
  number("share_of_choosing_draws", choice.value);
  number("upper_bound", choice.upper_bound);
  number("swapped_share", choice.swapped_value);
  count("swaps", static_cast<std::size_t>(choice.swaps));
  number("confidence", plan.confidence);
  number("difference", found.difference.value);
  number("difference_low", found.difference.interval.low);
  number("difference_high", found.difference.interval.high);
  number("difference_p", found.difference.p_value);
  count("better_draws", found.better);
  count("worse_draws", found.worse);
  count("told_apart", found.told_apart() ? 1 : 0);
  number("least_probability", found.least);
  number("below_half_share", found.below_half);
  number("silent_share", found.silent);
}

}  // namespace

void write_placement(OutputFile&& to, const PlacementPlan& plan, const Placement& found) {
  Hdf5Output output(std::move(to));
  Hdf5File& file = output.file();
  const Provenance made = provenance(1);
  write_filetype(file, filetype, "1.0");
  file.set_attribute("", "title", plan.title);
  file.set_attribute("", "program_version", made.program_version);
  file.set_attribute("", "build", made.build);
  if (!plan.overrides.empty()) file.set_attribute("", "overrides", plan.overrides);
  if (!found.warnings.empty()) file.set_attribute("", "warnings", found.warnings);
  std::vector<std::string> names;
  for (const PlacementOption& option : plan.options) names.push_back(option.name);
  file.set_attribute("", "options", names);
  write_answer(file, plan, found);
  file.write_text("plan", plan.text);
  describe(file, "plan", "the plan, verbatim");
  for (std::size_t o = 0; o < plan.options.size(); ++o) {
    const std::string group = "options/" + std::to_string(o);
    file.write_text(group + "/scenario", plan.options[o].text);
    describe(file, group + "/scenario", "the option's scenario file, verbatim");
    file.set_attribute(group, "name", plan.options[o].name);
  }

  const EarthPlaces earth(found.origin, found.area.get());
  const PlacementProblem& problem = found.problem;
  write_numbers(file, "place", plan.places.size(), "number of a place where a sensor may be");
  write_places(file, "place", plan.places, "of a place where a sensor may be", earth);
  std::vector<std::int8_t> refused;
  for (const PlaceRefused why : found.refused) refused.push_back(static_cast<std::int8_t>(why));
  write_along(file, "place_refused", refused, {"place"}, {refused.size()},
              "why no sensor may be there: 0 one may; 1 too shallow; 2 beyond the map");
  file.set_flags("place_refused", {0, 1, 2}, "no too_shallow beyond_map");
  std::vector<std::int32_t> places, options;
  for (const PlacementCandidate& one : problem.candidates) {
    places.push_back(static_cast<std::int32_t>(one.place));
    options.push_back(static_cast<std::int32_t>(one.option));
  }
  write_numbers(file, "candidate", places.size(), "number of a sensor that may be chosen");
  write_along(file, "candidate_place", places, {"candidate"}, {places.size()}, "its place");
  write_along(file, "candidate_option", options, {"candidate"}, {places.size()}, "its option");
  write_along(file, "candidate_share", found.alone, {"candidate"}, {places.size()},
              "share of the weight that it detects by itself", "1");
  write_set(file, "sensor", found, found.choice.best, "of the best set");
  write_along(file, "share_without", found.without, {"sensor"}, {found.without.size()},
              "share of the weight that is detected without it", "1");
  write_set(file, "other", found, found.choice.runner_up, "of the runner-up");
  write_numbers(file, "step", found.choice.greedy_value.size(),
                "sensors of the greedy choice, less one");
  write_along(file, "greedy_share", found.choice.greedy_value, {"step"},
              {found.choice.greedy_value.size()},
              "share of the weight that so many greedily chosen sensors detect", "1");
  write_numbers(file, "draw", found.best.size(), "number of a draw that judges");
  write_along(file, "share", found.best, {"draw"}, {found.best.size()},
              "share of the weight that the best set detects", "1");
  if (!found.runner_up.empty())
    write_along(file, "other_share", found.runner_up, {"draw"}, {found.runner_up.size()},
                "share of the weight that the runner-up detects", "1");

  write_scale(file, "depth", "depth", found.depths, "depth of the target, positive down", "m",
              cf::depth_axis);
  write_numbers(file, "cell", plan.cells.size(), "number of a cell to be protected");
  if (plan.cell_size > 0.0) file.set_attribute("cell", "size_m", plan.cell_size);
  write_places(file, "cell", plan.cells, "of a cell's middle", earth);
  const Shape shape = {found.depths.size(), plan.cells.size()};
  const std::vector<std::string> scales = {"depth", "cell"};
  write_along(file, "weight", problem.weight, scales, shape, "weight of a cell; their sum is 1",
              "1");
  write_along(file, "detection_probability", found.detection, scales, shape,
              "probability that the best set detects, mean over the draws that judge", "1");
  write_along(file, "detection_deviation", found.deviation, scales, shape,
              "standard deviation of that probability from draw to draw", "1");
  write_along(file, "bottom_depth", found.floor, {"cell"}, {plan.cells.size()},
              "depth of the sea floor", "m", cf::sea_floor);
  for (const char* name : {"detection_probability", "detection_deviation", "weight"})
    if (earth.known()) file.set_attribute(name, "coordinates", "cell_latitude cell_longitude");
  output.finish();
}

PlacementAnswer answer_of(const PlacementPlan& plan, const Placement& found) {
  Moments shares;
  for (const double share : found.best) shares.add(share);
  const auto sensors = [&](const SensorSet& set) {
    std::vector<PlacementAnswer::Sensor> list;
    for (const std::size_t one : set) {
      const PlacementCandidate& candidate = found.problem.candidates[one];
      list.push_back({.east = plan.places[candidate.place].x(),
                      .north = plan.places[candidate.place].y(),
                      .option = plan.options[candidate.option].name});
    }
    return list;
  };
  std::size_t places = 0;
  for (const PlaceRefused why : found.refused) places += why == PlaceRefused::no ? 1 : 0;
  PlacementAnswer answer{.title = plan.title,
                         .sensors = plan.sensors,
                         .at_least = plan.at_least,
                         .places = places,
                         .candidates = found.problem.candidates.size(),
                         .draws = plan.draws,
                         .judging = plan.judging,
                         .multistatic = plan.multistatic,
                         .proved = found.choice.proved,
                         .told_apart = found.told_apart(),
                         .sets = found.sets,
                         .value = found.choice.value,
                         .upper_bound = found.choice.upper_bound,
                         .greedy = found.choice.greedy_value.back(),
                         .swapped = found.choice.swapped_value,
                         .swaps = found.choice.swaps,
                         .share = shares.mean(),
                         .deviation = shares.deviation(),
                         .confidence = plan.confidence,
                         .difference = found.difference.value,
                         .low = found.difference.interval.low,
                         .high = found.difference.interval.high,
                         .better = found.better,
                         .worse = found.worse,
                         .least = found.least,
                         .below_half = found.below_half,
                         .silent = found.silent,
                         .best = sensors(found.choice.best),
                         .runner_up = sensors(found.choice.runner_up),
                         .warnings = found.warnings};
  for (std::size_t m = 0; m < answer.best.size(); ++m) answer.best[m].without = found.without[m];
  return answer;
}

PlacementAnswer read_placement_answer(const std::filesystem::path& path) {
  const Hdf5File file = Hdf5File::open(path);
  if (const std::string type = file.attribute_or("", "filetype", ""); type != filetype)
    throw InputError({.where = path.string() + ": filetype",
                      .got = type.empty() ? "none" : '"' + type + '"',
                      .expected = std::string("\"") + filetype + '"'});
  const auto number = [&](const char* key) {
    if (!file.has_attribute("", key))
      throw InputError({.where = path.string() + ": " + key,
                        .got = "nothing",
                        .expected = "an attribute (docs/formats/placement.md)"});
    return file.attribute_number("", key);
  };
  const auto values = [&]<class T>(const std::string& name, T /*like*/) {
    if (!file.has(name))
      throw InputError({.where = path.string() + ": " + name,
                        .got = "nothing",
                        .expected = "a dataset (docs/formats/placement.md)"});
    return file.read<T>(name);
  };
  const auto count = [&](const char* key) { return static_cast<std::size_t>(number(key)); };
  PlacementAnswer answer{.title = file.attribute_or("", "title", ""),
                         .sensors = count("sensors"),
                         .at_least = count("at_least"),
                         .draws = count("draws"),
                         .judging = count("judging_draws"),
                         .multistatic = number("multistatic") != 0.0,
                         .proved = number("proved") != 0.0,
                         .told_apart = number("told_apart") != 0.0,
                         .sets = number("sets"),
                         .value = number("share_of_choosing_draws"),
                         .upper_bound = number("upper_bound"),
                         .swapped = number("swapped_share"),
                         .swaps = static_cast<int>(number("swaps")),
                         .confidence = number("confidence"),
                         .difference = number("difference"),
                         .low = number("difference_low"),
                         .high = number("difference_high"),
                         .better = count("better_draws"),
                         .worse = count("worse_draws"),
                         .least = number("least_probability"),
                         .below_half = number("below_half_share"),
                         .silent = number("silent_share"),
                         .best = {},
                         .runner_up = {},
                         .warnings = {}};
  Moments shares;
  for (const double share : values("share", 0.0)) shares.add(share);
  answer.share = shares.mean();
  answer.deviation = shares.deviation();
  const auto greedy = values("greedy_share", 0.0);
  answer.greedy = greedy.empty() ? 0.0 : greedy.back();
  const auto east = values("place_east", 0.0), north = values("place_north", 0.0);
  for (const std::int8_t why : values("place_refused", std::int8_t{0}))
    answer.places += why == 0 ? 1 : 0;
  answer.candidates = values("candidate_place", std::int32_t{0}).size();
  const std::vector<std::string> names = file.attribute_texts("", "options");
  const auto sensors = [&](const std::string& thing) {
    std::vector<PlacementAnswer::Sensor> list;
    const auto places = values(thing + "_place", std::int32_t{0});
    const auto options = values(thing + "_option", std::int32_t{0});
    for (std::size_t m = 0; m < places.size() && m < options.size(); ++m) {
      const auto p = static_cast<std::size_t>(places[m]);
      const auto o = static_cast<std::size_t>(options[m]);
      if (p >= east.size() || p >= north.size() || o >= names.size())
        throw InputError({.where = path.string() + ": " + thing + "_place",
                          .got = "a place or an option that is not in the file",
                          .expected = "one of its own"});
      list.push_back({.east = east[p], .north = north[p], .option = names[o]});
    }
    return list;
  };
  answer.best = sensors("sensor");
  answer.runner_up = sensors("other");
  const auto without = values("share_without", 0.0);
  for (std::size_t m = 0; m < answer.best.size() && m < without.size(); ++m)
    answer.best[m].without = without[m];
  if (file.has_attribute("", "warnings")) answer.warnings = file.attribute_texts("", "warnings");
  return answer;
}

}  // namespace asdic::detail::study
