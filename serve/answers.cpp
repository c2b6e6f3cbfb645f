#include "serve/answers.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "serve/stream/block_sink.h"
#include "sonar/paths/enough_bounces.h"
#include "sonar/scenario/sampling.h"

namespace asdic::detail::serve {
namespace {

using OrderedJson = nlohmann::ordered_json;

/// Bytes that are not UTF-8 (of a scenario's title, say) are replaced; numbers that are not finite
/// are null.
std::string text(const OrderedJson& json) {
  return json.dump(-1, ' ', false, OrderedJson::error_handler_t::replace);
}

OrderedJson answer(const std::string& id, bool ok) {
  return {{"id", OrderedJson::parse(id)}, {"ok", ok}};
}

OrderedJson vector(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

OrderedJson moving(const std::string& name, const Kinematics& state) {
  return {
      {"name", name}, {"position", vector(state.position)}, {"velocity", vector(state.velocity)}};
}

OrderedJson targets(const PingRecord& record) {
  OrderedJson all = OrderedJson::array();
  for (const TargetSummary& target : record.summary) {
    OrderedJson one{{"name", target.name}, {"present", target.present}, {"paths", target.paths}};
    if (target.present && target.paths > 0) {
      one["echo_time"] = target.echo_time;
      one["echo_level_db"] = target.echo_level_db;
      one["echo_peak_db"] = target.echo_peak_db;
      one["reverberation_db"] = target.reverberation_db;
      one["noise_db"] = target.noise_db;
      one["echo_to_background_db"] = target.signal_excess_db;
      one["signal_excess_db"] = target.signal_excess_db;  // its old name
    }
    all.push_back(std::move(one));
  }
  return all;
}

OrderedJson percentiles(const LatencyLog& latency) {
  return {{"pings", latency.count()},
          {"p50", latency.percentile(0.5)},
          {"p99", latency.percentile(0.99)},
          {"longest", latency.longest()}};
}

OrderedJson timings(const Timings& t, double prepare) {
  return {{"prepare", prepare},   {"rays", t.rays},           {"eigenrays", t.eigenrays},
          {"patches", t.patches}, {"synthesis", t.synthesis}, {"noise", t.noise},
          {"write", t.write}};
}

/// What the samples are, in a file or after the line.
OrderedJson samples(const PingRecord& record) {
  const Recording& recording = record.recording;
  OrderedJson shape{record.phones.size(), recording.samples};
  if (recording.is_complex()) shape.push_back(2);
  OrderedJson all{{"shape", shape},
                  {"unit", "Pa"},
                  {"sample_rate", recording.sample_rate},
                  {"start", recording.start}};
  if (recording.is_complex()) all["carrier"] = recording.carrier;
  return all;
}

/// What the client should know before it trusts a number; nothing where there is nothing.
void add_warnings(const Scenario& scenario, OrderedJson& line) {
  if (!scenario.notes.empty()) line["warnings"] = scenario.notes;
}

/// What bounces that were not followed leave out of the ping, where that is estimated.
void add_left_out(const Bounces& followed, const Scenario& scenario, OrderedJson& line) {
  if (std::isnan(followed.left_out_db)) return;
  line["left_out_db"] = followed.left_out_db;
  const std::string lack = lacking(scenario.propagation, followed, "this ping");
  if (!lack.empty()) line["warnings"].push_back(lack);
}

}  // namespace

std::string greeting_line(const Scenario& scenario, const Pace& pace, const std::string& version) {
  OrderedJson line{{"asdic", 1},
                   {"ok", true},
                   {"version", version},
                   {"scenario", scenario.title},
                   {"pace", name_of(pace)},
                   {"channels", channels_of(scenario)},
                   {"sample_rate", recorded_rate(scenario)}};
  add_warnings(scenario, line);
  return text(line);
}

std::string ping_line(const ServedPing& served, const PingRecord& record,
                      const Scenario& scenario) {
  OrderedJson line = answer(served.id, true);
  if (served.scheduled) line = {{"scheduled", true}};
  line["ping"] = record.ping;
  line["time"] = record.start_time;
  line["transmitter"] = scenario.transmitters[static_cast<std::size_t>(record.transmitter)].name;
  line["elevation_deg"] = degrees(record.elevation);
  line["samples"] = samples(record);
  if (!served.file.empty()) {
    line["file"] = served.file;
    line["dataset"] = "/pressure";
    line["index"] = 0;
  }
  if (served.with_samples) {
    line["samples"]["type"] = "float32";
    line["samples"]["byte_order"] = "little";
    line["samples"]["bytes"] = record.pressure.size() * sizeof(float);
  }
  if (served.replica > 0) {
    OrderedJson shape{served.replica};
    if (record.recording.is_complex()) shape = {served.replica / 2, 2};
    line["replica"] = {{"shape", shape}, {"bytes", served.replica * sizeof(float)}};
  }
  line["targets"] = targets(record);
  double first = infinity;
  for (const EchoPath& echo : record.echoes) first = std::min(first, echo.received.delay);
  line["first_echo"] = first;  // null where there is none
  line["reused"] = {{"ocean", record.reuse.ocean},
                    {"legs", record.reuse.legs_reused},
                    {"legs_searched", record.reuse.legs_searched},
                    {"planes", record.reuse.planes_reused},
                    {"planes_searched", record.reuse.planes_searched},
                    {"reverberation", record.reuse.reverberation},
                    {"expected_level", record.reuse.expected_level}};
  line["timings"] = timings(record.timings, served.prepare);
  add_warnings(scenario, line);
  add_left_out(record.bounces, scenario, line);
  for (const std::string& warning : served.warnings) line["warnings"].push_back(warning);
  if (const std::string lack = ended_early(record.ended_searches); !lack.empty())
    line["warnings"].push_back(lack);
  if (record.sea_drawn_anew) line["sea_drawn_anew"] = true;
  line["latency"] = served.latency;
  line["behind"] = served.behind;
  return text(line);
}

Answer block_answer(Listening::Block&& block, double behind) {
  OrderedJson shape{block.channels, block.samples};
  if (block.components > 1) shape.push_back(block.components);
  OrderedJson line{{"block", block.number},
                   {"time", block.time},
                   {"samples", {{"shape", shape}}},
                   {"behind", behind}};
  if (block.sink) {
    block.sink->take(block);
    return {.line = text(line)};
  }
  line["samples"]["bytes"] = block.pressure.size() * sizeof(float);
  return {.line = text(line), .samples = std::move(block.pressure)};
}

std::string listen_line(const std::string& id, const Scenario& scenario, double time,
                        std::int64_t block) {
  OrderedJson line = answer(id, true);
  line["time"] = time;
  line["sample_rate"] = recorded_rate(scenario);
  if (scenario.pings.samples == Samples::baseband) line["carrier"] = recorded_carrier(scenario);
  line["channels"] = channels_of(scenario);
  line["block_samples"] = block;
  line["unit"] = "Pa";
  line["type"] = "float32";
  line["byte_order"] = "little";
  add_warnings(scenario, line);
  return text(line);
}

std::string listening_ended_line(double time) {
  return text({{"listening", false}, {"time", time}});
}

std::string update_line(const std::string& id, const Scenario& scenario, double now, double seconds,
                        const std::optional<double>& behind,
                        const std::vector<std::string>& warnings, bool sea_drawn_anew) {
  OrderedJson line = answer(id, true);
  line["time"] = now;
  add_warnings(scenario, line);
  for (const std::string& warning : warnings) line["warnings"].push_back(warning);
  line["latency"] = seconds;
  if (behind) line["behind"] = *behind;
  if (sea_drawn_anew) line["sea_drawn_anew"] = true;
  return text(line);
}

std::string state_line(const std::string& id, const Scenario& scenario, double now, int next,
                       const LatencyLog& latency) {
  OrderedJson line = answer(id, true);
  line["time"] = now;
  line["next_ping"] = next;
  line["seed"] = scenario.seed;
  line["wind_speed"] = scenario.wind_speed;
  line["platforms"] = OrderedJson::array();
  for (const Platform& platform : scenario.platforms)
    line["platforms"].push_back(moving(platform.name, platform.track.at(now)));
  line["arrays"] = OrderedJson::array();
  for (const ReceiverArray& array : scenario.arrays)
    line["arrays"].push_back({{"name", array.name}, {"phones", array.phones.size()}});
  line["targets"] = OrderedJson::array();
  for (const Target& target : scenario.targets)
    line["targets"].push_back(moving(target.name, target.track.at(now)));
  line["sample_rate"] = recorded_rate(scenario);
  line["latency"] = percentiles(latency);
  return text(line);
}

namespace {

/// Without what is the server's own: where its files are.
OrderedJson result(const std::string& id, double time, const std::string& json) {
  OrderedJson line = answer(id, true);
  line["time"] = time;
  OrderedJson all = OrderedJson::parse(json);
  for (auto& [key, value] : all.items())
    if (key != "filetype" && key != "scenario" && key != "output") line[key] = std::move(value);
  return line;
}

/// What follows a line.
OrderedJson numbers(const OrderedJson& shape) {
  std::size_t bytes = sizeof(float);
  for (const auto& n : shape) bytes *= n.get<std::size_t>();
  return {{"shape", shape}, {"type", "float32"}, {"byte_order", "little"}, {"bytes", bytes}};
}

}  // namespace

std::string result_line(const std::string& id, double time, const std::string& json,
                        const std::vector<std::string>& warnings) {
  OrderedJson line = result(id, time, json);
  if (!warnings.empty()) line["warnings"] = warnings;
  return text(line);
}

std::string field_line(const std::string& id, double time, const std::string& json,
                       const FieldData& field) {
  OrderedJson line = result(id, time, json);
  const ReceiverGrid& grid = field.receivers;
  line["source_depth"] = field.source_depths;
  line["depth"] = grid.depths;
  line["range"] = grid.ranges;
  line["irregular"] = grid.irregular;
  line["pressure"] =
      numbers({field.source_depths.size(), grid.rows(), grid.ranges.size(), std::size_t{2}});
  return text(line);
}

std::string levels_line(const ServedPing& served, const PingRecord& record,
                        const Scenario& scenario) {
  OrderedJson line = answer(served.id, true);
  line["ping"] = record.ping;
  line["time"] = record.start_time;
  line["transmitter"] = scenario.transmitters[static_cast<std::size_t>(record.transmitter)].name;
  line["elevation_deg"] = degrees(record.elevation);
  line["targets"] = targets(record);
  const LevelSeries& series = record.levels;
  line["levels"] = numbers({std::size_t{3}, series.echo.size()});
  line["levels"]["rows"] = {"echo", "reverberation", "noise"};
  line["levels"]["unit"] = "Pa2";
  line["levels"]["time_start"] = record.recording.start + 0.5 * series.time_step;
  line["levels"]["time_step"] = series.time_step;
  add_warnings(scenario, line);
  add_left_out(record.bounces, scenario, line);
  for (const std::string& warning : served.warnings) line["warnings"].push_back(warning);
  if (const std::string lack = ended_early(record.ended_searches); !lack.empty())
    line["warnings"].push_back(lack);
  return text(line);
}

std::string save_line(const std::string& id, int ping, double time, const std::string& file,
                      const std::string& toml) {
  OrderedJson line = answer(id, true);
  line["ping"] = ping;
  line["time"] = time;
  if (!file.empty()) line["file"] = file;
  if (!toml.empty()) line["toml"] = toml;
  return text(line);
}

std::string limits_line(const std::string& id, const SessionLimits& limits) {
  OrderedJson line = answer(id, true);
  for (const NamedLimit& one : limits_by_name(limits))
    line["limits"][std::string(one.name)] = one.value;
  return text(line);
}

std::string cancel_line(const std::string& id, std::size_t number) {
  OrderedJson line = answer(id, true);
  line["cancelled"] = number;
  return text(line);
}

std::string quit_line(const std::string& id, int pings, const LatencyLog& latency) {
  OrderedJson line = answer(id, true);
  line["pings"] = pings;
  line["latency"] = percentiles(latency);
  return text(line);
}

std::string refusal_line(const std::string& id, const std::string& code,
                         const std::string& message) {
  OrderedJson line = answer(id, false);
  line["error"] = {{"code", code}, {"message", message}};
  return text(line);
}

}  // namespace asdic::detail::serve
