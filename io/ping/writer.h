#pragma once
#include <optional>

#include "io/hdf5/earth.h"
#include "io/hdf5/scale.h"
#include "io/ping/arrival_table.h"
#include "io/ping/growing_table.h"
#include "io/ping/ping_file.h"
#include "io/ping/sections.h"
#include "io/ping/tables.h"
#include "sonar/reverberation/phone_groups.h"

// Inside of PingFileWriter, for its own .cpp files.
namespace asdic::detail {

struct PingFileWriter::Impl {
  OutputFile output;
  Hdf5File file;
  Scenario scenario;
  EarthPlaces earth;
  bool times_written_out = false, long_arrays = false;
  std::size_t pings = 0;
  bool finished = false;
  ArrivalTable arrivals;
  GrowingTable echoes, patches;
  std::optional<GrowingTable> interference;  // where there are interferers
  std::size_t every = 1;
  std::size_t echoes_not_listed = 0;        // pairs of paths, of the ping that has most
  std::size_t samples = 0, level_bins = 0;  // of the first record

  Impl(OutputFile&& to, const Scenario& s, SampleTimes times)
      : output(std::move(to)),
        file(Hdf5File::create(output.part())),
        scenario(s),
        earth(s.origin, s.area.get()),
        times_written_out(times == SampleTimes::written_out),
        long_arrays(has_long_arrays(s)),
        arrivals(file, earth),
        echoes(file, "echoes", "echo", ping_file::echo_columns()),
        patches(file, "patches", "patch", ping_file::patch_columns(earth.known())) {
    if (scenario.interferers.empty()) return;
    interference.emplace(file, "interference", "received_path", ping_file::interference_columns());
    std::string names;
    for (const Interferer& ship : scenario.interferers)
      names += (names.empty() ? "" : ",") + ship.name;
    file.set_attribute("interference", "names", names);
  }

  template <class T>
  void growing(const std::string& dataset, const std::string& long_name, const std::string& units,
               const std::vector<std::string>& scales = {}, const Shape& row = {},
               const Meaning& meaning = {}) {
    file.create_growing<T>(dataset, row, std::size_t{64});
    describe(file, dataset, long_name, units, meaning);
    std::vector<std::string> all{"ping"};
    all.insert(all.end(), scales.begin(), scales.end());
    file.attach_scales(dataset, all);
  }

  void create_ping_datasets();
  void create_sampled_datasets(const PingRecord& record);
  void append_pressure(const PingRecord& record);
  /// Latitudes and longitudes, where the map has a place on the Earth.
  struct PlaceNames {
    std::string latitude, longitude;
  };
  void create_places(const PlaceNames& names, const std::string& whose,
                     const std::vector<std::string>& scales, const Shape& row);
  void append_places(const PlaceNames& names, const std::vector<Vec2>& positions);
  void append_geometry(const PingRecord& record);
  void append_tables(const PingRecord& record);
  void append_summary(const PingRecord& record);
};

}  // namespace asdic::detail
