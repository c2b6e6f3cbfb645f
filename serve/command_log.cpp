#include "serve/command_log.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/text.h"
#include "serve/session_state.h"

namespace asdic::detail::serve {
namespace {

using LogJson = nlohmann::ordered_json;

std::string as_line(const LogJson& json) {
  return json.dump(-1, ' ', false, LogJson::error_handler_t::replace);
}

}  // namespace

std::string CommandLog::first_line(const SessionSettings& settings) {
  return as_line({{"asdic_log", 1},
                  {"version", settings.provenance.program_version},
                  {"pace", name_of(settings.pace)},
                  {"overrides", settings.scenario.overrides},
                  {"scenario", settings.scenario.text}});
}

CommandLog::CommandLog(const std::filesystem::path& file, const SessionSettings& settings)
    : name_(file.string()) {
  file_ = ::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_APPEND | O_CLOEXEC, 0600);
  if (file_ < 0 && errno == EEXIST)
    throw InputError({.where = "--log",
                      .got = in_quotes(name_) + ", which is there",
                      .expected = "a new file: none is written over"});
  if (file_ < 0) throw RunError(name_ + ": " + std::strerror(errno));
  append(first_line(settings));
}

CommandLog::~CommandLog() { ::close(file_); }

int CommandLog::new_session() {
  const std::lock_guard lock(mutex_);
  return ++sessions_;
}

void CommandLog::write(int session, const Command& command, const CarriedOut& how, bool ok) {
  LogJson line{{"session", session},
               {"received", command.received - how.start},
               {"begun", how.begun - how.start},
               {"done", how.done - how.start}};
  if (how.acts) line["acts"] = *how.acts;
  if (how.heard) line["heard"] = *how.heard;
  line["ok"] = ok;
  line["command"] = LogJson::parse(command.line);
  const std::lock_guard lock(mutex_);
  append(as_line(line));
}

void CommandLog::scheduled(int session, std::int64_t heard, int ping) {
  const std::lock_guard lock(mutex_);
  append(as_line({{"session", session}, {"heard", heard}, {"scheduled", ping}}));
}

void CommandLog::ended(int session, std::int64_t heard) {
  const std::lock_guard lock(mutex_);
  append(as_line({{"session", session}, {"heard", heard}, {"listening", false}}));
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

}  // namespace asdic::detail::serve
