#include <netcdf.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <map>
#include <random>
#include <vector>

#include "fuzz/fuzz_target.h"
#include "fuzz/scratch.h"
#include "io/climatology/data_grid.h"
#include "io/files/input_file.h"
#include "io/isolated/child.h"
#include "io/ping/ping_file.h"
#include "io/processing/recordings.h"
#include "io/result/result_file.h"
#include "io/scenario/scenario_reader.h"
#include "sonar/ping/ping.h"
#include "study/reader/study_reader.h"
#include "study/runs/study_file.h"
#include "support/synthetic_study.h"

// HDF5 and netCDF files with a few bytes changed:  fuzz_damaged_files hdf5|netcdf [RUNS [SEED]]
//
// Their libraries crash on some of them and never come to an end with others. Our process must do
// neither: every file is read, or refused in words. Files are changed in place, so that most of
// what the library believes still holds. Says what became of them.

namespace {

using namespace asdic::detail;
using Bytes = std::string;

/// A small file that is whole, and all that may be asked of one.
struct Kind {
  std::string name;  ///< of the file
  Bytes bytes;
  std::function<void(const std::filesystem::path&)> read;
};

// The files, as asdic writes them.

Bytes ping_file(const fuzz::Scratch& folder) {
  const std::vector<std::string> overrides{"pings.recording_duration=0.2",
                                           "target.0.position=[60.0,0.0,200.0]"};
  const Scenario scenario = parse_scenario(support::small_scenario, "small.toml", overrides);
  const PingSimulator sonar(scenario);
  PingFileWriter writer(folder / "made.h5", scenario, {});
  for (int ping = 1; ping <= 2; ++ping) writer.append(sonar.simulate(ping));
  writer.finish(true);
  return read_input(folder / "made.h5", "");
}

Bytes study_file(const fuzz::Scratch& folder) {
  const support::SyntheticStudy study{
      .realisations = 12, .skips = true, .series_every = 4, .kept_every = 2};
  study::StudyRun run;
  run.output = folder / "made_study.h5";
  static_cast<void>(study::run_study(study.work(), run));
  return read_input(run.output, "");
}

Bytes result_file(const fuzz::Scratch& folder, const PropagationFile& result) {
  Hdf5File file = Hdf5File::create(folder / "made_result.h5");
  write_hdf5_result(file, result);
  file.close();
  return read_input(folder / "made_result.h5", "");
}

Bytes grid_file(const fuzz::Scratch& folder, int format) {
  const std::string path = folder / "made.nc";
  int file = 0, axes[3] = {}, variables[3] = {}, temperature = 0;
  const auto check = [](int status) { fuzz::insist(status == NC_NOERR, nc_strerror(status)); };
  const char* const names[] = {"depth", "lat", "lon"};
  const char* const units[] = {"m", "degrees_north", "degrees_east"};
  const std::size_t sizes[] = {3, 4, 5};
  check(nc_create(path.c_str(), NC_CLOBBER | format, &file));
  for (int i = 0; i < 3; ++i) {
    check(nc_def_dim(file, names[i], sizes[i], &axes[i]));
    check(nc_def_var(file, names[i], NC_DOUBLE, 1, &axes[i], &variables[i]));
    check(nc_put_att_text(file, variables[i], "units", std::strlen(units[i]), units[i]));
  }
  check(nc_put_att_text(file, variables[0], "positive", 4, "down"));
  check(nc_def_var(file, "temperature", NC_SHORT, 3, axes, &temperature));
  const double scale = 0.01;
  check(nc_put_att_double(file, temperature, "scale_factor", NC_DOUBLE, 1, &scale));
  check(nc_enddef(file));
  for (int i = 0; i < 3; ++i) {
    std::vector<double> axis(sizes[i]);
    for (std::size_t k = 0; k < axis.size(); ++k) axis[k] = 10.0 * static_cast<double>(k + 1);
    check(nc_put_var_double(file, variables[i], axis.data()));
  }
  const std::vector<short> values(60, 1500);
  check(nc_put_var_short(file, temperature, values.data()));
  check(nc_close(file));
  return read_input(path, "");
}

// What is asked of them.

void read_everything(const std::filesystem::path& path) {
  const Hdf5File file = Hdf5File::open(path);
  for (const DatasetInfo& info : file.datasets())
    for (const std::string& key : file.attributes(info.path))
      static_cast<void>(file.attribute_text(info.path, key));
  for (const std::string& key : file.attributes(""))
    static_cast<void>(file.attribute_text("", key));
}

void read_ping(const std::filesystem::path& path) {
  const PingFile file(path);
  for (std::size_t p = 0; p < std::min<std::size_t>(file.pings(), 2); ++p) {
    static_cast<void>(file.summary(p));
    for (std::size_t c = 0; c < std::min<std::size_t>(file.channels(), 4); ++c)
      static_cast<void>(file.pressure(p, c));
  }
}

void process_ping(const std::filesystem::path& path) {
  const PingRecordings file(path);
  static_cast<void>(file.replicas());
  for (std::size_t row = 0; row < std::min<std::size_t>(file.pings(), 2); ++row) {
    static_cast<void>(file.recording(row, 0));
    const auto echoes = file.echoes(row, 0);
    static_cast<void>(file.targets(row, echoes));
  }
}

void read_study(const std::filesystem::path& path) {
  const study::StudyFile file(path);
  static_cast<void>(file.table());
  static_cast<void>(file.sessions());
  static_cast<void>(file.faults());
  if (!file.series_index().empty()) static_cast<void>(file.series(0));
  static_cast<void>(file.series_timing());
  for (const study::KeptKind& kind : study::kept_kinds()) {
    study::KeptReader reader(file, kind);
    for (std::size_t k = 0; k < reader.told().index.size(); ++k) static_cast<void>(reader.at(k));
  }
  file.verify();
}

void read_grid(const std::filesystem::path& path) {
  const auto grid = DataGrid::find(path, {"temperature"});
  if (!grid) return;
  for (std::size_t level = 0; level < std::min<std::size_t>(grid->depths().size(), 3); ++level)
    static_cast<void>(grid->bilinear(15.0, 15.0, level) + grid->nearest(50.0, 40.0, level));
}

std::vector<Kind> kinds_of(const std::string& library, const fuzz::Scratch& folder) {
  if (library == "netcdf")
    return {{"classic.nc", grid_file(folder, 0), read_grid},
            {"offset.nc", grid_file(folder, NC_64BIT_OFFSET), read_grid},
            {"hdf5.nc", grid_file(folder, NC_NETCDF4), read_grid}};
  const Bytes ping = ping_file(folder), study = study_file(folder);
  const auto result = [](const auto& path) { static_cast<void>(read_result(path)); };
  const bellhop::ShadeFile field{.title = "field",
                                 .frequency = 100.0,
                                 .source_depths = {10.0},
                                 .receiver_depths = {10.0, 20.0},
                                 .receiver_ranges = {100.0, 200.0, 300.0},
                                 .pressure = std::vector<std::complex<float>>(6, {0.5F, 0.1F})};
  return {{"ping.h5", ping, read_ping},         {"ping.h5", ping, process_ping},
          {"ping.h5", ping, read_everything},   {"study.h5", study, read_study},
          {"study.h5", study, read_everything}, {"field.h5", result_file(folder, field), result}};
}

/// Changes a few bytes where they stand.
class Damage {
 public:
  explicit Damage(std::uint64_t seed) : random_(seed) {}

