#include "serve/command_log.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <fstream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/text.h"
#include "serve/session.h"

namespace asdic::detail::serve {
namespace {

using LogJson = nlohmann::ordered_json;

std::string as_line(const LogJson& json) {
  return json.dump(-1, ' ', false, LogJson::error_handler_t::replace);
}

LogJson header_of(const SessionSettings& settings) {
  return {{"asdic_log", 1},
          {"version", settings.provenance.program_version},
          {"pace", name_of(settings.pace)},
          {"overrides", settings.scenario.overrides},
          {"scenario", settings.scenario.text}};
}

}  // namespace

CommandLog::CommandLog(const std::filesystem::path& file, const SessionSettings& settings)
    : name_(file.string()) {
  file_ = ::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_APPEND | O_CLOEXEC, 0600);
  if (file_ < 0 && errno == EEXIST)
    throw InputError({.where = "--log",
                      .got = in_quotes(name_) + ", which is there",
                      .expected = "a new file: none is written over"});
  if (file_ < 0) throw RunError(name_ + ": " + std::strerror(errno));
  append(as_line(header_of(settings)));
}

CommandLog::~CommandLog() { ::close(file_); }

int CommandLog::new_session() {
  const std::lock_guard lock(mutex_);
  return ++sessions_;
}

void CommandLog::write(int session, const Command& command, const std::optional<double>& acts,
                       double start, double begun, double done, bool ok) {
  LogJson line{{"session", session},
               {"received", command.received - start},
               {"begun", begun - start},
               {"done", done - start}};
  if (acts) line["acts"] = *acts;
  line["ok"] = ok;
  line["command"] = LogJson::parse(command.line);
  const std::lock_guard lock(mutex_);
  append(as_line(line));
}

void CommandLog::append(const std::string& line) {
  const std::string whole = line + '\n';
  for (std::size_t done = 0; done < whole.size();) {
    const ssize_t n = ::write(file_, whole.data() + done, whole.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) throw RunError(name_ + ": " + std::strerror(errno));
    done += static_cast<std::size_t>(n);
  }
}

std::size_t replay(const SessionSettings& settings, const std::filesystem::path& log,
                   const std::function<void(const Answer&)>& tell) {
  const auto wrong = [&](std::size_t number, const std::string& got, const std::string& expected) {
    return InputError(
        {.where = "--replay " + log.string() + (number == 0 ? "" : ":" + std::to_string(number)),
         .got = got,
         .expected = expected});
  };
  std::ifstream file(log);
  if (!file) throw wrong(0, "a file that cannot be read", "what --log has written");
  const auto clock = [] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
  };
  std::map<int, std::unique_ptr<Session>> sessions;
  std::size_t number = 0, refused = 0;
  for (std::string line; std::getline(file, line) && !file.eof();) {  // a last one may be torn
    ++number;
    const LogJson entry = LogJson::parse(line, nullptr, false);
    if (!entry.is_object()) throw wrong(number, "another line", "what --log has written");
    if (number == 1) {
      const LogJson own = header_of(settings);
      if (entry.value("asdic_log", LogJson()) != own["asdic_log"])
        throw wrong(1, "another first line", "a log of commands that --log has written");
      for (const char* same : {"scenario", "overrides"})
        if (entry.value(same, LogJson()) != own[same])
          throw wrong(1, std::string("a log of another scenario (") + same + ")",
                      "the scenario and the --set of the server that wrote it");
      continue;
    }
    if (!entry.contains("ok") || !entry.contains("session") || !entry.contains("command") ||
        !entry["ok"].is_boolean() || !entry["session"].is_number_integer())
      throw wrong(number, "another line", "what --log has written");
    if (entry["ok"] == false) continue;
    std::unique_ptr<Session>& session = sessions[entry["session"].get<int>()];
    if (!session) {
      session = std::make_unique<Session>(settings, clock);
      tell(session->greeting());
    }
    Command command;
    try {
      command = read_command(entry["command"].dump(), settings.limits);
    } catch (const Refusal& refusal) {
      throw wrong(number, refusal.what(), "a command that had been carried out");
    }
    command.received = clock();
    if (const auto acts = entry.find("acts"); acts != entry.end() && acts->is_number())
      command.acts = acts->get<double>();
    const Answer answer = session->execute(command);
    if (answer.refused) ++refused;
    tell(answer);
  }
  if (number == 0) throw wrong(0, "an empty file", "what --log has written");
  return refused;
}

}  // namespace asdic::detail::serve
