#include <cmath>

#include "watched.h"

namespace asdic::python {
namespace {

using namespace py::literals;

/// [channels, samples]: float32, or complex64 where the record is complex baseband. Not a copy.
py::array pressure_of(const py::object& self) {
  const Ping& ping = self.cast<const Ping&>();
  const std::vector<py::ssize_t> shape = {static_cast<py::ssize_t>(ping.channels()),
                                          static_cast<py::ssize_t>(ping.samples())};
  const float* data = ping.pressure().data();
  if (!ping.is_complex()) return view(data, shape, self);
  return view(reinterpret_cast<const std::complex<float>*>(data), shape, self);
}

py::dict echoes_of(const Ping& ping) {
  const std::vector<Echo>& all = ping.echoes();
  const auto whole = [&](auto get) { return column<std::int32_t>(all, get); };
  const auto number = [&](auto get) { return column<double>(all, get); };
  return py::dict("target"_a = whole([](const Echo& e) { return e.target; }),
                  "array"_a = whole([](const Echo& e) { return e.array; }),
                  "delay"_a = number([](const Echo& e) { return e.delay; }),
                  "struck"_a = number([](const Echo& e) { return e.struck; }),
                  "doppler_factor"_a = number([](const Echo& e) { return e.doppler; }),
                  "level_db"_a = number([](const Echo& e) { return e.level_db; }),
                  "arrival_elevation_deg"_a =
                      number([](const Echo& e) { return degrees(e.arrival_elevation); }),
                  "arrival_bearing_deg"_a =
                      number([](const Echo& e) { return bearing_deg(e.arrival_bearing); }));
}

py::array phones_of(const Ping& ping) {
  const auto& phones = ping.phones();
  py::array_t<double> made({static_cast<py::ssize_t>(phones.size()), py::ssize_t{3}});
  double* to = made.mutable_data();
  for (const Vector& phone : phones)
    for (const double x : phone) *to++ = x;
  return made;
}

/// Every ping in order, each handed to Python. What that raises ends the run.
void run_all(const Pinger& pinger, const py::object& take, const py::object& progress) {
  std::exception_ptr raised;
  try {
    run_watched(
        [&](const Watch& watch) {
          std::stop_source ends;
          const std::stop_callback linked(watch.stop, [&] { ends.request_stop(); });
          try {
            pinger.run(
                [&](const Ping& ping) {
                  const py::gil_scoped_acquire held;
                  if (raised) return;
                  try {
                    take(ping);
                  } catch (...) {
                    raised = std::current_exception();
                    ends.request_stop();
                  }
                },
                {.stop = ends.get_token(), .progress = watch.progress});
          } catch (const Stopped&) {
            if (!raised) throw;
          }
        },
        progress);
  } catch (const Stopped&) {
    if (!raised) throw;
  }
  if (raised) std::rethrow_exception(raised);
}

}  // namespace

void add_ping(py::module_& module) {
  py::class_<Ping>(module, "Ping")
      .def_property_readonly("number", &Ping::number)
      .def_property_readonly("transmitter", &Ping::transmitter)
      .def_property_readonly("time", &Ping::time)
      .def_property_readonly("sample_rate", &Ping::sample_rate)
      .def_property_readonly("start", &Ping::start)
      .def_property_readonly("is_complex", &Ping::is_complex)
      .def_property_readonly("carrier", &Ping::carrier)
      .def_property_readonly("pressure", &pressure_of)
      .def_property_readonly("phones", &phones_of)
      .def_property_readonly("echoes", &echoes_of)
      .def_property_readonly("scenario", &Ping::scenario)
      // Samples never change, so copies share them. A pickle holds None in its place: the dataset
      // has the scenario and the number that it is made of (datasets.ping_of).
      .def("__deepcopy__", [](const py::object& self, const py::object&) { return self; })
      .def("__reduce__",
           [](const Ping&) { return py::make_tuple(py::type::of(py::none()), py::tuple()); });
  py::class_<Pinger>(module, "Pinger")
      .def(py::init([](const Scenario& scenario, const py::object& progress) {
        return watched([&](const Watch& watch) { return Pinger(scenario, watch); }, progress);
      }))
      .def_property_readonly("pings", &Pinger::pings)
      .def_property_readonly("warnings", &Pinger::warnings)
      .def("ping",
           [](const Pinger& pinger, int number) {
             return watched([&](const Watch& watch) { return pinger.ping(number, watch); });
           })
      .def("run", &run_all);
}

}  // namespace asdic::python
