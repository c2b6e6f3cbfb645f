#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "core/error.h"
#include "io/scenario/catalogue.h"
#include "io/text/toml_writer.h"
#include "serve/caps.h"
#include "serve/client_key.h"
#include "serve/client_names.h"
#include "serve/command_queue.h"
#include "serve/data_folder.h"
#include "serve/latency.h"
#include "serve/live_scenario.h"
#include "serve/outbox.h"
#include "serve/output_quota.h"
#include "serve/pace.h"
#include "serve/ping_schedule.h"
#include "serve/token.h"
#include "serve/unix_socket.h"
#include "support/temporary_directory.h"

// The parts of a server by themselves.

namespace asdic::detail::serve {
namespace {

namespace fs = std::filesystem;

class DataFolderRule : public ::testing::Test {
 protected:
  void SetUp() override {
    fs::create_directories(outside / "data/casts");
    fs::create_directories(outside / "data2");
    static_cast<void>(outside.write("data/casts/may.csv", "depth,speed\n0,1500\n"));
    static_cast<void>(outside.write("secret.csv", "SECRET"));
    static_cast<void>(outside.write("data2/secret.csv", "SECRET"));
    fs::create_symlink("may.csv", outside / "data/casts/inside.csv");
    fs::create_symlink(outside / "secret.csv", outside / "data/link.csv");
    fs::create_directory_symlink(outside.path(), outside / "data/up");
    fs::create_symlink("loop.csv", outside / "data/loop.csv");
  }
  std::string refusal(const std::string& name) {
    try {
      return DataFolder(outside / "data").file(name, "sound_speed.file", 1000).string();
    } catch (const Refusal& refused) {
      return refused.code() + ": " + refused.what();
    }
  }
  support::TemporaryDirectory outside;
};

TEST_F(DataFolderRule, FilesInsideAreFound) {
  const fs::path may = fs::canonical(outside / "data/casts/may.csv");
  EXPECT_EQ(refusal("casts/may.csv"), may.string());
  EXPECT_EQ(refusal("casts/inside.csv"), may.string());  // a link that stays inside
}

// Missing files and files elsewhere are refused in the same words: nothing is learnt of them.
TEST_F(DataFolderRule, NothingElseIs) {
  for (const std::string name :
       {"", ".", "casts", "../secret.csv", "casts/../../secret.csv", "casts/../casts/may.csv",
        "/etc/passwd", "link.csv", "up/secret.csv", "up/data2/secret.csv", "../data2/secret.csv",
        "missing.csv", "loop.csv", "casts/may.csv/x"})
    EXPECT_EQ(refusal(name),
              "file: sound_speed.file: found no such file, expected the name of a file inside the "
              "server's data "
              "directory")
        << name;
  EXPECT_EQ(refusal((outside / "data/casts/may.csv").string()).substr(0, 5), "file:");
  EXPECT_EQ(refusal(std::string("casts/may.csv\0.png", 18)).substr(0, 5), "file:");
}

TEST_F(DataFolderRule, LargeFilesAreNot) {
  static_cast<void>(outside.write("data/large.csv", std::string(1001, '1')));
  EXPECT_EQ(refusal("large.csv"),
            "limit: sound_speed.file: found a larger file, expected at most 1000 bytes");
}

TEST_F(DataFolderRule, WithoutAFolderThereAreNone) {
  EXPECT_THROW(static_cast<void>(DataFolder().file("may.csv", "f", 1000)), Refusal);
  EXPECT_THROW(DataFolder(outside / "missing"), InputError);
}

TEST(InlineToml, ReadsBackAsItWas) {
  const TomlValue made = parse_toml(R"(
a = -0.0
b = 1e22
c = 0.1
d = true
e = [[1, 2.5], []]
f = { name = "a\"b\\\u0007\nß" }
)",
                                    "made");
  TomlValue read = parse_toml("", "empty");
  apply_override(read, "all=" + inline_toml(made));
  EXPECT_EQ(inline_toml(*read.find("all")), inline_toml(made));
  EXPECT_TRUE(std::signbit(std::get<double>(read.find("all")->find("a")->data)));
  EXPECT_EQ(std::get<std::string>(read.find("all")->find("f")->find("name")->data), "a\"b\\\a\nß");
}

// A name cannot end the string that it stands in, and begin a key of its own.
TEST(InlineToml, NamesStayNames) {
  TomlValue table{.data = TomlValue::Table{}, .origin = ""};
  set_key(table, "name", {.data = std::string("x\"}\nseed = 5 #"), .origin = ""});
  TomlValue read = parse_toml("", "empty");
  apply_override(read, "t=" + inline_toml(table));
  EXPECT_EQ(read.find("seed"), nullptr);
  EXPECT_EQ(std::get<std::string>(read.find("t")->find("name")->data), "x\"}\nseed = 5 #");
}

TEST(LatencyLog, RanksTheLatestThousand) {
  LatencyLog log;
  EXPECT_EQ(log.percentile(0.5), 0.0);
  log.add(3.0);
  EXPECT_EQ(log.percentile(0.99), 3.0);
  for (int i = 1; i <= 1000; ++i) log.add(double(i));
  EXPECT_EQ(log.count(), 1001U);
  EXPECT_EQ(log.percentile(0.5), 500.0);
  EXPECT_EQ(log.percentile(0.99), 990.0);
  EXPECT_EQ(log.longest(), 1000.0);
}

TEST(Pace, IsRealFastOrAFactor) {
  EXPECT_EQ(parse_pace("real").factor, 1.0);
  EXPECT_FALSE(parse_pace("fast").by_the_clock());
  EXPECT_EQ(parse_pace("60").factor, 60.0);
  EXPECT_EQ(name_of(parse_pace("0.5")), "0.5");
  for (const std::string wrong : {"", "0", "-1", "nan", "inf", "1e7", "10x", "slow"})
    EXPECT_THROW(static_cast<void>(parse_pace(wrong)), InputError) << wrong;
}

TEST(Limits, AreSetByName) {
  SessionLimits limits;
  set_limit(limits, "samples=1000");
  EXPECT_EQ(limits.samples, 1000U);
  for (const std::string wrong : {"samples", "samples=", "samples=0", "samples=-1", "samples=1.5",
                                  "sample=5", "=5", "samples=99999999999999999999"})
    EXPECT_THROW(set_limit(limits, wrong), InputError) << wrong;
}

TEST(Token, OnlyTheSameIsTheSame) {
  EXPECT_TRUE(same_secret("abc", "abc"));
  for (const std::string other : {"", "ab", "abd", "abcd", "abcabc", "Abc"})
    EXPECT_FALSE(same_secret(other, "abc")) << other;
  EXPECT_FALSE(same_secret("", ""));  // no token is none
  EXPECT_EQ(new_token().size(), 64U);
  EXPECT_NE(new_token(), new_token());
}

TEST(Token, ItsFileIsForItsOwner) {
  const support::TemporaryDirectory folder;
  const fs::path file = folder.write("token", "0123456789abcdef\n");
  fs::permissions(file, fs::perms::owner_read | fs::perms::owner_write);
  EXPECT_EQ(read_token(file), "0123456789abcdef");
  fs::permissions(file, fs::perms::group_read, fs::perm_options::add);
  EXPECT_THROW(static_cast<void>(read_token(file)), InputError);
  const fs::path brief = folder.write("brief", "short\n");
  fs::permissions(brief, fs::perms::owner_read);
  EXPECT_THROW(static_cast<void>(read_token(brief)), InputError);
  EXPECT_THROW(static_cast<void>(read_token(folder / "missing")), InputError);
}

TEST(CommandQueue, HasRoomForSoMany) {
  CommandQueue queue(2);
  EXPECT_TRUE(queue.push({.id = "1"}));
  EXPECT_FALSE(queue.full());
  EXPECT_TRUE(queue.push({.id = "2"}));
  EXPECT_TRUE(queue.full());
  EXPECT_FALSE(queue.push({.id = "3"}));
  EXPECT_EQ(queue.pop()->id, "1");
  EXPECT_TRUE(queue.push({.id = "4"}));
  queue.close();
  EXPECT_FALSE(queue.push({.id = "5"}));
  EXPECT_EQ(queue.pop()->id, "2");
  EXPECT_EQ(queue.pop()->id, "4");
  EXPECT_FALSE(queue.pop());
}

// The schedule that goes on for ever begins with that of a run, bit for bit.
TEST(PingSchedule, AreThoseOfARun) {
  Scenario scenario;
  scenario.transmitters.resize(2);
  scenario.transmitters[0].elevations = {0.1, 0.2, 0.3};
  scenario.transmitters[1].first_ping_time = 0.7;
  scenario.transmitters[1].interval = 0.3;
  scenario.pings.count = 40;
  scenario.pings.interval = 0.1;
  const std::vector<Transmission> run = transmissions(scenario);
  PingSchedule schedule(scenario);
  std::vector<int> left{40, 40};
  for (const Transmission& wanted : run) {
    const Transmission next = schedule.next(scenario, wanted.transmitter);
    EXPECT_EQ(next.time, wanted.time);
    EXPECT_EQ(next.own_ping, wanted.own_ping);
    EXPECT_EQ(next.elevation, wanted.elevation);
    if (left[0] > 0 && left[1] > 0) {  // then a run has ended for one, while ours goes on
      EXPECT_EQ(schedule.next(scenario).transmitter, wanted.transmitter);
    }
    --left[std::size_t(wanted.transmitter)];
    schedule.sent(next, false);
  }
}

TEST(PingSchedule, FollowAPingAtAnotherTime) {
  Scenario scenario;
  scenario.pings.interval = 10.0;
  PingSchedule schedule(scenario);
  Transmission first = schedule.next(scenario);
  first.time = 33.0;
  schedule.sent(first, true);
  EXPECT_EQ(schedule.next(scenario).time, 43.0);
  EXPECT_EQ(schedule.next(scenario).own_ping, 2);
}

TEST(UnixSocket, TakesOnlyWhatIsFreeOrLeftBehind) {
  const support::TemporaryDirectory folder;
  EXPECT_NO_THROW(make_room_for_socket(folder / "free"));
  EXPECT_THROW(make_room_for_socket(folder.write("file", "kept")), InputError);
  EXPECT_TRUE(fs::exists(folder / "file"));
  fs::create_symlink(folder / "file", folder / "link");
  EXPECT_THROW(make_room_for_socket(folder / "link"), InputError);
  EXPECT_THROW(make_room_for_socket(folder.path()), InputError);
  EXPECT_THROW(make_room_for_socket(folder / std::string(200, 'x')), InputError);

  const auto bound = [&](const std::string& name) {
    sockaddr_un address{.sun_family = AF_UNIX, .sun_path = {}};
    (folder / name).string().copy(address.sun_path, sizeof address.sun_path - 1);
    const int s = ::socket(AF_UNIX, SOCK_STREAM, 0);
    EXPECT_EQ(::bind(s, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    return s;
  };
  ::close(bound("stale"));
  EXPECT_NO_THROW(make_room_for_socket(folder / "stale"));
  EXPECT_FALSE(fs::exists(folder / "stale"));

  const int served = bound("served");
  ::listen(served, 1);
  EXPECT_THROW(make_room_for_socket(folder / "served"), InputError);
  { const SocketName name(folder / "served"); }
  EXPECT_FALSE(fs::exists(folder / "served"));
  ::close(served);
}

// Another server's socket of the same name stays.
TEST(UnixSocket, RemovesItsOwnNameAlone) {
  const support::TemporaryDirectory folder;
  {
    static_cast<void>(folder.write("name", "not a socket"));
    const SocketName name(folder / "name");
  }
  EXPECT_TRUE(fs::exists(folder / "name"));
}

// What a file says does not reach a client; which key is at fault, and what it should be, does; and
// what the client itself said.
TEST(RefusalOf, SaysTheKeyAndWhatIsExpected) {
  const std::string own = "found what the scenario has, expected X";
  const std::string file =
      "found other contents, expected a file that holds what docs/formats/scenario.md says";
  const struct {
    std::string where, message;
  } cases[] = {
      {"secret/deep.toml:12: target.0.position", "targets.0.position: " + own},
      {"--set platform: platform.waypoints[1].time",
       "platform.waypoints[1].time: found 3, expected X"},
      {"--set noise", "noise: " + own},
      {"pings.sample_rate", "pings.sample_rate: " + own},
      {"/secret/cast.csv:3", "a file: " + file},
      {"/secret/cast.csv", "a file: " + file},
      {"cast.csv", "a file: " + file},
      {"cast.csv:3: speed", "a file: " + file},
      {"secret/other.toml:3: environment.depth", "a file: " + file},
      {"/secret/may.csv:3: speed", "sound_speed.file: " + file},
  };
  const TomlValue fields = parse_toml(
      "platform = { waypoints = [{}, { time = 3 }] }\nsound_speed = { file = \"casts/may.csv\" }",
      "command");
  for (const auto& one : cases) {
    const bool said = one.message.find("found 3") != std::string::npos;
    const Refusal refusal =
        refusal_of(InputError({.where = one.where, .got = said ? "3" : "SECRET", .expected = "X"}),
                   "secret/deep.toml", fields, {});
    EXPECT_EQ(refusal.what(), one.message);
    EXPECT_EQ(refusal.code(), "scenario");
  }
}

// A platform that is moved takes along what it carries: the client said where to, not the offset.
TEST(RefusalOf, NamesThePlatformThatWasMoved) {
  const InputError fault({.where = "secret/deep.toml:12: transmitter.offset",
                          .got = "depth 4150 m at 0 s",
                          .expected = "a depth between the surface (0 m) and the bottom (3200 m)"});
  const TomlValue moved = parse_toml("platform = { position = [0, 0, 4000] }", "command");
  EXPECT_STREQ(refusal_of(fault, "secret/deep.toml", moved, {}).what(),
               "platform.position: found a place that puts transmitter.offset outside the water, "
               "expected a depth between the surface (0 m) and the bottom (3200 m) for that");
  const TomlValue other = parse_toml("wind_speed = 3", "command");
  EXPECT_STREQ(refusal_of(fault, "secret/deep.toml", other, {}).what(),
               "transmitter.offset: found what the scenario has, expected a depth between the "
               "surface (0 m) and the bottom (3200 m)");
}

// What may change is what is described so, and all of that has a name in commands.
TEST(ClientNames, AreOfWhatIsLive) {
  const auto dotted = [](std::string path) {
    for (auto at = path.find("[]"); at != std::string::npos; at = path.find("[]"))
      path.erase(at, 2);
    return path;
  };
  std::vector<std::string> live;
  for (const SettingRecord& one : scenario::catalogue().settings)
    if (one.live) live.push_back(dotted(one.path));
  for (const TableRecord& one : scenario::catalogue().tables)
    if (one.live) live.push_back(dotted(one.path));
  const auto is_within = [](const std::string& path, std::string_view section) {
    return path == section || path.starts_with(std::string(section) + ".");
  };
  for (const std::string& path : live)
    EXPECT_TRUE(std::any_of(client_names().begin(), client_names().end(),
                            [&](const auto& one) { return is_within(path, one.section); }))
        << path << " has no name in commands";
  for (const ClientName& one : client_names())
    EXPECT_TRUE(std::any_of(live.begin(), live.end(),
                            [&](const auto& path) { return is_within(path, one.section); }))
        << one.section << " is not live";
}

// A setting becomes one of commands by a word of its description: serve/ knows none of these.
TEST(ClientNames, FollowFromAWordOfTheDescription) {
  const auto live_setting = [](const char* path) {
    SettingRecord made;
    made.path = path;
    made.live = true;
    return made;
  };
  SettingsList list;
  for (const char* path : {"propagation.tide", "pings.recording_gain", "environment.ice",
                           "transmitter[].duty", "target[].colour", "buoy[].position"})
    list.settings.push_back(live_setting(path));
  list.settings.push_back({.path = "environment.snow"});  // is not live
  list.tables.push_back({.path = "propagation.current", .help = "", .live = true});
  std::vector<std::string> names;
  for (const ClientName& one : client_names_of(list))
    names.push_back(one.section + " " + one.name + (one.of_a_ping ? " of a ping" : "") +
                    (one.is_list ? " list" : "") + (one.is_table ? " table" : ""));
  EXPECT_THAT(names,
              testing::ElementsAre("target targets list", "environment.ice ice",
                                   "pings.recording_gain recording.gain",
                                   "transmitter.duty duty of a ping", "propagation.tide tide",
                                   "buoy buoy list", "propagation.current current table"));
}

TEST(ClientNames, AreInTheManual) {
  std::ifstream page(std::string(ASDIC_SCENARIOS) + "/../docs/formats/serve.md");
  std::ostringstream text;
  text << page.rdbuf();
  for (const ClientName& one : client_names())
    EXPECT_THAT(text.str(), testing::ContainsRegex("`" + one.head() + "[`.[]")) << one.section;
}

TEST(ClientNames, HaveTheKeysAndBoundsOfTheScenario) {
  EXPECT_THAT(live_keys("array"),
              testing::UnorderedElementsAre("spacing", "heading_deg", "pitch_deg", "positions",
                                            "behind", "offset"));
  EXPECT_THAT(live_keys("pings"), testing::ElementsAre("recording_duration", "recording_start"));
  EXPECT_EQ(update_keys(),
            "platform, array, targets, wind_speed, sound_speed, noise, seed or recording");
  const SettingsList update = update_settings();
  const auto wind = std::find_if(update.settings.begin(), update.settings.end(),
                                 [](const auto& one) { return one.path == "wind_speed"; });
  ASSERT_NE(wind, update.settings.end());
  EXPECT_EQ(domain_of(*wind), "0 to 60 m/s");
}

// Keys of a scenario as commands have them.
TEST(ClientKeys, AreThoseOfTheCommand) {
  const TomlValue fields = parse_toml(R"(
      waveform = { kind = "cw" }
      sound_speed = { depth = [0, 10] }
      recording = { duration = 3 }
      targets = [{ name = "a", strength_db = 3 }, { name = "c", position = [1, 2, 3] }]
      )",
                                      "command");
  const TomlValue document = parse_toml(
      "target = [{ name = 'a' }, { name = 'b' }, { name = 'c' }]\n[platform]\n", "scenario");
  const struct {
    std::string scenario, command;
    bool given, under;
  } cases[] = {
      {"pulse.kind", "waveform.kind", true, true},
      {"transmitter[0].pulse.frequency", "waveform.frequency", false, true},
      {"environment.sound_speed.depth[1]", "sound_speed.depth[1]", true, true},
      {"pings.recording_duration", "recording.duration", true, true},
      {"pings.recording_start", "recording.start", false, false},
      {"target[0].strength_db", "targets[0].strength_db", true, true},
      {"target[1].strength_db", "targets.strength_db", false, false},
      {"target[2].position[2]", "targets[1].position[2]", true, true},
      {"platform.velocity", "platform.velocity", false, false},
      {"pings.baseband_rate", "pings.baseband_rate", false, false},
      {"seeds", "seeds", false, false},
      {"", "", false, false},
      {"target[", "targets[", true, true},
  };
  for (const auto& one : cases) {
    const ClientKey key = client_key(one.scenario, fields, document);
    EXPECT_EQ(key.name, one.command);
    EXPECT_EQ(key.given, one.given) << one.scenario;
    EXPECT_EQ(key.under, one.under) << one.scenario;
  }
}

// Answers go out as their lines and their samples, whatever the reader takes at a time, and samples
// lie where they were made: no second copy waits for a slow reader.
TEST(Outbox, GivesLinesAndSamplesByteByByte) {
  std::vector<float> samples{1.5F, -2.25F, 3e8F};
  std::string expected = "{}\n";
  expected.append(reinterpret_cast<const char*>(samples.data()), 3 * sizeof(float));
  expected += "last\n";
  for (const std::size_t step : {1U, 2U, 5U, 100U}) {
    std::atomic<std::size_t> all = 0;
    Outbox out(all);
    Answer first{.line = "{}", .samples = samples}, last{.line = "last"};
    const float* const where = first.samples.data();
    out.expect(first);
    out.expect(last);
    EXPECT_EQ(out.bytes(), expected.size());
    out.add(std::move(first));
    out.add(std::move(last));
    EXPECT_EQ(out.bytes(), expected.size());
    std::string taken;
    std::size_t answers = 0;
    while (!out.empty()) {
      if (taken.size() == 3) {
        EXPECT_EQ(static_cast<const void*>(out.front().data()), where);
      }
      const std::string piece(out.front().substr(0, step));
      ASSERT_FALSE(piece.empty());
      taken += piece;
      if (out.wrote(piece.size())) ++answers;
    }
    EXPECT_EQ(taken, expected);
    EXPECT_EQ(answers, 2U);
    EXPECT_EQ(out.bytes(), 0U);
    EXPECT_EQ(all, 0U);
  }
}

// 100 bytes here and 150 in all. A lone answer may be longer; what was reserved becomes an answer.
TEST(Outbox, HasRoomHereAndInAll) {
  using Room = Outbox::Room;
  std::atomic<std::size_t> all = 0;
  {
    Outbox one(all), other(all);
    EXPECT_EQ(one.reserve(300, 100, 150), Room::here);
    EXPECT_EQ(one.reserve(1, 100, 150), Room::not_yet);
    EXPECT_EQ(other.reserve(1, 100, 150), Room::taken_by_others);
    one.release(300);
    EXPECT_EQ(one.reserve(60, 100, 150), Room::here);
    EXPECT_EQ(one.reserve(41, 100, 150), Room::not_yet);
    EXPECT_EQ(other.reserve(90, 100, 150), Room::here);
    EXPECT_EQ(one.reserve(1, 100, 150), Room::taken_by_others);
    EXPECT_EQ(all, 150U);
    Answer answer{.line = "{}", .samples = std::vector<float>(15)};
    one.expect(answer);
    one.release(60);
    EXPECT_EQ(one.bytes(), 63U);
    EXPECT_EQ(all, 153U);
    one.add(std::move(answer));
    one.clear();
    EXPECT_EQ(all, 90U);
  }
  EXPECT_EQ(all, 0U);  // what a connection leaves behind goes with it
}

TEST(OutputQuota, CountsWhatIsKept) {
  const support::TemporaryDirectory folder;
  OutputQuota quota;
  const auto write = [&](const char* name, std::size_t expected, std::size_t bytes, bool keep) {
    CountedFile file(quota, 1000, (folder / name).string(), expected);
    EXPECT_GE(quota.written(), expected);
    std::ofstream(folder / name) << std::string(bytes, 'x');
    if (keep) file.keep();
  };
  write("one", 500, 400, true);
  EXPECT_EQ(quota.written(), 400U);
  EXPECT_THROW(write("two", 601, 1, true), Refusal);
  EXPECT_FALSE(std::filesystem::exists(folder / "two"));
  write("two", 600, 1, false);
  EXPECT_FALSE(std::filesystem::exists(folder / "two"));
  EXPECT_THROW(write("two", 600, 601, true), Refusal);
  EXPECT_FALSE(std::filesystem::exists(folder / "two"));
  EXPECT_EQ(quota.written(), 400U);
  write("two", 600, 600, true);
  EXPECT_EQ(quota.written(), 1000U);
}

}  // namespace
}  // namespace asdic::detail::serve
