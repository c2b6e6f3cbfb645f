#include "io/processing/recordings.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "core/geometry.h"
#include "core/memory_budget.h"
#include "io/hdf5/scale.h"
#include "io/scenario/embedded.h"
#include "io/scenario/scenario_reader.h"
#include "io/text/csv_table.h"
#include "processing/truth.h"

namespace asdic::detail {
namespace {

Scenario scenario_of(const Hdf5File& file, const std::filesystem::path& path,
                     const std::optional<std::filesystem::path>& scenario_path) {
  std::vector<std::string> overrides;
  if (file.has_attribute("", "overrides")) overrides = file.attribute_texts("", "overrides");
  const std::string text = file.read_text("scenario");
  const std::filesystem::path name =
      scenario_path.value_or(path.parent_path() / (path.filename().string() + ":scenario"));
  // One that the user has, letter by letter, may lead to any file of his.
  if (scenario_path && read_text_file(name, "the scenario that the pings were made of") == text)
    return parse_scenario(text, name, overrides);
  return parse_embedded_scenario(text, name, overrides);
}

InputError wrong(const std::filesystem::path& path, const std::string& got,
                 const std::string& expected) {
  return InputError({.where = path.string(), .got = got, .expected = expected});
}

/// A column of a table, which has as many rows as the others. \throws InputError where it has not
template <class T>
std::vector<T> column_of(const Hdf5File& file, const std::string& name, std::size_t rows) {
  std::vector<T> values = file.read<T>(name);
  if (values.size() != rows)
    throw wrong(file.path(), name + " with " + std::to_string(values.size()) + " rows",
                std::to_string(rows) + ", as its table has");
  return values;
}

/// \throws InputError unless every value is from `least` to below `end`
template <class T>
void check_all(const Hdf5File& file, const std::string& name, const std::vector<T>& values, T least,
               std::size_t end) {
  for (const T value : values)
    if (value < least || (value >= 0 && static_cast<std::size_t>(value) >= end))
      throw wrong(file.path(), std::to_string(value) + " in " + name,
                  "a number from " + std::to_string(least) + " to below " + std::to_string(end));
}

}  // namespace

PingRecordings::PingRecordings(const std::filesystem::path& path,
                               const std::optional<std::filesystem::path>& scenario_path)
    : path_(path), file_(open_ping_file(path)) {
  for (const char* name :
       {"pressure", "ping", "ping_time", "valid_samples", "phone_position", "replica", "scenario"})
    if (!file_.has(name))
      throw wrong(path_, std::string("no dataset ") + name, "a file with a ping");
  shape_ = file_.info("pressure").shape;
  if (!(shape_.size() == 3 || (shape_.size() == 4 && shape_[3] == 2)))
    throw wrong(path_, "pressure of another rank",
                "(ping, channel, sample) or (ping, channel, sample, iq)");
  numbers_ = file_.read<std::int32_t>("ping");
  if (numbers_.empty()) throw wrong(path_, "no whole ping", "at least one");
  scenario_ = scenario_of(file_, path_, scenario_path);
  if (shape_[1] != channels_of(scenario_))
    throw wrong(path_, std::to_string(shape_[1]) + " channels",
                std::to_string(channels_of(scenario_)) + ", those of its scenario");
  if (shape_[0] < numbers_.size())
    throw wrong(path_, "pressure of " + std::to_string(shape_[0]) + " pings",
                std::to_string(numbers_.size()) + ", as it has numbers of them");
  const std::size_t rows = numbers_.size();
  times_ = column_of<double>(file_, "ping_time", rows);
  valid_ = column_of<std::int64_t>(file_, "valid_samples", rows);
  check_all<std::int64_t>(file_, "valid_samples", valid_, 0, shape_[2] + 1);
  if (file_.has("transmitter")) transmitters_ = column_of<std::int32_t>(file_, "transmitter", rows);
  check_all(file_, "transmitter", transmitters_, 0, scenario_.transmitters.size());
  rate_ = file_.attribute_number("pressure", "sample_rate_hz");
  start_ = time_of_first(file_, "pressure", "time");
  if (complex_samples()) carrier_ = file_.attribute_number("pressure", "carrier_hz");
  if (file_.has_attribute("pressure", "continuous"))
    continuous_ = file_.attribute_number("pressure", "continuous") != 0.0;
  if (!(rate_ > 0.0))
    throw wrong(path_, "a sample rate of " + std::to_string(rate_) + " Hz", "one above 0");

  read_direct_sound();
  if (!file_.has("echoes/delay")) return;
  const std::vector<double> delay = file_.read<double>("echoes/delay");
  const auto column = [&](const std::string& name) {
    return column_of<double>(file_, "echoes/" + name, delay.size());
  };
  const auto numbers = [&](const std::string& name) {
    return column_of<std::int32_t>(file_, "echoes/" + name, delay.size());
  };
  const auto channel = numbers("channel"), target = numbers("target");
  const auto doppler = column("doppler_factor"), level = column("level_db"),
             elevation = column("arrival_elevation_deg"), bearing = column("arrival_bearing_deg");
  // Files of before 2026-11-22 do not tell: half the way, right for a pair in one place.
  std::vector<double> struck = delay;
  if (file_.has("echoes/struck"))
    struck = column("struck");
  else
    for (double& time : struck) time *= 0.5;
  const auto ping = numbers("ping");
  std::vector<std::int32_t> array(delay.size(), 0);
  if (file_.has("echoes/array")) array = numbers("array");
  check_all(file_, "echoes/array", array, -1, scenario_.arrays.size());
  for (std::size_t i = 0; i < delay.size(); ++i) {
    // Where every phone has its own paths, the middle one's stand for all.
    const auto phones =
        scenario_.arrays[static_cast<std::size_t>(std::max(array[i], 0))].phones.size();
    if (channel[i] >= 0 && channel[i] != static_cast<std::int32_t>(phones / 2)) continue;
    echo_ping_.push_back(ping[i]);
    echo_array_.push_back(array[i]);
    all_echoes_.push_back({.target = target[i],
                           .time = delay[i],
                           .struck = struck[i],
                           .doppler = doppler[i],
                           .level_db = level[i],
                           .travel = direction(radians(bearing[i]), radians(elevation[i]))});
  }
}

void PingRecordings::read_direct_sound() {
  if (!file_.has("arrivals/array")) return;
  const std::vector<std::int32_t> leg = file_.read<std::int32_t>("arrivals/leg");
  const auto column = [&](const std::string& name) {
    return column_of<double>(file_, "arrivals/" + name, leg.size());
  };
  const auto ping = column_of<std::int32_t>(file_, "arrivals/ping", leg.size()),
             array = column_of<std::int32_t>(file_, "arrivals/array", leg.size());
  const auto delay = column("delay"), elevation = column("arrival_elevation_deg"),
             bearing = column("bearing_deg");
  constexpr int source_to_array = 2;
  for (std::size_t i = 0; i < leg.size(); ++i) {
    if (leg[i] != source_to_array) continue;
    echo_ping_.push_back(ping[i]);
    echo_array_.push_back(array[i]);
    all_echoes_.push_back({.target = direct_sound,
                           .time = delay[i],
                           .doppler = std::numeric_limits<double>::quiet_NaN(),
                           .level_db = infinity,
                           .travel = direction(radians(bearing[i]), radians(elevation[i]))});
  }
}

std::size_t PingRecordings::row_of(int number) const {
  const auto at = std::find(numbers_.begin(), numbers_.end(), number);
  if (at == numbers_.end())
    throw InputError({.where = "ping",
                      .got = std::to_string(number),
                      .expected = numbers_.size() == 1
                                      ? std::to_string(numbers_[0]) + ", the file's only ping"
                                      : "a ping from " + std::to_string(numbers_.front()) + " to " +
                                            std::to_string(numbers_.back())});
  return static_cast<std::size_t>(at - numbers_.begin());
}

std::vector<Replica> PingRecordings::replicas() const {
  std::vector<Replica> result;
  for (std::size_t t = 0; t < scenario_.transmitters.size(); ++t) {
    const std::string name = t == 0 ? "replica" : "replica_" + std::to_string(t);
    if (!file_.has(name)) break;
    const std::vector<float> samples = file_.read<float>(name);
    if (file_.info(name).shape.size() == 2) {
      std::vector<std::complex<float>> envelope;
      for (std::size_t i = 0; i + 1 < samples.size(); i += 2)
        envelope.emplace_back(samples[i], samples[i + 1]);
      result.emplace_back(std::span<const std::complex<float>>(envelope), rate_, *carrier_);
    } else {
      result.emplace_back(std::span<const float>(samples), rate_);
    }
  }
  return result;
}

std::vector<PingRecordings::Piece> PingRecordings::pieces(std::size_t row) const {
  std::vector<Piece> result{{row, static_cast<std::size_t>(valid_[row])}};
  if (!continuous_) return result;
  // A ping is listened to into the rows of those that follow.
  auto wanted = static_cast<std::size_t>(scenario_.pings.recording_duration * rate_);
  for (std::size_t i = row;; ++i) {
    const auto here = std::min(wanted, static_cast<std::size_t>(valid_[i]));
    if (i == row)
      result[0].samples = std::max(here, std::size_t{1});
    else
      result.push_back({i, here});
    wanted -= std::min(wanted, here);
    if (wanted == 0 || i + 1 == pings()) return result;
  }
}

double PingRecordings::end(std::size_t row) const {
  std::size_t samples = 0;
  for (const Piece& piece : pieces(row)) samples += piece.samples;
  return start_ + static_cast<double>(samples) / rate_;
}

ArrayRecording PingRecordings::recording(std::size_t row, int array) const {
  const std::size_t first = first_channel(scenario_, array),
                    phones = scenario_.arrays[static_cast<std::size_t>(array)].phones.size();
  ArrayRecording result{.ping = numbers_[row],
                        .transmitter = transmitter(row),
                        .array = array,
                        .ping_time = times_[row],
                        .start = start_,
                        .sample_rate = rate_,
                        .carrier = carrier_};
  std::size_t samples = 0;
  for (const Piece& piece : pieces(row)) samples += piece.samples;
  MemoryBudget budget = MemoryBudget::without_key();
  budget.take(
      {.where = file_.path().string() + ": pressure",
       .what = std::to_string(samples) + " samples on " + std::to_string(phones) + " phones",
       .bytes = 3.0 * sizeof(float) * (complex_samples() ? 2.0 : 1.0) *
                static_cast<double>(samples) * static_cast<double>(phones),
       .remedy = "a shorter record or fewer phones"});
  const auto places = file_.read<double>("phone_position", {row, first, 0}, {1, phones, 3});
  for (std::size_t n = 0; n < phones; ++n)
    result.phones.emplace_back(places[3 * n], places[3 * n + 1], places[3 * n + 2]);
  std::size_t all = 0, wrong = 0;
  const auto finite = [&](float x) {
    ++all;
    if (std::isfinite(x)) return x;
    ++wrong;
    return 0.0F;
  };
  for (std::size_t n = 0; n < phones; ++n)
    for (const Piece& piece : pieces(row)) {
      if (piece.samples == 0) continue;
      if (complex_samples()) {
        const auto values =
            file_.read<float>("pressure", {piece.row, first + n, 0, 0}, {1, 1, piece.samples, 2});
        for (std::size_t i = 0; i < values.size(); i += 2)
          result.envelope.emplace_back(finite(values[i]), finite(values[i + 1]));
      } else {
        const auto values =
            file_.read<float>("pressure", {piece.row, first + n, 0}, {1, 1, piece.samples});
        std::transform(values.begin(), values.end(), std::back_inserter(result.pressure), finite);
      }
    }
  if (all > 0 && wrong == all)
    throw InputError({.where = path_.string() + ": pressure of ping " +
                               std::to_string(numbers_[row]) + ", array " + std::to_string(array),
                      .got = "no finite sample",
                      .expected = "a recording"});
  not_finite_ = wrong;
  return result;
}

std::vector<TrueEcho> PingRecordings::echoes(std::size_t row, int array) const {
  std::vector<TrueEcho> result;
  const double last = end(row);
  for (std::size_t i = 0; i < all_echoes_.size(); ++i) {
    if (echo_array_[i] != array || !std::isfinite(all_echoes_[i].time)) continue;
    if (echo_ping_[i] == numbers_[row]) {
      result.push_back(all_echoes_[i]);
      continue;
    }
    if (!continuous_) continue;
    // The other pings of a continuous record: their echoes, if they are of the same transmitter,
    // and their direct sound, which is loud enough to be received through the filters of another
    // pulse.
    const auto other = std::find(numbers_.begin(), numbers_.end(), echo_ping_[i]);
    if (other == numbers_.end()) continue;
    const auto at = static_cast<std::size_t>(other - numbers_.begin());
    TrueEcho echo = all_echoes_[i];
    if (transmitter(at) != transmitter(row) && echo.target != direct_sound) continue;
    echo.target = another_ping;
    echo.time += times_[at] - times_[row];
    if (echo.time >= start_ && echo.time <= last) result.push_back(echo);
  }
  return result;
}

std::vector<TrueTarget> PingRecordings::targets(std::size_t row,
                                                const std::vector<TrueEcho>& echoes) const {
  return true_targets(scenario_, numbers_[row], times_[row], echoes);
}

}  // namespace asdic::detail
