#include <fmt/format.h>
#include <signal.h>
#include <tbb/global_control.h>
#include <tbb/info.h>

#include <cstdlib>
#include <memory>
#include <optional>

#include "app/command.h"
#include "app/console.h"
#include "app/interrupt.h"
#include "core/error.h"
#include "io/ping/provenance.h"
#include "io/text/csv_table.h"
#include "raytrace/parallel/progress.h"
#include "serve/command_log.h"
#include "serve/replay.h"
#include "serve/server.h"
#include "serve/stream/ring_outlet.h"
#include "serve/stream/udp_outlet.h"
#include "serve/token.h"

namespace asdic::detail::app {
namespace {

struct ServeOptions {
  ScenarioChoice scenario;
  std::string socket, data_dir, output_dir, token_file, udp, udp_interface, ring, pace = "fast";
  std::string log, replay;
  double ring_size = 16.0;  // [MB]
  bool tells_scenario = false;
  std::optional<std::uint16_t> port;
  std::optional<int> threads;
  std::vector<std::string> limits;
};

/// The log: a line each on standard error.
void report(const std::string& text) {
  std::fputs(("asdic serve: " + text + '\n').c_str(), stderr);
}

/// Out of a file, of the environment, or a new one, which is told.
std::string token_for(const ServeOptions& options) {
  if (!options.token_file.empty()) return serve::read_token(options.token_file);
  if (const char* given = std::getenv("ASDIC_TOKEN")) {
    serve::check_token(given, "ASDIC_TOKEN");
    return given;
  }
  std::string token = serve::new_token();
  report("token " + token);
  return token;
}

serve::SessionSettings settings_of(const ServeOptions& options, int threads) {
  serve::SessionSettings settings;
  settings.scenario = {.text = read_text_file(options.scenario.path, "a scenario file"),
                       .path = options.scenario.path,
                       .overrides = options.scenario.overrides};
  if (!options.data_dir.empty()) settings.data = serve::DataFolder(options.data_dir);
  if (!options.output_dir.empty()) {
    std::error_code error;
    if (!std::filesystem::is_directory(options.output_dir, error))
      throw InputError({.where = "--output-dir",
                        .got = '"' + options.output_dir + '"',
                        .expected = "a directory that exists"});
    settings.output = std::filesystem::absolute(options.output_dir);
  }
  for (const std::string& one : options.limits) serve::set_limit(settings.limits, one);
  settings.pace = serve::parse_pace(options.pace);
  settings.provenance = provenance(threads);
  settings.report = report;
  settings.tells_scenario = options.tells_scenario;
  if (!options.log.empty())
    settings.log = std::make_shared<serve::CommandLog>(options.log, settings);
  if (!options.udp.empty()) {
    settings.udp = std::make_shared<serve::UdpOutlet>(options.udp, options.udp_interface, report);
    report("\"deliver\": \"udp\" goes to " + options.udp);
  } else if (!options.udp_interface.empty()) {
    throw UsageError("--udp-interface is for --udp; see asdic serve --help");
  }
  if (!options.ring.empty()) {
    constexpr std::size_t megabyte = 1'000'000;
    settings.ring = std::make_shared<serve::RingOutlet>(
        options.ring, static_cast<std::size_t>(options.ring_size * megabyte));
    report("\"deliver\": \"ring\" goes to " + options.ring);
  }
  return settings;
}

/// Answers on standard output, as a client would have had them.
int replay(const serve::SessionSettings& settings, const ServeOptions& options) {
  if (settings.pace.by_the_clock() || !options.socket.empty() || options.port)
    throw InputError({.where = "--replay",
                      .got = "--pace, --socket or --tcp",
                      .expected = "none of them: a log is carried out at once"});
  std::size_t refused = 0;
  try {
    until_interrupted([&] {
      refused = serve::replay(settings, options.replay, [](const serve::Answer& answer) {
        write_output(answer.line + '\n');
        write_output({reinterpret_cast<const char*>(answer.samples.data()),
                      answer.samples.size() * sizeof(float)});
      });
    });
  } catch (const Interrupted&) {
    throw RunError("interrupted");
  }
  if (refused > 0)
    throw RunError(std::to_string(refused) + " commands were refused that had been carried out");
  return 0;
}

int serve_scenario(const ServeOptions& options) {
  signal(SIGPIPE, SIG_IGN);  // a client that has gone is a failed write
  const int threads = options.threads.value_or(tbb::info::default_concurrency());
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  static_cast<std::size_t>(threads));
  serve::SessionSettings settings = settings_of(options, threads);
  if (!options.replay.empty()) return replay(settings, options);
  const StopOnInterrupt interrupt;
  serve::Server server(std::move(settings),
                       {.socket = options.socket,
                        .port = options.port,
                        .token = options.port ? token_for(options) : std::string()});
  server.run(interrupt.token());
  return 0;
}

}  // namespace

