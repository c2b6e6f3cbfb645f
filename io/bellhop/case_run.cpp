// Part of case_parts.h: run type, fan, step and box.
#include <algorithm>
#include <cmath>

#include "core/units.h"
#include "io/bellhop/case_parts.h"

namespace asdic::detail::bellhop {
namespace {

constexpr std::int64_t most_beams = 10'000'000;
constexpr double most_receivers = 2e9;
constexpr std::size_t most_planes = 1'000'000;

BeamKind beam_kind(CaseReading& reading, char letter) {
  switch (letter) {
    case 'g':
      return BeamKind::ray_centred_hat;
    case 'B':
      return BeamKind::gaussian;
    case 'b':
      return BeamKind::ray_centred_gaussian;
    case 'S':
      return BeamKind::simple_gaussian;
    case 'C':
      return BeamKind::cerveny_cartesian;
    case 'R':
      return BeamKind::cerveny_ray_centred;
    case 'G':
    case '^':
    case ' ':
      return BeamKind::hat;
    default:
      reading.note("run type, letter 2: " + shown(std::string(1, letter)) +
                   " is no kind of beam; geometric hat beams, as BELLHOP does");
      return BeamKind::hat;
  }
}

void read_run_type(CaseReading& reading) {
  ListReader& env = reading.env;
  PropagationCase& run_case = reading.run_case();
  env.begin("run type");
  std::string letters;
  if (!env.text(letters, "")) env.fail("", "no value", "up to seven letters in quotes");
  letters.resize(std::max<std::size_t>(letters.size(), 7), ' ');
  env.end();
  switch (letters[0]) {
    case 'R':
      run_case.task = Task::rays;
      break;
    case 'E':
      run_case.task = Task::eigenrays;
      break;
    case 'A':
    case 'a':
      run_case.task = Task::arrivals;
      break;
    case 'V':
    case 'v':
      run_case.task = Task::eigenrays_and_arrivals;
      break;
    case 'C':
      run_case.field = FieldKind::coherent;
      break;
    case 'I':
      run_case.field = FieldKind::incoherent;
      break;
    case 'S':
      run_case.field = FieldKind::semi_coherent;
      break;
    default:
      env.fail("letter 1", shown(letters.substr(0, 1)),
               "R (rays), E (eigenrays), A or a (arrivals), V or v (both), C, I or S (field)");
  }
  reading.input.binary_arrivals = letters[0] == 'a' || letters[0] == 'v';
  run_case.beams.kind = beam_kind(reading, letters[1]);
  run_case.beams.source = letters[3] == 'X' ? SourceKind::line : SourceKind::point;
  run_case.receivers.irregular = letters[4] == 'I';
  run_case.beams.displacement = letters[6] == 'S';
  if (run_case.receivers.irregular && reading.receivers_sorted)
    reading.note(env.where("letter 5") +
                 ": the depths and the ranges of the receivers were sorted, each on their own, as "
                 "BELLHOP does: those of an irregular grid (I) no longer pair as written");
  if (reading.input.map)
    check_map_run(reading, letters);
  else if (letters[5] == '3')
    reading.note("run type, letter 6: a 2-D run although the file says 3-D");
  const ReceiverGrid& grid = run_case.receivers;
  if (grid.irregular && grid.depths.size() != grid.ranges.size())
    env.fail("letter 5",
             std::to_string(grid.depths.size()) + " receiver depths and " +
                 std::to_string(grid.ranges.size()) + " ranges",
             "as many depths as ranges on an irregular grid (I)");
  const double planes = reading.input.map ? double(reading.input.map->planes()) : 1.0;
  if (planes > double(most_planes))
    env.fail("",
             std::to_string(reading.input.map->planes()) +
                 " places of sources and azimuths of receivers",
             "at most " + std::to_string(most_planes) + ", each with a plane of its own");
  if (const double all = planes * double(run_case.source_depths.size()) * double(grid.size());
      all > most_receivers)
    env.fail("", shown(all) + " receivers", "at most " + shown(most_receivers));
  if (letters[2] == '*') run_case.beams.pattern = read_source_pattern(reading);
}

/// BELLHOP's number of beams where the file says 0.
std::int64_t automatic_beams(const CaseReading& reading) {
  const PropagationCase& run_case = reading.input.run_case;
  if (run_case.task == Task::rays) return 50;
  const double range = run_case.receivers.ranges.back();
  const double depth = reading.bottom_depth - reading.surface_depth;
  const double by_wavelength = std::min(0.3 * range * run_case.frequency / 1500.0, 1e7);
  const double by_depth = range > 0.0 ? std::min(pi / std::atan(depth / (10.0 * range)), 1e7) : 2.0;
  return std::min<std::int64_t>(most_beams, std::max({std::int64_t(by_wavelength),
                                                      std::int64_t(300), std::int64_t(by_depth)}));
}

/// The fan, out of declinations in degrees.
void take_fan(CaseReading& reading, GivenVector given) {
  PropagationCase& run_case = reading.run_case();
  BeamSettings& beams = run_case.beams;
  std::sort(given.values.begin(), given.values.end());
  std::int64_t n = given.count;
  double last = given.values.back();
  const bool full_turn = n > 1 && given.values.size() > 1 &&
                         std::abs(std::remainder(last - given.values.front(), 360.0)) < 1e-10 &&
                         last != given.values.front();
  if (full_turn) {  // the last beam is the first once more
    reading.note("the last of the " + std::to_string(n) +
                 " launch angles is the first, a full circle on: left out, as BELLHOP does");
    if (given.are_ends())
      last -= (last - given.values.front()) / double(n - 1);
    else
      given.values.pop_back();
    --n;
  }
  if (given.values.size() == 2 && n >= 2) {
    beams.lowest = radians(-last);
    beams.highest = radians(-given.values.front());
  } else {
    for (std::size_t i = given.values.size(); i-- > 0;)
      beams.elevations.push_back(radians(-given.values[i]));
    beams.lowest = beams.elevations.front();
    beams.highest = beams.elevations.back();
  }
  run_case.literal.beams = int(n);
}

void read_fan(CaseReading& reading) {
  ListReader& env = reading.env;
  PropagationCase& run_case = reading.run_case();
  env.begin("number of beams");
  const std::int64_t written = env.need_integer("", 0, most_beams);
  if (reading.options.single_beam)
    run_case.literal.single_beam = int(env.need_integer("the one beam wanted", 0, most_beams));
  env.end();
  const std::int64_t n = written == 0 ? automatic_beams(reading) : written;
  if (written == 0)
    reading.note("number of beams 0: by asdic's own rule; BELLHOP's gives " + std::to_string(n));

  const GivenVector given = read_vector(env, n, "launch angles");
  reading.input.fan_place = env.where("");
  for (const double angle : given.values)
    if (!(std::abs(angle) <= 360.0))
      env.fail("angle", shown(angle) + " degrees", "an angle from -360 to 360 degrees");
  take_fan(reading, given);
  // as written: exact for a ray run, a floor for the rest
  const bool free = written == 0 && run_case.task != Task::rays;
  run_case.beams.count = free ? 0 : run_case.literal.beams;
  if (run_case.literal.single_beam && (*run_case.literal.single_beam < 1 ||
                                       *run_case.literal.single_beam > run_case.literal.beams)) {
    reading.note("the one beam wanted, " + std::to_string(*run_case.literal.single_beam) +
                 ", is not one of the " + std::to_string(run_case.literal.beams) +
                 "; all are traced");
    run_case.literal.single_beam.reset();
  }
}

void read_step(CaseReading& reading) {
  ListReader& env = reading.env;
  double& step = reading.run_case().literal.step;
  step = env.need_real("step");
  if (step < 0.0) env.fail("step", shown(step) + " m", "a step of at least 0 m (0: automatic)");
}

void read_box_depth(CaseReading& reading) {
  ListReader& env = reading.env;
  double& depth = reading.run_case().box_depth;
  depth = env.need_real("box depth");
  if (!(depth > 0.0)) env.fail("box depth", shown(depth) + " m", "a depth above 0 m");
}

/// \return [m]
double read_box_range(ListReader& env, const char* item) {
  const double km = env.need_real(item);
  if (!(km > 0.0)) env.fail(item, shown(km) + " km", "a range above 0 km");
  return 1000.0 * km;
}

void tell_step(CaseReading& reading) {
  double& step = reading.run_case().literal.step;
  if (step != 0.0) return;
  step = (reading.bottom_depth - reading.surface_depth) / 10.0;
  reading.note("step 0: asdic chooses its own; BELLHOP's rule gives " + shown(step) + " m");
}

void read_step_and_box(CaseReading& reading) {
  reading.env.begin("STEP ZBOX RBOX");
  read_step(reading);
  read_box_depth(reading);
  reading.run_case().box_range = read_box_range(reading.env, "box range");
  reading.env.end();
  tell_step(reading);
}

/// The same of BELLHOP3D, in another order.
void read_step_and_boxes(CaseReading& reading) {
  MapInput& map = *reading.input.map;
  reading.env.begin("STEP XBOX YBOX ZBOX");
  read_step(reading);
  map.box_x = read_box_range(reading.env, "box x");
  map.box_y = read_box_range(reading.env, "box y");
  read_box_depth(reading);
  reading.env.end();
  tell_step(reading);
  reading.run_case().box_range = std::hypot(map.box_x, map.box_y);
}

/// Beams in azimuth.
void read_azimuth_fan(CaseReading& reading) {
  ListReader& env = reading.env;
  MapInput& map = *reading.input.map;
  env.begin("number of beams in azimuth");
  map.fan = int(env.need_integer("", 0, most_beams));
  env.end();
  const GivenVector given = read_vector(env, map.fan == 0 ? 2 : map.fan, "launch azimuths");
  for (const double angle : given.values)
    if (!(std::abs(angle) <= 720.0))
      env.fail("azimuth", shown(angle) + " degrees", "an azimuth from -720 to 720 degrees");
  const auto [lowest, highest] = std::minmax_element(given.values.begin(), given.values.end());
  map.lowest_azimuth_deg = *lowest;
  map.highest_azimuth_deg = *highest;
}

/// Where rays go on beyond the profiles of a .ssp file.
void note_short_section(CaseReading& reading) {
  const PropagationCase& run_case = reading.input.run_case;
  if (!run_case.environment.section) return;
  const auto ranges = run_case.environment.section->ranges();
  const std::vector<double>& receivers = run_case.receivers.ranges;
  const bool rays = run_case.task == Task::rays;
  const double first = rays ? 0.0 : std::min(0.0, receivers.front());
  const double last = rays ? run_case.box_range : std::max(0.0, receivers.back());
  if (first >= ranges.front() && last <= ranges.back()) return;
  reading.note(reading.root + ".ssp: its profiles go from " + shown(ranges.front() / 1000.0) +
               " to " + shown(ranges.back() / 1000.0) + " km, the " + (rays ? "box" : "receivers") +
               " from " + shown(first / 1000.0) + " to " + shown(last / 1000.0) +
               " km: beyond them the outer profile goes on (BELLHOP stops there with an error)");
}

template <class Value>
Value choice(const ListReader& env, const char* item, char letter,
             std::initializer_list<std::pair<char, Value>> all, const char* expected) {
  for (const auto& [name, value] : all)
    if (name == letter) return value;
  env.fail(item, shown(std::string(1, letter)), expected);
}

/// BELLHOP takes the pressure for a letter that it does not know, so also for the "!" of a comment.
CervenyBeams::Component cerveny_component(CaseReading& reading, char letter) {
  using Component = CervenyBeams::Component;
  if (letter == 'V') return Component::vertical;
  if (letter == 'H') return Component::horizontal;
  if (letter != 'P' && letter != '!')
    reading.note(reading.env.where("component") + ": " + shown(std::string(1, letter)) +
                 " is none of P (pressure), V (vertical) and H (horizontal); the pressure, as "
                 "BELLHOP does");
  return Component::pressure;
}

CervenyBeams read_cerveny(CaseReading& reading) {
  using Width = CervenyBeams::Width;
  using Curvature = CervenyBeams::Curvature;
  ListReader& env = reading.env;
  CervenyBeams beams;
  env.begin("Cerveny beams: width and curvature, EPSMULT, RLOOP");
  std::string letters;
  if (!env.text(letters, "letters")) env.fail("letters", "no value", "two letters in quotes");
  letters.resize(std::max<std::size_t>(letters.size(), 2), ' ');
  beams.width = choice<Width>(env, "letter 1", letters[0],
                              {{'F', Width::space_filling},
                               {'M', Width::minimum},
                               {'W', Width::wkb},
                               {'C', Width::cerveny}},
                              "F (space-filling), M (minimum), W (WKB) or C (Cerveny)");
  beams.curvature = choice<Curvature>(env, "letter 2", letters[1],
                                      {{'D', Curvature::doubled},
                                       {'S', Curvature::standard},
                                       {' ', Curvature::standard},
                                       {'Z', Curvature::zero}},
                                      "D (doubled), S (standard) or Z (zero)");
  env.real(beams.width_multiplier, "width multiplier");
  double loop_km = 0.0;
  env.real(loop_km, "loop range");
  beams.loop_range = 1000.0 * loop_km;
  env.end();

  env.begin("Cerveny beams: NIMAGE IBWIN COMPONENT");
  std::int64_t images = beams.images, window = beams.window;
  env.integer(images, "number of images");
  if (images < 1 || images > 3) env.fail("number of images", std::to_string(images), "1, 2 or 3");
  env.integer(window, "window");
  if (window < 1 || window > 1'000'000)
    env.fail("window", std::to_string(window), "a whole number above 0");
  std::string component = "P";
  env.text(component, "component");
  beams.component = cerveny_component(reading, component.empty() ? ' ' : component[0]);
  env.end();
  beams.images = int(images);
  beams.window = int(window);
  return beams;
}

}  // namespace

void read_run(CaseReading& reading) {
  read_run_type(reading);
  read_fan(reading);
  if (reading.input.map) {
    read_azimuth_fan(reading);
    read_step_and_boxes(reading);
    return;
  }
  read_step_and_box(reading);
  note_short_section(reading);
  const BeamKind kind = reading.run_case().beams.kind;
  if (kind == BeamKind::cerveny_cartesian || kind == BeamKind::cerveny_ray_centred)
    reading.run_case().beams.cerveny = read_cerveny(reading);
}

}  // namespace asdic::detail::bellhop
