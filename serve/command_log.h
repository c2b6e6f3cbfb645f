#pragma once
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>

namespace asdic::detail::serve {

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
  /// How a command was carried out.
  struct CarriedOut {
    double start = 0.0, begun = 0.0, done = 0.0;  ///< of the session, and of it, on the clock [s]
    std::optional<double> acts;                   ///< by the clock: its time of the scenario [s]
    std::optional<std::int64_t> heard;            ///< sample up to which the session had been heard
  };
  /// \throws RunError if it cannot be written
  void write(int session, const Command& command, const CarriedOut& how, bool ok);
  /// A ping of the schedule was sent. \throws RunError
  void scheduled(int session, std::int64_t heard, int ping);
  /// Somebody had listened, and the session was not heard any further. \throws RunError
  void ended(int session, std::int64_t heard);

  /// Says what is served.
  [[nodiscard]] static std::string first_line(const SessionSettings& settings);

 private:
  void append(const std::string& line);

  std::mutex mutex_;
  std::string name_;
  int file_ = -1, sessions_ = 0;
};

}  // namespace asdic::detail::serve