void add_serve_command(Program& program) {
  program.add_command(
      "serve", "Ping on command: a line of JSON each, by standard input, a Unix socket or TCP.",
      [](const Command& command) {
        auto options = std::make_shared<ServeOptions>();
        add_scenario_options(command, options->scenario);
        command
            .add_option("--socket", options->socket,
                        "Unix socket to listen on, for this user alone")
            .type_name("PATH");
        command
            .add_option(
                "--tcp", options->port,
                "port of 127.0.0.1 to listen on, 0 for a free one; clients need a token, which "
                "is in --token-file, in the variable ASDIC_TOKEN, or made and printed")
            .type_name("PORT")
            .check(whole_number(0, 65535, "a port"));
        command
            .add_option("--token-file", options->token_file, "file whose first line is the token")
            .type_name("FILE");
        command
            .add_option("--pace", options->pace,
                        "real: pings by the clock; a number: so many times as fast; fast: at once")
            .type_name("real|fast|FACTOR")
            .show_default();
        command.add_option("--output-dir", options->output_dir, "folder for the files of pings")
            .type_name("DIR");
        command
            .add_option(
                "--udp", options->udp,
                "where blocks go with \"deliver\": \"udp\" of listen: a host or a multicast "
                "group (docs/formats/stream.md)")
            .type_name("HOST:PORT");
        command
            .add_option("--udp-interface", options->udp_interface,
                        "address of the interface that multicast leaves by; default: the system's "
                        "choice")
            .type_name("ADDRESS");
        command
            .add_option("--ring", options->ring,
                        "where blocks go with \"deliver\": \"ring\": a file that programs of this "
                        "user map, as /dev/shm/asdic (docs/formats/stream.md)")
            .type_name("PATH");
        command.add_option("--ring-size", options->ring_size, "of that file, in megabytes")
            .type_name("MB")
            .check(between(0.1, 1e5))
            .show_default();
        command
            .add_option("--data-dir", options->data_dir,
                        "folder of files that commands may name; without it they may name none")
            .type_name("DIR");
        command
            .add_option("--limit", options->limits,
                        "what a client may ask for, e.g. samples=100000; may be repeated "
                        "(docs/formats/serve.md)")
            .type_name("NAME=VALUE")
            .one_at_a_time();
        command
            .add_option("--log", options->log,
                        "new file for the commands that are carried out, with their times "
                        "(docs/formats/serve.md)")
            .type_name("FILE");
        command
            .add_option("--replay", options->replay,
                        "carry out what --log has written once more, with the same bits, and print "
                        "the answers")
            .type_name("FILE");
        command.add_flag("--tell-scenario", options->tells_scenario,
                         "let clients have the scenario as text (the command save)");
        add_threads_option(command, options->threads);
        command.footer(
            "Ctrl-C finishes the ping in hand, or leaves it after a second; a second one ends at "
            "once.\n"
            "Example:  asdic serve scenarios/deep_ocean.toml --socket sonar.sock --output-dir "
            "pings");
        command.runs([options] { return serve_scenario(*options); });
      });
}

}  // namespace asdic::detail::app
