#include <gtest/gtest.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <chrono>
#include <map>
#include <memory>
#include <thread>
#include <vector>

#include "serve/server.h"
#include "support/serve.h"

// Connections in one process, so that sanitizers see them: many clients, deaf ones, an end in the
// middle of it all. What a client sees in full: tests/serve/validation/serve.py.

namespace asdic::detail {
namespace {

using nlohmann::json;

/// A client of a Unix socket.
class Client {
 public:
  explicit Client(const std::filesystem::path& path) : end_(::socket(AF_UNIX, SOCK_STREAM, 0)) {
    sockaddr_un address{.sun_family = AF_UNIX, .sun_path = {}};
    path.string().copy(address.sun_path, sizeof address.sun_path - 1);
    if (::connect(end_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
      throw std::runtime_error("cannot connect");
  }
  ~Client() {
    if (end_ >= 0) ::close(end_);
  }
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  void say(const std::string& line) const {
    const std::string bytes = line + "\n";
    (void)::send(end_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
  }
  void finish() const { ::shutdown(end_, SHUT_WR); }
  void hang_up() {
    ::close(end_);
    end_ = -1;
  }

  /// The next line; null at the end.
  json receive() {
    for (;;) {
      const auto end = received_.find('\n');
      if (end != std::string::npos) {
        json line = json::parse(received_.substr(0, end));
        received_.erase(0, end + 1);
        return line;
      }
      std::array<char, 4096> piece{};
      const ssize_t n = ::recv(end_, piece.data(), piece.size(), 0);
      if (n <= 0) return nullptr;
      received_.append(piece.data(), std::size_t(n));
    }
  }
  json ask(const std::string& line) {
    say(line);
    return receive();
  }

 private:
  int end_;
  std::string received_;
};

/// A server in a thread of its own.
class Running {
 public:
  explicit Running(const std::vector<std::string>& limits = {}, serve::Pace pace = {},
                   const std::vector<std::string>& overrides = {})
      : server_(settings(limits, pace, overrides),
                {.socket = folder_ / "s", .port = {}, .token = ""}),
        thread_([this](const std::stop_token& stop) { server_.run(stop); }) {}

  [[nodiscard]] std::filesystem::path socket() const { return folder_ / "s"; }
  void stop() {
    thread_.request_stop();
    thread_.join();
  }

 private:
  static serve::SessionSettings settings(const std::vector<std::string>& limits, serve::Pace pace,
                                         const std::vector<std::string>& overrides) {
    signal(SIGPIPE, SIG_IGN);  // as the program does
    serve::SessionSettings all;
    all.scenario = {.text = support::served_scenario, .path = "sea.toml", .overrides = overrides};
    all.pace = pace;
    for (const std::string& one : limits) serve::set_limit(all.limits, one);
    return all;
  }

  support::TemporaryDirectory folder_;
  serve::Server server_;
  std::jthread thread_;
};

/// Makes of a ping one that takes minutes: a million scatterers, one by one.
const std::vector<std::string> heavy = {
    "reverberation.azimuths=3600", "reverberation.synthesis=\"scatterers\"",
    "propagation.max_surface_bounces=6", "propagation.max_bottom_bounces=6", "array.phones=64"};

double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

constexpr const char* hello = R"({"asdic": 1})";

TEST(Server, AnswersAndEnds) {
  Running running;
  {
    Client client(running.socket());
    EXPECT_EQ(client.ask(hello)["ok"], true);
    EXPECT_EQ(client.ask(R"({"id": 1, "command": "ping"})")["ping"], 1);
    EXPECT_EQ(client.ask(R"({"id": 2, "command": "quit"})")["pings"], 1);
    EXPECT_EQ(client.receive(), nullptr);
  }
  running.stop();
}

// The data are there before the echo would be: its target is 3 km away, 4 s there and back, at rest
// and, as nothing of its paths is known then, on the move.
TEST(Server, IsSoonerThanTheEcho) {
  Running running;
  Client client(running.socket());
  EXPECT_EQ(client.ask(hello)["ok"], true);
  ASSERT_EQ(client.ask(R"({"command": "update", "targets": {"velocity": [1, 0, 0]}})")["ok"], true);
  for (int i = 0; i < 20; ++i) {
    const json said = client.ask(R"({"command": "ping"})");
    ASSERT_EQ(said["ok"], true) << said;
    EXPECT_GT(said["latency"].get<double>(), 0.0);
    EXPECT_LT(said["latency"].get<double>(), said["first_echo"].get<double>());
  }
  const json state = client.ask(R"({"command": "state"})");
  EXPECT_LT(state["latency"]["p99"].get<double>(), 4.0) << state;
}

// What was sent before the client's last byte is still carried out.
TEST(Server, AClientMayHangUpItsHalf) {
  Running running;
  Client client(running.socket());
  client.say(hello);
  for (int i = 1; i <= 3; ++i) client.say(R"({"command": "ping"})");
  client.finish();
  EXPECT_EQ(client.receive()["asdic"], 1);
  for (int i = 1; i <= 3; ++i) EXPECT_EQ(client.receive()["ping"], i);
  EXPECT_EQ(client.receive(), nullptr);
}

TEST(Server, SaysBusyInsteadOfGrowing) {
  Running running({"queued_pings=2"});
  Client client(running.socket());
  EXPECT_EQ(client.ask(hello)["ok"], true);
  std::string all;
  for (int i = 0; i < 50; ++i) all += R"({"command": "ping"})" + std::string("\n");
  client.say(all + R"({"command": "x"})");  // in one piece: quicker than any ping
  int done = 0, busy = 0;
  for (int i = 0; i < 51; ++i) {
    const json said = client.receive();
    ++(said["ok"] == true ? done : busy);
    if (said["ok"] == false && said["error"]["code"] != "command") {
      EXPECT_EQ(said["error"]["code"], "busy");
    }
  }
  EXPECT_GE(done, 2);
  EXPECT_GE(busy, 10);
}

// Lines that are refused at once, between those that wait for room: each answer goes out once and
// whole, whoever writes first.
TEST(Server, AnswersDoNotGetMixed) {
  Running running({"queued_pings=1"});
  Client client(running.socket());
  constexpr int rounds = 6000;
  std::jthread talks([&] {
    client.say(R"({"asdic": 1, "when_full": "wait"})");
    constexpr const char* commands[] = {"state", "none", "limits"};
    for (int i = 0; i < rounds; ++i)
      client.say(R"({"id": )" + std::to_string(i) + R"(, "command": ")" + commands[i % 3] + "\"}");
    client.finish();
  });
  EXPECT_EQ(client.receive()["asdic"], 1);
  std::vector<int> answers(rounds);
  for (;;) {
    const json line = client.receive();  // throws where a line is torn
    if (line.is_null()) break;
    ++answers.at(line["id"].get<std::size_t>());
  }
  EXPECT_EQ(answers, std::vector<int>(rounds, 1));
}

// One that does not read: its commands wait, others are served; the server ends in time.
TEST(Server, ADeafClientHoldsUpNobody) {
  Running running({"answer_bytes=100000"});
  Client deaf(running.socket());
  deaf.say(R"({"asdic": 1, "when_full": "wait"})");
  for (int i = 0; i < 60; ++i) deaf.say(R"({"command": "ping", "deliver": "samples"})");
  for (int i = 0; i < 3; ++i) {
    Client other(running.socket());
    EXPECT_EQ(other.ask(hello)["ok"], true);
    EXPECT_EQ(other.ask(R"({"command": "ping"})")["ok"], true);
  }
}

TEST(Server, OneThatIsSilentIsClosed) {
  Running running({"idle_seconds=1", "handshake_seconds=1"});
  Client silent(running.socket()), idle(running.socket());
  EXPECT_EQ(idle.ask(hello)["ok"], true);
  EXPECT_EQ(silent.receive()["error"]["code"], "handshake");
  EXPECT_EQ(silent.receive(), nullptr);
  EXPECT_EQ(idle.receive()["error"]["code"], "idle");
  EXPECT_EQ(idle.receive(), nullptr);
}

// A ping that waits for its time does not hold up the end.
TEST(Server, AnEndDoesNotWaitForTheClock) {
  Running running({}, {.factor = 1.0});
  Client client(running.socket());
  EXPECT_EQ(client.ask(hello)["ok"], true);
  client.say(R"({"id": 1, "command": "ping", "time": 300})");
  client.say(R"({"id": 2, "command": "ping"})");
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  const auto begin = std::chrono::steady_clock::now();
  running.stop();
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(30));
  for (int id = 1; id <= 2; ++id) {
    const json said = client.receive();
    EXPECT_EQ(said["id"], id);
    EXPECT_EQ(said["error"]["code"], "closing");
  }
}

// The one in hand and those that wait, by their ids, or all; the session goes on as if they had
// never been: the next ping is the first, with its bits.
TEST(Server, CommandsCanBeCancelled) {
  Running running({}, {}, heavy);
  Client client(running.socket());
  EXPECT_EQ(client.ask(hello)["ok"], true);
  client.say(R"({"id": 1, "command": "ping"})");
  client.say(R"({"id": "two", "command": "ping"})");
  client.say(R"({"id": 3, "command": "ping"})");
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  EXPECT_EQ(client.ask(R"({"id": 4, "command": "cancel", "of": "other"})")["cancelled"], 0);
  const auto begin = std::chrono::steady_clock::now();
  std::map<std::string, json> said;
  const auto receive = [&] {
    const json line = client.receive();
    said[line["id"].dump()] = line;
  };
  client.say(R"({"id": 5, "command": "cancel", "of": "two"})");
  for (int i = 0; i < 2; ++i) receive();
  EXPECT_EQ(said["5"]["cancelled"], 1);
  EXPECT_EQ(said["\"two\""]["error"]["code"], "cancelled");
  client.say(R"({"id": 6, "command": "cancel", "of": 1})");
  for (int i = 0; i < 2; ++i) receive();
  EXPECT_EQ(said["6"]["cancelled"], 1);
  EXPECT_EQ(said["1"]["error"]["code"], "cancelled");
  client.say(R"({"id": 7, "command": "cancel"})");
  for (int i = 0; i < 2; ++i) receive();
  EXPECT_EQ(said["3"]["error"]["code"], "cancelled");
  EXPECT_LT(seconds_since(begin), 10.0);
  EXPECT_EQ(client.ask(R"({"id": 8, "command": "cancel", "off": 3})")["error"]["code"], "value");
  EXPECT_EQ(client.ask(R"({"id": 9, "command": "cancel", "of": [3]})")["error"]["code"], "value");
  EXPECT_EQ(client.ask(R"({"command": "state"})")["next_ping"], 1);
}

// So can one that waits for its time.
TEST(Server, AWaitCanBeCancelled) {
  Running running({}, {.factor = 1.0});
  Client client(running.socket());
  EXPECT_EQ(client.ask(hello)["ok"], true);
  client.say(R"({"id": 1, "command": "ping", "time": 300})");
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  const json one = client.ask(R"({"id": 2, "command": "cancel", "of": 1})");
  const json other = client.receive();
  EXPECT_EQ((one["id"] == 1 ? one : other)["error"]["code"], "cancelled");
  EXPECT_EQ(client.ask(R"({"command": "ping"})")["ping"], 1);
}

TEST(Server, ACommandHasItsTime) {
  Running running({"command_seconds=1"}, {}, heavy);
  Client client(running.socket());
  EXPECT_EQ(client.ask(hello)["ok"], true);
  const auto begin = std::chrono::steady_clock::now();
  const json said = client.ask(R"({"command": "ping"})");
  EXPECT_EQ(said["error"]["code"], "limit");
  EXPECT_EQ(said["error"]["message"].get<std::string>().substr(0, 15), "command_seconds");
  EXPECT_LT(seconds_since(begin), 10.0);
  EXPECT_EQ(client.ask(R"({"command": "state"})")["next_ping"], 1);
}

TEST(Server, AClientHasItsTime) {
  Running running({"client_seconds=1"}, {}, heavy);
  Client client(running.socket());
  EXPECT_EQ(client.ask(hello)["ok"], true);
  for (int i = 0; i < 2; ++i) {
    const json said = client.ask(R"({"command": "ping"})");
    EXPECT_EQ(said["error"]["code"], "limit");
    EXPECT_NE(said["error"]["message"].get<std::string>().find("client_seconds"),
              std::string::npos);
  }
  EXPECT_EQ(client.ask(R"({"command": "state"})")["ok"], true);
}

// One that is gone does not compute on; and another's state needs no turn.
TEST(Server, OneThatIsGoneIsCalledOff) {
  Running running({}, {}, heavy);
  Client gone(running.socket()), other(running.socket());
  EXPECT_EQ(gone.ask(hello)["ok"], true);
  EXPECT_EQ(other.ask(hello)["ok"], true);
  gone.say(R"({"command": "ping"})");
  gone.say(R"({"command": "ping"})");
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  EXPECT_EQ(other.ask(R"({"command": "state"})")["ok"], true);
  gone.hang_up();
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_EQ(other.ask(R"({"command": "update", "reverberation": 1})")["error"]["code"], "value");
  EXPECT_LT(seconds_since(begin), 10.0);
}

TEST(Server, TurnsAwayOneTooMany) {
  Running running({"connections=2"});
  Client one(running.socket()), two(running.socket());
  EXPECT_EQ(one.ask(hello)["ok"], true);
  EXPECT_EQ(two.ask(hello)["ok"], true);
  Client three(running.socket());
  EXPECT_EQ(three.receive()["error"]["code"], "limit");
  EXPECT_EQ(three.receive(), nullptr);
  EXPECT_EQ(one.ask(R"({"command": "state"})")["ok"], true);
}

// Connections that say nothing take no place of those that say the handshake: of very many the
// oldest give way. Places are counted by handshakes.
TEST(Server, GuestsKeepNobodyOut) {
  Running running({"connections=2"});
  Client late(running.socket());
  std::vector<std::unique_ptr<Client>> silent;
  for (int i = 0; i < 40; ++i) silent.push_back(std::make_unique<Client>(running.socket()));
  EXPECT_EQ(late.receive(), nullptr);  // it was the oldest
  EXPECT_EQ(silent.front()->receive(), nullptr);
  Client one(running.socket());
  EXPECT_EQ(one.ask(hello)["ok"], true);
  EXPECT_EQ(silent.back()->ask(hello)["ok"], true);
  EXPECT_EQ(silent[30]->ask(hello)["error"]["code"], "limit");
  EXPECT_EQ(silent[30]->receive(), nullptr);
  EXPECT_EQ(one.ask(R"({"command": "ping"})")["ok"], true);
}

}  // namespace
}  // namespace asdic::detail
