#pragma once
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "io/files/output_file.h"
#include "io/hdf5/hdf5_file.h"
#include "sonar/ping/ping_record.h"
#include "sonar/scenario/scenario.h"

namespace asdic::detail {

/// Who made a file, when, with what.
struct Provenance {
  std::string program_version{}, build{};  ///< at the root: the results may depend on them
  /// Under /run, apart from the results.
  std::string host{}, started{}, cpu{}, library_versions{};
  int threads = 1;
};

/// Rays of the first ping, for drawing.
struct RayPaths {
  enum class Kind { fan = 0, eigenray = 1 };
  struct Path {
    Kind kind = Kind::fan;
    double launch_elevation = 0.0;         ///< positive up [rad]
    std::vector<double> range{}, depth{};  ///< [points] [m]
  };
  struct Line {
    std::vector<double> range{}, depth{};  ///< [points] [m]
  };
  std::vector<Path> paths{};
  /// Over a transect: the plane of the fan, and the boundaries in it that are not flat.
  std::optional<double> bearing{};  ///< clockwise from north [rad]
  Line bottom{}, surface{};
  std::vector<double> hit_range{};  ///< where the fan meets the surface [m]
};

/// How the file tells when its samples are: by start and step, or with every time written out as
/// well, for readers that want an axis (as large as half a phone's pressure).
enum class SampleTimes { start_and_step, written_out };

/// Writes docs/formats/ping.md while a run goes on: a part of the output, readable after every
/// append() even if the program dies, that gets its name by finish(). All methods throw RunError
/// when the world says no. One thread at a time (HDF5).
class PingFileWriter {
 public:
  PingFileWriter(const std::filesystem::path& path, const Scenario& scenario,
                 const Provenance& provenance, SampleTimes times = SampleTimes::start_and_step);
  PingFileWriter(OutputFile output, const Scenario& scenario, const Provenance& provenance,
                 SampleTimes times = SampleTimes::start_and_step);
  PingFileWriter(PingFileWriter&&) noexcept;
  /// Without finish(): the part stays if it holds a ping, else it goes.
  ~PingFileWriter();

  /// Where it writes until it is finished.
  [[nodiscard]] const std::filesystem::path& part();

  void write_rays(const RayPaths& rays);  ///< at most once
  /// \param record  as many phones as the scenario; no longer than the first record
  void append(const PingRecord& record);
  /// Closes the file and gives it its name. Not complete and without a ping: removes it.
  void finish(bool complete);
  /// The same of a run that asked for these pings alone: the file tells of no others, and is
  /// complete.
  void finish_these();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Opens a ping file of version 1 or 2. \throws InputError for a file that is not one
[[nodiscard]] Hdf5File open_ping_file(const std::filesystem::path& path);

/// Reads a ping file. All throw InputError for a file that is not one, RunError when reading fails.
class PingFile {
 public:
  explicit PingFile(const std::filesystem::path& path);

  [[nodiscard]] std::size_t pings() const noexcept { return shape_[0]; }
  [[nodiscard]] std::size_t channels() const noexcept { return shape_[1]; }
  [[nodiscard]] std::size_t samples() const noexcept { return shape_[2]; }
  [[nodiscard]] double sample_rate() const;  ///< [Hz]
  /// Complex baseband samples about carrier(); else real pressure.
  [[nodiscard]] bool is_complex() const noexcept { return components_ == 2; }
  [[nodiscard]] double carrier() const;  ///< [Hz]; 0 for pressure
  [[nodiscard]] bool complete() const;
  /// [pings] their numbers in the scenario's schedule, from 1
  [[nodiscard]] std::vector<int> numbers() const;
  [[nodiscard]] std::string scenario_text() const;

  /// \param ping, channel  counted from 0   \return [valid samples of the ping] [Pa],
  /// real and imaginary parts in turn where the file holds complex baseband
  /// \throws InputError ("ping", "channel") if there is no such
  [[nodiscard]] std::vector<float> pressure(std::size_t ping, std::size_t channel) const;
  [[nodiscard]] std::size_t valid_samples(std::size_t ping) const;
  /// One per target.
  [[nodiscard]] std::vector<TargetSummary> summary(std::size_t ping) const;

  /// Everything else: attributes, datasets with shapes, columns of tables.
  [[nodiscard]] const Hdf5File& file() const noexcept { return file_; }

 private:
  void check(std::size_t ping) const;

  Hdf5File file_;
  Shape shape_{0, 0, 0};
  std::size_t components_ = 1;
};

}  // namespace asdic::detail
