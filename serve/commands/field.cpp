#include "serve/commands/field.h"

#include <cstring>

#include "core/error.h"
#include "core/text.h"
#include "io/result/result_json.h"
#include "io/scenario/propagation.h"
#include "io/text/toml_value.h"
#include "raytrace/parallel/stop.h"
#include "serve/answers.h"
#include "serve/motion.h"
#include "serve/refusal.h"
#include "serve/sound_request.h"

namespace asdic::detail::serve {
namespace {

/// A fault of the run, told of the command where that gives the run.
Refusal refusal_of_run(const InputError& error, const SessionState& session,
                       const Command& command) {
  const InputFault& fault = error.fault();
  const auto colon = fault.where.rfind(": ");
  const std::string key = colon == std::string::npos ? fault.where : fault.where.substr(colon + 2);
  if (command.fields.find("run") != nullptr && (key == "run" || key.starts_with("run.")))
    return {"value", refusal_text(key, fault.got, fault.expected)};
  return session.live.refusal(error, command.fields);
}

/// Sets the platform's start. What else is in the sea does not matter.
void start_from(const Kinematics& platform, TomlValue& document) {
  for (const char* other : {"target", "interferer"}) erase_key(document, other);
  TomlValue& platforms = value_at(document, "platform", "");
  auto* several = std::get_if<TomlValue::Array>(&platforms.data);
  set_kinematics(platform, 0.0, several == nullptr ? platforms : several->front());
}

/// The run as the command would have it, in the ocean around where the platform is by then.
PropagationCase case_of(const SessionState& session, const Command& command, double time,
                        TomlValue& document, std::vector<std::string>& notes) {
  document = session.live.document();
  const TomlValue* run = command.fields.find("run");
  if (run != nullptr) {
    if (!std::holds_alternative<TomlValue::Table>(run->data))
      throw Refusal("value", refusal_text("run", "something else", "a table"));
    set_key(document, "run", *run);
  }
  set_key(value_at(document, "pings", ""), "count", {.data = std::int64_t{1}, .origin = ""});
  start_from(session.live.state().scenario.platforms[0].track.at(time), document);
  PropagationCase run_case = propagation_case_of(document, session.settings.scenario.path, notes);
  const TomlValue* table = document.find("run");
  if (table != nullptr && table->find("task") != nullptr && run_case.task != Task::field)
    throw Refusal("value", refusal_text("run.task", in_quotes(std::string(word_of(run_case.task))),
                                        "\"field\""));
  run_case.task = Task::field;
  return run_case;
}

}  // namespace

Answer FieldCommand::run(SessionState& session, const Command& command) {
  static constexpr std::string_view own[] = {"run"};
  const auto asked = read_request<FieldRequest>(command.fields, own);
  const double time = asked.time.value_or(session.now());
  const SessionLimits& limits = session.settings.limits;
  TomlValue document;
  FieldResult result;
  std::vector<std::string> warnings;
  try {
    result.run_case = case_of(session, command, time, document, warnings);
    const ReceiverGrid& grid = result.run_case.receivers;
    const double receivers = double(result.run_case.source_depths.size()) * double(grid.rows()) *
                             double(grid.ranges.size());
    if (receivers > double(limits.receivers))
      throw Refusal("limit", refusal_text("run.receivers", to_text(receivers) + " receivers",
                                          "at most " + std::to_string(limits.receivers)));
    const auto bytes = static_cast<std::size_t>(receivers) * 2 * sizeof(float);
    if (bytes > limits.answer_bytes)
      throw Refusal("limit", refusal_text("run.receivers", std::to_string(bytes) + " bytes",
                                          "at most " + std::to_string(limits.answer_bytes) +
                                              " bytes in an answer"));
    session.make_room(bytes);
    PropagationResult found = detail::run(result.run_case, {}, session.budget());
    result.notes = found.notes;
    result.data = field_data(result.run_case, std::move(found));
  } catch (const InputError& error) {
    throw refusal_of_run(told_of_scenario(error, document, session.settings.scenario.path), session,
                         command);
  }
  stop_point();
  result.origin.title = result.run_case.title;
  result.origin.warnings = warnings;
  Answer answer{.line = field_line(command.id, time, field_json(result), result.data)};
  answer.samples.resize(2 * result.data.pressure.size());
  if (!answer.samples.empty())
    std::memcpy(answer.samples.data(), result.data.pressure.data(),
                answer.samples.size() * sizeof(float));
  return answer;
}

}  // namespace asdic::detail::serve
