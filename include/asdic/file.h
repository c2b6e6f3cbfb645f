#pragma once

/// \file
/// Ping files (HDF5, docs/formats/ping.md): what `asdic ping` writes and `asdic process`, `info`
/// and `plot` read, with the scenario in it.
///
/// ```cpp
/// asdic::Scenario scenario = asdic::Scenario::read("deep_ocean.toml");
/// scenario.set("pings.recording_duration", 36.0);
/// asdic::write_ping("one.h5", scenario, asdic::ping(scenario));
/// const asdic::Ping ping = asdic::read_ping("one.h5");
/// std::cout << ping.channels() << " phones of \"" << ping.scenario().get("title").text() <<
/// "\"\n";
/// ```

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "asdic/export.h"
#include "asdic/ping.h"
#include "asdic/scenario.h"
#include "asdic/watch.h"

namespace asdic {

/// Writes pings as they are made: beside the file under a name of its own, which takes the file's
/// name by finish(). A file that asdic did not write is not written over. A writer that is finished
/// or was moved from throws InputError when it is used.
class ASDIC_API PingWriter {
 public:
  /// Checks the scenario as Scenario::validate(). \throws InputError if there must be no such file,
  /// RunError if there cannot be, Stopped
  PingWriter(const std::filesystem::path& path, const Scenario& scenario, const Watch& watch = {});
  PingWriter(PingWriter&&) noexcept;
  PingWriter& operator=(PingWriter&&) noexcept;
  /// Without finish(): there is no file, and what was written stays beside it for `asdic recover`.
  ~PingWriter();

  /// \param ping  of the writer's scenario, made here, after those that were written
  /// \throws InputError, RunError
  void append(const Ping& ping);
  /// The pings that are in it are those that were asked for: the file is complete.
  void finish();

 private:
  struct Data;
  Data& open();
  std::unique_ptr<Data> data_;
};

/// A file of one ping. Its /scenario is scenario.to_toml().
ASDIC_API void write_ping(const std::filesystem::path& path, const Scenario& scenario,
                          const Ping& ping);
/// A file of all pings of a scenario: what `asdic ping` does. Called off, it leaves no file, and
/// what was written stays beside it. \throws InputError, RunError, Stopped
ASDIC_API void write_pings(const std::filesystem::path& path, const Scenario& scenario,
                           const Watch& watch = {});

/// What a scenario says of the sea and of who is where in it, for `asdic plot` to draw before
/// anything is computed. A file that is there is replaced. \throws InputError, RunError
ASDIC_API void write_scene(const std::filesystem::path& path, const Scenario& scenario);

/// What an area is asked to show: as `asdic area`; what is left out is the scenario's.
struct ASDIC_API AreaOptions {
  std::vector<double> depths = {};              ///< of the target [m]
  std::optional<double> reach = {};             ///< [m]
  std::optional<double> strength_db = {};       ///< of the target at every aspect [dB]
  std::optional<std::string> fluctuation = {};  ///< none, swerling-1 … swerling-4
  std::optional<std::string> transmitter = {};  ///< a name
  std::optional<std::string> array = {};        ///< a name
  std::optional<int> ping = {};                 ///< of the run, from 1
  int bearings = 360, ranges = 500;             ///< cells
  double false_alarm_probability = 1e-4;        ///< of a cell
  double reference_cells = 24.0;                ///< averaged for the background; 0: it is known
};
/// What a sonar sees of the area around it: echo, reverberation, noise, signal excess and
/// probability of detection over bearing and range, as a file (docs/formats/area.md). A file that
/// is there is replaced. \return warnings   \throws InputError, RunError, Stopped
ASDIC_API std::vector<std::string> write_area(const std::filesystem::path& path,
                                              const Scenario& scenario,
                                              const AreaOptions& options = {},
                                              const Watch& watch = {});

/// A ping of a file. Of a continuous record: all that is received of it, over the pings that
/// follow. \throws InputError, RunError
///
/// \param number  as Ping::number() tells it; the file's first ping
[[nodiscard]] ASDIC_API Ping read_ping(const std::filesystem::path& path,
                                       std::optional<int> number = {});
/// How many pings it holds.
[[nodiscard]] ASDIC_API int pings_in(const std::filesystem::path& path);

}  // namespace asdic