  Bytes operator()(Bytes bytes) {
    for (std::size_t n = 1 + below(6); n > 0; --n) change(bytes);
    return bytes;
  }
  std::size_t below(std::size_t n) { return static_cast<std::size_t>(random_() % n); }

 private:
  void change(Bytes& bytes) {
    if (bytes.empty()) return;
    const std::size_t at = below(bytes.size());
    const auto fill = [&](std::size_t length, char value) {
      std::fill_n(bytes.begin() + static_cast<std::ptrdiff_t>(at),
                  std::min(length, bytes.size() - at), value);
    };
    switch (below(20)) {
      case 0:
        return fill(8, '\xff');
      case 1:
        return fill(8, '\0');
      case 2:
        return fill(64, static_cast<char>(below(256)));
      case 3:  // a piece of it elsewhere
      {
        const std::size_t from = below(bytes.size());
        const Bytes piece = bytes.substr(from, 1 + below(32));
        bytes.replace(at, std::min(piece.size(), bytes.size() - at), piece, 0,
                      std::min(piece.size(), bytes.size() - at));
        return;
      }
      case 4:
        if (below(8) == 0) bytes.resize(at);
        return;
      case 5:
      case 6:
      case 7:
      case 8:
      case 9:
      case 10:
        bytes[at] = static_cast<char>(bytes[at] ^ (1 << below(8)));
        return;
      case 11:
      case 12:
        bytes[at] = static_cast<char>(bytes[at] + 1);
        return;
      case 13:
        bytes[at] = static_cast<char>(bytes[at] - 1);
        return;
      default:
        bytes[at] = static_cast<char>(below(256));
    }
  }
  std::mt19937_64 random_;
};

/// What became of a file, in a word or two.
std::string fate_of(const Kind& kind, const std::filesystem::path& path) {
  try {
    kind.read(path);
    return "read";
  } catch (const InputError& error) {
    const std::string said = error.what();
    if (said.find("library crashes on it") != std::string::npos) return "crashed the library";
    if (said.find("does not come to an end") != std::string::npos) return "went round in circles";
    return "refused";
  } catch (const RunError&) {
    return "refused";
  }
}

}  // namespace

int main(int argc, char** argv) {
  const std::string library = argc > 1 ? argv[1] : "";
  if (library != "hdf5" && library != "netcdf")
    return std::fprintf(stderr, "usage: %s hdf5|netcdf [RUNS [SEED]]\n", argv[0]), 2;
  const long runs = argc > 2 ? std::atol(argv[2]) : 1000;
  Damage damaged(argc > 3 ? std::strtoull(argv[3], nullptr, 10) : 1);
  isolated::set_limits({.processor = std::chrono::milliseconds(500),
                        .wall = std::chrono::seconds(60),
                        .memory = std::size_t{512} << 20});
  const fuzz::Scratch folder;
  const std::vector<Kind> kinds = kinds_of(library, folder);
  for (const Kind& kind : kinds) {  // whole, they can be read
    const auto path = folder.write(kind.name, kind.bytes.data(), kind.bytes.size());
    kind.read(path);
  }
  std::map<std::string, long> fates;
  for (long i = 0; i < runs; ++i) {
    alarm(120);  // our own process must come to an end, too
    const Kind& kind = kinds[damaged.below(kinds.size())];
    const Bytes bytes = damaged(kind.bytes);
    if (const char* kept = std::getenv("ASDIC_FUZZ_KEEP"))  // the last one is what failed
      std::filesystem::copy_file(folder.write(kind.name, bytes.data(), bytes.size()), kept,
                                 std::filesystem::copy_options::overwrite_existing);
    ++fates[fate_of(kind, folder.write(kind.name, bytes.data(), bytes.size()))];
  }
  std::printf("%s: %ld damaged files", library.c_str(), runs);
  for (const auto& [fate, count] : fates) std::printf(", %ld %s", count, fate.c_str());
  std::printf("\n");
  return 0;
}
