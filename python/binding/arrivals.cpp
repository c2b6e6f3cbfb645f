#include <algorithm>
#include <cmath>

#include "watched.h"

namespace asdic::python {
namespace {

/// Eigenrays as columns; what is asked for twice is made once.
class Columns {
 public:
  explicit Columns(std::vector<Arrival> arrivals) : arrivals_(std::move(arrivals)) {}

  [[nodiscard]] std::size_t size() const noexcept { return arrivals_.size(); }

  py::array numbers(double (*get)(const Arrival&)) const { return column<double>(arrivals_, get); }
  py::array counts(int (*get)(const Arrival&)) const {
    return column<std::int32_t>(arrivals_, get);
  }
  [[nodiscard]] py::array amplitude() const {
    return column<std::complex<double>>(arrivals_, [](const Arrival& a) { return a.amplitude; });
  }
  [[nodiscard]] py::array reflection() const {
    return column<std::complex<double>>(arrivals_, [](const Arrival& a) { return a.reflection; });
  }
  template <class T, class Get>
  py::list bounces(const Get& get) const {
    py::list made;
    for (const Arrival& a : arrivals_) made.append(column<T>(a.bounces, get));
    return made;
  }

  /// Of several sets in a row.
  void append(const std::vector<Arrival>& more) {
    arrivals_.insert(arrivals_.end(), more.begin(), more.end());
  }

 private:
  std::vector<Arrival> arrivals_;
};

struct NumberColumn {
  const char* name;
  double (*get)(const Arrival&);
  const char* doc;
};
constexpr NumberColumn number_columns[] = {
    {"delay", [](const Arrival& a) { return a.delay; }, "travel time [s]"},
    {"level_db", [](const Arrival& a) { return a.level_db(); }, "re the pressure at 1 m [dB]"},
    {"launch_elevation_deg", [](const Arrival& a) { return degrees(a.launch_elevation); },
     "of travel, positive up [deg]"},
    {"arrival_elevation_deg", [](const Arrival& a) { return degrees(a.arrival_elevation); },
     "of travel, positive up [deg]"},
    {"launch_deflection_deg", [](const Arrival& a) { return degrees(a.launch_deflection); },
     "of travel, clockwise from the line to the receiver [deg]"},
    {"arrival_deflection_deg", [](const Arrival& a) { return degrees(a.arrival_deflection); },
     "of travel, clockwise from the line to the receiver [deg]"},
    {"path_length", [](const Arrival& a) { return a.path_length; }, "along the ray [m]"},
    {"spreading_db", [](const Arrival& a) { return -db_from_amplitude(a.spreading); },
     "loss by the ray tube alone [dB]"},
    {"absorption_db", [](const Arrival& a) { return a.absorption_db; }, "loss in the water [dB]"},
    {"scattered", [](const Arrival& a) { return a.scattered; },
     "mean intensity that rough boundaries scatter about the path, re 1 m"}};

struct CountColumn {
  const char* name;
  int (*get)(const Arrival&);
  const char* doc;
};
constexpr CountColumn count_columns[] = {
    {"kind", [](const Arrival& a) { return static_cast<int>(a.kind); },
     "0 a ray, 1 diffracted, 2 a ray with the amplitude of waves"},
    {"surface_bounces", [](const Arrival& a) { return a.surface_bounces; }, "how many"},
    {"bottom_bounces", [](const Arrival& a) { return a.bottom_bounces; }, "how many"},
    {"upper_turns", [](const Arrival& a) { return a.upper_turns; }, "turning points above"},
    {"lower_turns", [](const Arrival& a) { return a.lower_turns; }, "turning points below"},
    {"caustics", [](const Arrival& a) { return a.caustics; }, "passed"}};

Columns find(const Scenario& scenario, double range, double depth,
             std::optional<double> source_depth, std::optional<double> bearing_deg,
             std::optional<double> frequency, int ping) {
  Receiver receiver{.range = range,
                    .depth = depth,
                    .source_depth = source_depth,
                    .bearing = {},
                    .frequency = frequency,
                    .ping = ping};
  if (bearing_deg) receiver.bearing = radians(*bearing_deg);
  return Columns(watched([&](const Watch& watch) { return arrivals(scenario, receiver, watch); }));
}

/// All legs of a ping: their paths in a row, and of each path which leg it is of.
py::tuple find_legs(const Scenario& scenario, int ping) {
  const std::vector<Leg> all =
      watched([&](const Watch& watch) { return legs(scenario, ping, watch); });
  Columns columns({});
  std::vector<std::int32_t> leg, target, array, path;
  std::vector<double> bearing, range, latitude, longitude;
  for (const Leg& one : all) {
    columns.append(one.arrivals);
    for (std::size_t i = 0; i < one.arrivals.size(); ++i) {
      leg.push_back(static_cast<std::int32_t>(one.kind));
      target.push_back(one.target);
      array.push_back(one.array);
      path.push_back(static_cast<std::int32_t>(i));
      bearing.push_back(bearing_deg(one.bearing));
      range.push_back(one.range);
      latitude.push_back(one.latitude);
      longitude.push_back(one.longitude);
    }
  }
  using namespace py::literals;
  py::dict of_legs("leg"_a = taken(std::move(leg)), "target"_a = taken(std::move(target)),
                   "array"_a = taken(std::move(array)), "path"_a = taken(std::move(path)),
                   "bearing_deg"_a = taken(std::move(bearing)),
                   "range"_a = taken(std::move(range)));
  if (std::any_of(latitude.begin(), latitude.end(), [](double x) { return !std::isnan(x); })) {
    of_legs["latitude"] = taken(std::move(latitude));
    of_legs["longitude"] = taken(std::move(longitude));
  }
  return py::make_tuple(std::move(columns), std::move(of_legs));
}

}  // namespace

void add_arrivals(py::module_& module) {
  py::class_<Columns> columns(module, "Arrivals",
                              "Eigenrays, sorted by delay: one NumPy array a quantity, [paths].");
  columns.def("__len__", &Columns::size);
  py::list names;
  const auto add = [&](const char* name, const auto& get, const char* doc) {
    columns.def_property_readonly(name, get, doc);
    names.append(name);
  };
  for (const NumberColumn& one : number_columns)
    add(
        one.name, [get = one.get](const Columns& c) { return c.numbers(get); }, one.doc);
  add("amplitude", &Columns::amplitude, "complex, all losses in it, re 1 m");
  add("reflection", &Columns::reflection, "product of the boundaries' coefficients");
  for (const CountColumn& one : count_columns)
    add(
        one.name, [get = one.get](const Columns& c) { return c.counts(get); }, one.doc);
  columns.attr("names") = py::tuple(names);
  columns.def_property_readonly(
      "bounce_range",
      [](const Columns& c) { return c.bounces<double>([](const Bounce& b) { return b.range; }); },
      "of each path an array: where it meets boundaries [m]");
  columns.def_property_readonly(
      "bounce_grazing_deg",
      [](const Columns& c) {
        return c.bounces<double>([](const Bounce& b) { return degrees(b.grazing); });
      },
      "of each path an array: angles between path and boundary [deg]");
  columns.def_property_readonly(
      "bounce_bottom",
      [](const Columns& c) { return c.bounces<bool>([](const Bounce& b) { return b.bottom; }); },
      "of each path an array: off the bottom, else off the surface");
  module.def("arrivals", &find);
  module.def("legs", &find_legs);
}

}  // namespace asdic::python
