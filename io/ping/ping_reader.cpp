#include "core/error.h"
#include "io/ping/ping_file.h"

namespace asdic::detail {

Hdf5File open_ping_file(const std::filesystem::path& path) {
  Hdf5File file = Hdf5File::open(path);
  const auto wrong = [&](const std::string& got, const std::string& expected) {
    return InputError({.where = path.string(), .got = got, .expected = expected});
  };
  if (!file.has_attribute("", "filetype"))
    throw wrong("an HDF5 file without filetype", "a ping file of asdic");
  if (const std::string type = file.attribute_text("", "filetype"); type != "asdic ping")
    throw wrong("filetype \"" + type + "\"", "\"asdic ping\"");
  const std::string version = file.attribute_text("", "version");
  if (!version.starts_with("1.") && !version.starts_with("2."))
    throw wrong("version " + version, "version 1.x or 2.x");
  return file;
}

PingFile::PingFile(const std::filesystem::path& path) : file_(open_ping_file(path)) {
  const auto wrong = [&](const std::string& got, const std::string& expected) {
    return InputError({.where = path.string(), .got = got, .expected = expected});
  };
  if (file_.has("pressure")) shape_ = file_.info("pressure").shape;
  const bool complex = shape_.size() == 4 && shape_[3] == 2;
  if (shape_.size() != 3 && !complex)
    throw wrong("pressure of another rank",
                "(ping, channel, sample) or (ping, channel, sample, 2)");
  components_ = complex ? 2 : 1;
  shape_[0] = file_.has("ping") ? file_.info("ping").shape[0] : 0;  // written last: whole pings
}

double PingFile::sample_rate() const {
  return file_.attribute_number("pressure", "sample_rate_hz");
}

double PingFile::carrier() const {
  return is_complex() ? file_.attribute_number("pressure", "carrier_hz") : 0.0;
}

bool PingFile::complete() const { return file_.attribute_number("", "complete") == 1.0; }

std::string PingFile::scenario_text() const { return file_.read_text("scenario"); }

void PingFile::check(std::size_t ping) const {
  if (ping >= pings())
    throw InputError({.where = file_.path().string() + ": ping",
                      .got = std::to_string(ping + 1),
                      .expected = "a ping from 1 to " + std::to_string(pings())});
}

std::size_t PingFile::valid_samples(std::size_t ping) const {
  check(ping);
  return static_cast<std::size_t>(file_.read<std::int64_t>("valid_samples", {ping}, {1}).front());
}

std::vector<float> PingFile::pressure(std::size_t ping, std::size_t channel) const {
  const std::size_t n = valid_samples(ping);
  if (channel >= channels())
    throw InputError({.where = file_.path().string() + ": channel",
                      .got = std::to_string(channel),
                      .expected = "a channel from 0 to " + std::to_string(channels() - 1)});
  if (is_complex()) return file_.read<float>("pressure", {ping, channel, 0, 0}, {1, 1, n, 2});
  return file_.read<float>("pressure", {ping, channel, 0}, {1, 1, n});
}

std::vector<TargetSummary> PingFile::summary(std::size_t ping) const {
  check(ping);
  std::vector<TargetSummary> rows;
  if (!file_.has("summary/present")) return rows;
  const Shape shape = file_.info("summary/present").shape;
  if (shape.size() != 2)
    throw InputError({.where = file_.path().string() + ": summary/present",
                      .got = std::to_string(shape.size()) + " dimensions",
                      .expected = "2, ping and target"});
  const std::size_t n = shape[1];
  const auto column = [&](const std::string& key) {
    return file_.read<double>("summary/" + key, {ping, 0}, {1, n});
  };
  const auto present = column("present"), paths = column("paths"), time = column("echo_time"),
             level = column("echo_level_db"), reverberation = column("reverberation_db"),
             noise = column("noise_db"), peak = column("echo_peak_db"),
             excess = column(file_.has("summary/echo_to_background_db") ? "echo_to_background_db"
                                                                        : "signal_excess_db");
  // Files of before have no such column: the first array's, in most of them the only one.
  const auto array = file_.has("summary/array") ? column("array") : std::vector<double>(n, 0.0);
  std::vector<std::string> names = file_.attribute_texts("target_index", "names");
  names.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    rows.push_back({.name = names[i],
                    .present = present[i] != 0.0,
                    .array = static_cast<int>(array[i]),
                    .paths = static_cast<int>(paths[i]),
                    .echo_time = time[i],
                    .echo_level_db = level[i],
                    .reverberation_db = reverberation[i],
                    .noise_db = noise[i],
                    .echo_peak_db = peak[i],
                    .signal_excess_db = excess[i]});
  }
  return rows;
}

}  // namespace asdic::detail
