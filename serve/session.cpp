#include "serve/session.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <new>

#include "core/text.h"
#include "io/scenario/document.h"
#include "io/scenario/propagation.h"
#include "serve/answers.h"
#include "serve/places.h"
#include "sonar/scenario/sampling.h"

namespace asdic::serve {
namespace {

constexpr std::size_t most_simulators = 4;  // of waveforms that take turns

std::string four_digits(int number, int width) {
  std::string digits = std::to_string(number);
  return std::string(static_cast<std::size_t>(std::max(0, width - int(digits.size()))), '0') +
         digits;
}

}  // namespace

Answer refusal_answer(const std::string& id, const std::string& code, const std::string& message,
                      bool last) {
  return {.line = refusal_line(id, code, message), .samples = {}, .last = last};
}

Session::Session(const SessionSettings& settings, std::function<double()> clock)
    : settings_(settings),
      clock_(std::move(clock)),
      start_(clock_()),
      live_(settings.scenario, settings.data, settings.limits),
      turns_(live_.state().scenario),
      budget_(budget_of(scenario::read_document(settings.scenario.text, settings.scenario.path,
                                                settings.scenario.overrides))
                  .share(static_cast<double>(settings.limits.memory_bytes), "memory_bytes")),
      propagation_(std::make_shared<SharedPropagation>(settings.limits.kept_bytes)) {}

Answer Session::greeting() const {
  return {.line = greeting_line(live_.state().scenario, settings_.pace,
                                settings_.provenance.program_version),
          .samples = {}};
}

Answer Session::answer(std::string_view line) {
  Command command;
  try {
    command = read_command(line, settings_.limits);
    command.received = clock_();
  } catch (const Refusal& refusal) {
    return refusal_answer(id_of(line, settings_.limits), refusal.code(), refusal.what());
  }
  return execute(command);
}

Answer Session::execute(const Command& command) {
  try {
    return carry_out(command);
  } catch (const Refusal& refusal) {
    return refusal_answer(command.id, refusal.code(), refusal.what());
  } catch (const MemoryError& error) {
    return refusal_answer(command.id, "limit", error.what());
  } catch (const InputError& error) {  // out of building a simulator
    const Refusal refusal = live_.refusal(error, command.fields);
    return refusal_answer(command.id, refusal.code(), refusal.what());
  } catch (const std::bad_alloc&) {
    return refusal_answer(command.id, "run", "not enough memory for this ping");
  } catch (const std::exception& error) {
    settings_.report(error.what());
    return refusal_answer(command.id, "run", "it could not be done; the server's log says why");
  }
}

Answer Session::carry_out(const Command& command) {
  switch (command.kind) {
    case CommandKind::ping:
      return ping(command);
    case CommandKind::update:
      return update(command);
    default:
      break;
  }
  if (!std::get<TomlValue::Table>(command.fields.data).empty())
    throw Refusal("value", refusal_text(std::string(name_of(command.kind)), "further keys",
                                        "\"command\" and \"id\" alone"));
  if (command.kind == CommandKind::state) return state(command);
  if (command.kind == CommandKind::limits)
    return {.line = limits_line(command.id, settings_.limits), .samples = {}};
  return {.line = quit_line(command.id, pings_, latency_), .samples = {}, .last = true};
}

double Session::now() const {
  if (settings_.pace.by_the_clock()) return (clock_() - start_) * *settings_.pace.factor;
  return turns_.next(live_.state().scenario).time;
}

Delivery Session::usual_delivery() const {
  return settings_.output.empty() ? Delivery::none : Delivery::file;
}

double Session::wait(const Command& command) const {
  if (command.kind != CommandKind::ping || !settings_.pace.by_the_clock()) return 0.0;
  const TomlValue* time = command.fields.find("time");
  if (time == nullptr) return 0.0;
  double wanted = 0.0;  // a wrong one is told when the command is carried out
  if (const auto* number = std::get_if<double>(&time->data)) wanted = *number;
  if (const auto* number = std::get_if<std::int64_t>(&time->data))
    wanted = static_cast<double>(*number);
  const double ahead = std::max(0.0, (wanted - now()) / *settings_.pace.factor);
  return ahead > double(settings_.limits.idle_seconds) ? 0.0 : ahead;  // it is refused
}

Transmission Session::transmission_of(const PingRequest& request) const {
  const Scenario& scenario = live_.state().scenario;
  Transmission sent =
      request.transmitter ? turns_.next(scenario, *request.transmitter) : turns_.next(scenario);
  if (request.time)
    sent.time = *request.time;
  else if (settings_.pace.by_the_clock())
    sent.time = now();
  if (request.elevation) {
    if (scenario.transmitters[static_cast<std::size_t>(sent.transmitter)].table)
      throw Refusal("value", refusal_text("elevation_deg", to_text(degrees(*request.elevation)),
                                          "none for a transmitter with a table"));
    sent.elevation = *request.elevation;
  }
  return sent;
}

const PingSimulator& Session::simulator_of(LiveScenario::State state) {
  const auto found = std::find_if(simulators_.begin(), simulators_.end(),
                                  [&](const Simulator& one) { return one.key == state.key; });
  if (found != simulators_.end()) {
    simulators_.splice(simulators_.begin(), simulators_, found);
  } else {
    auto made = std::make_unique<PingSimulator>(std::move(state.scenario), propagation_, budget_);
    if (!std::exchange(judged_, true)) made->judge_paths();
    simulators_.push_front({.key = std::move(state.key), .simulator = std::move(made)});
    if (simulators_.size() > most_simulators) simulators_.pop_back();
  }
  return *simulators_.front().simulator;
}

Answer Session::ping(const Command& command) {
  const double begin = clock_();
  PingRequest request = read_ping(command.fields, live_, settings_.limits, usual_delivery());
  const Transmission sent = transmission_of(request);
  request.changes.transmitter = sent.transmitter;
  ServedPing served{.id = command.id};
  double due = command.received;  // when it was to be sent, on the clock
  if (settings_.pace.by_the_clock()) {
    const double wanted = start_ + sent.time / *settings_.pace.factor;
    if (wanted > begin + double(settings_.limits.idle_seconds))
      throw Refusal("limit", refusal_text("time", to_text(sent.time) + " s",
                                          "a ping at most idle_seconds ahead of the clock"));
    served.behind = std::max(0.0, begin - wanted);
    due = std::max(due, wanted);
  }
  const PingSimulator& simulator = simulator_of(live_.with(request.changes, command.fields));
  const Scenario& scenario = simulator.scenario();
  check_places(scenario, pings_ + 1, sent.transmitter, sent.time);
  const double bytes = double(channels_of(scenario)) * double(recording_of(scenario).samples) * 8.0;
  if (request.deliver == Delivery::samples && bytes > double(settings_.limits.answer_bytes))
    throw Refusal("limit", refusal_text("deliver", "more samples",
                                        "at most " + std::to_string(settings_.limits.answer_bytes) +
                                            " bytes in an answer"));
  served.prepare = clock_() - begin;
  PingRecord record = simulator.simulate(pings_ + 1, sent);
  if (request.deliver == Delivery::file) {
    const double start = clock_();
    served.file = next_file().string();
    Scenario told = scenario;
    if (request.elevation)
      told.overrides.push_back(live_.elevation_override(sent.transmitter, sent.elevation));
    PingFileWriter writer(served.file, told, settings_.provenance);
    writer.append(record);
    writer.finish(true);
    record.timings.write = clock_() - start;
  }
  ++pings_;
  turns_.sent(sent, request.time || settings_.pace.by_the_clock());
  served.with_samples = request.deliver == Delivery::samples;
  served.latency = clock_() - due;
  latency_.add(served.latency);
  Answer answer{.line = ping_line(served, record, scenario), .samples = {}};
  if (served.with_samples) answer.samples = std::move(record.pressure);
  return answer;
}

Answer Session::update(const Command& command) {
  live_.update(command.fields, now());
  return {
      .line = update_line(command.id, live_.state().scenario, now(), clock_() - command.received),
      .samples = {}};
}

Answer Session::state(const Command& command) const {
  return {.line = state_line(command.id, live_.state().scenario, now(), pings_ + 1, latency_),
          .samples = {}};
}

/// Sessions write into folders of their own, which nobody had before: nothing is overwritten.
std::filesystem::path Session::next_file() {
  for (int n = 1; folder_.empty(); ++n) {
    const auto folder = settings_.output / ("session-" + four_digits(n, 4));
    std::error_code error;
    if (std::filesystem::create_directory(folder, error)) folder_ = folder;
    if (error) throw RunError(folder.string() + ": " + error.message());
  }
  return folder_ / ("ping-" + four_digits(pings_ + 1, 6) + ".h5");
}

}  // namespace asdic::serve
