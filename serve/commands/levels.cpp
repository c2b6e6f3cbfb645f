#include "serve/commands/levels.h"

#include "raytrace/parallel/stop.h"
#include "serve/answers.h"
#include "serve/prepared_ping.h"
#include "serve/refusal.h"

namespace asdic::detail::serve {

Answer LevelsCommand::run(SessionState& session, const Command& command) {
  for (const char* key : {"deliver", "replica"})
    if (command.fields.find(key) != nullptr)
      throw Refusal("value", refusal_text(key, "one", "none: nothing is sent"));
  const PreparedPing ping = prepare_ping(session, command, Delivery::none);
  const PingRecord record = ping.simulator->simulate(ping.number, ping.sent);
  stop_point();
  Answer answer{.line = levels_line(ping.served, record, ping.simulator->scenario())};
  const LevelSeries& levels = record.levels;
  for (const auto* one : {&levels.echo, &levels.reverberation, &levels.noise})
    answer.samples.insert(answer.samples.end(), one->begin(), one->end());
  return answer;
}

}  // namespace asdic::detail::serve
