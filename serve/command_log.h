#pragma once
#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <string>

namespace asdic::detail::serve {

struct Answer;
struct Command;
struct SessionSettings;

/// The commands that a server has carried out, a line of JSON each (docs/formats/serve.md), in a
/// file that nobody had before. Each line is there before its answer goes out.
class CommandLog {
 public:
  /// Writes what is served into the first line. \throws InputError{where: "--log"} if the file is
  /// there, RunError if it cannot be made
  CommandLog(const std::filesystem::path& file, const SessionSettings& settings);
  ~CommandLog();
  CommandLog(const CommandLog&) = delete;
  CommandLog& operator=(const CommandLog&) = delete;

  [[nodiscard]] int new_session();
  /// \param acts  time of the scenario at which it acted, by the clock [s]
  /// \param begun, done  and `command.received` since the session's `start` [s]
  /// \throws RunError if it cannot be written
  void write(int session, const Command& command, const std::optional<double>& acts, double start,
             double begun, double done, bool ok);

 private:
  void append(const std::string& line);

  std::mutex mutex_;
  std::string name_;
  int file_ = -1, sessions_ = 0;
};

/// Carries out again what a log holds, session by session in its order; what had been refused is
/// left out. \param tell  gets what the clients got
/// \return commands that were refused this time
/// \throws InputError{where: "--replay"} if it is none, or one of another scenario
std::size_t replay(const SessionSettings& settings, const std::filesystem::path& log,
                   const std::function<void(const Answer&)>& tell);

}  // namespace asdic::detail::serve
