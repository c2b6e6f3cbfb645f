#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <complex>

#include "io/scenario/scenario_reader.h"
#include "sonar/ping/run_pings.h"
#include "support/serve.h"

// What a session hears: the bits of a continuous record, and what changes of the scenario do to it,
// at which sample.

namespace asdic::detail {
namespace {

using support::Served;
using ::testing::HasSubstr;

constexpr double rate = 200.0;
constexpr std::size_t channels = 2;

/// A session that listens as fast as it can, and all that it was handed out.
class Heard {
 public:
  explicit Heard(const std::string& text = support::served_scenario) : served(text) {
    served.session().state().tell = [this](const serve::Answer& answer) {
      const auto line = nlohmann::json::parse(answer.line);
      if (line.contains("block")) {
        blocks.push_back(line);
        const std::size_t row = answer.samples.size() / channels;
        for (std::size_t c = 0; c < channels; ++c)
          rows[c].insert(rows[c].end(), answer.samples.begin() + std::ptrdiff_t(c * row),
                         answer.samples.begin() + std::ptrdiff_t((c + 1) * row));
      } else {
        told.push_back(line);
      }
    };
  }
  nlohmann::json operator()(const std::string& line) {
    auto said = served(line);
    EXPECT_EQ(said["ok"], true) << line << ": " << said;
    if (served.last.then) served.last.then();
    return said;
  }
  nlohmann::json listen(double seconds, double block = 0.1) {
    return (*this)(R"({"command": "listen", "seconds": )" + std::to_string(seconds) +
                   R"(, "block": )" + std::to_string(block) + "}");
  }

  Served served;
  std::vector<nlohmann::json> blocks, told;
  std::array<std::vector<float>, channels> rows;
};

/// The first sample at which two are not the same, or by more than a share of the loudest number;
/// −1: nowhere.
std::ptrdiff_t first_difference(const std::vector<float>& a, const std::vector<float>& b,
                                float share) {
  EXPECT_EQ(a.size(), b.size());
  float loudest = 0.0F;
  for (const float p : a) loudest = std::max(loudest, std::abs(p));
  for (std::size_t i = 0; i < a.size(); ++i)
    if (std::abs(a[i] - b[i]) > share * loudest) return static_cast<std::ptrdiff_t>(i / 2);
  return -1;
}

std::array<std::vector<float>, channels> rows_of_record(const std::string& text) {
  std::array<std::vector<float>, channels> rows;
  run_pings(PingSimulator(parse_scenario(text, "same.toml")), [&](PingRecord&& record) {
    const std::size_t n = 2 * record.recording.samples;
    for (std::size_t c = 0; c < channels; ++c)
      rows[c].insert(rows[c].end(), record.pressure.begin() + std::ptrdiff_t(c * n),
                     record.pressure.begin() + std::ptrdiff_t((c + 1) * n));
  });
  return rows;
}

/// The served scenario with pings that overlap: every 2 s, received for 5 s.
std::string often(std::string text) {
  const std::string interval = "interval = 10.0";
  text.replace(text.find(interval), interval.size(), "interval = 2.0");
  return text;
}

// The truth: the record of `asdic ping`, whatever the blocks, also through receivers that ring.
TEST(Listening, HasTheBitsOfAContinuousRecord) {
  const std::string plain = often(std::string(support::served_scenario) + "continuous = true\n");
  std::string ringing = plain;
  const std::string array = "spacing = 0.75\n";
  ringing.insert(ringing.find(array) + array.size(),
                 "[array.electronics]\ngain_std_db = 1.0\n[array.electronics.band_pass]\n"
                 "order = 4\nlow = 950.0\nhigh = 1050.0\n");
  const struct {
    const std::string& text;
    double block;
  } cases[] = {{plain, 0.005}, {plain, 0.02}, {plain, 7.7}, {ringing, 0.02}, {ringing, 1.3}};
  for (const auto& [text, block] : cases) {
    const auto record = rows_of_record(text);
    ASSERT_EQ(record[0].size(), 2 * std::size_t(9 * rate));  // 2 + 2 + 5 s
    Heard heard(text);
    heard(R"({"command": "listen", "seconds": 6, "schedule": true, "block": )" +
          std::to_string(block) + "}");
    for (std::size_t c = 0; c < channels; ++c)
      EXPECT_TRUE(std::equal(heard.rows[c].begin(), heard.rows[c].end(), record[c].begin()))
          << block;
    EXPECT_EQ(heard.rows[0].size(), 2 * std::size_t(6 * rate));
    ASSERT_EQ(heard.told.size(), 4U);  // three pings, and that it is over
    EXPECT_EQ(heard.told[1]["ping"], 2);
    EXPECT_EQ(heard.told[1]["time"], 2.0);
    EXPECT_EQ(heard.told[3]["listening"], false);
  }
}

// Pings by command, some of them ahead, are those of the schedule.
TEST(Listening, PingsByCommandAreHeardAsThoseOfTheSchedule) {
  const std::string text = often(std::string(support::served_scenario) + "continuous = true\n");
  const auto record = rows_of_record(text);
  Heard heard(text);
  heard.listen(0.001);  // nothing: it begins
  heard(R"({"command": "ping"})");
  heard(R"({"command": "ping", "time": 2})");
  heard.listen(3.7);
  heard(R"({"command": "ping", "time": 4})");
  heard.listen(5.3);
  for (std::size_t c = 0; c < channels; ++c) EXPECT_EQ(heard.rows[c], record[c]);
}

/// The served scenario with some of its lines replaced.
std::string with(std::vector<std::pair<std::string, std::string>> others) {
  std::string text = support::served_scenario;
  for (const auto& [line, other] : others) {
    const auto at = text.find(line);
    if (at == std::string::npos) throw std::logic_error(line);
    text.replace(at, line.size(), other);
  }
  return text;
}

// Two overlapping pings are received as the sum of their records, each simulated alone.
// Combinations of rough surfaces, wide bands, phones far apart or each with its own paths, several
// arrays, and ways of drawing the sea are tried at rest and under way. The noise is 140 dB below 1
// µPa/√Hz; the tolerance is the rounding of sums of three float32 numbers, 3·2⁻²⁴ of the loudest.
// Streams are left out, because an array in a continuous record may turn, so that they have other
// cells and draws.
TEST(Listening, OverlappingPingsAreTheSumOfTheirRecords) {
  const std::string rough =
                        "kind = \"rigid\"\n[environment.surface]\nkind = \"vacuum\"\n"
                        "roughness = \"wind\"\n",
                    long_line = "spacing = 30.0", wide = "max_surface_bounces = 1\nband = \"wide\"",
                    exact = "max_surface_bounces = 1\nexact_per_phone = true",
                    moving = "position = [0.0, 0.0, 200.0]\nvelocity = [3.0, 2.0, 0.0]\n",
                    profile =
                        "kind = \"table\"\ninterpolation = \"pchip\"\n"
                        "depth = [0, 100, 300, 1000]\nspeed = [1510, 1495, 1498, 1503]",
                    sweep = "kind = \"lfm\"\nstart_frequency = 960.0\nend_frequency = 1040.0",
                    two =
                        "phones = 1\nspacing = 1.0\n[[array]]\nkind = \"positions\"\n"
                        "name = \"stern\"\npositions = [[0.0, -40.0, 3.0]]";
  const auto sea = [](const std::string& how) {
    return "azimuths = 8\nsynthesis = \"" + how + "\"";
  };
  using Changes = std::vector<std::pair<std::string, std::string>>;
  const std::string tone = "kind = \"cw\"\nfrequency = 1000.0",
                    iso = "kind = \"isovelocity\"\nspeed = 1500.0",
                    rest = "position = [0.0, 0.0, 200.0]\n", rigid = "kind = \"rigid\"\n",
                    bounces = "max_surface_bounces = 0", line = "spacing = 0.75",
                    azimuths = "azimuths = 8", array = "[array]",
                    phones = "phones = 2\nspacing = 0.75";
  const Changes products[] = {
      {{rigid, rough}, {bounces, wide}, {tone, sweep}, {iso, profile}, {rest, moving}},
      {{rigid, rough}, {line, long_line}, {bounces, exact}, {azimuths, sea("scatterers")}},
      {{rigid, rough},
       {line, long_line},
       {tone, sweep},
       {rest, moving},
       {azimuths, sea("scatterers")}},
      {{bounces, wide}, {tone, sweep}, {line, long_line}, {azimuths, sea("covariance")}},
      {{rigid, rough},
       {array, "[[array]]\nname = \"bow\""},
       {phones, two},
       {iso, profile},
       {rest, moving}},
      {{array, "[[array]]\nname = \"bow\""}, {phones, two}, {bounces, exact}, {tone, sweep}},
  };
  for (const Changes& product : products) {
    Changes all = product;
    all.push_back({"interval = 10.0", "interval = 2.0"});
    all.push_back({"count = 3", "count = 2"});
    all.push_back({"spectral_level_db = 40.0", "spectral_level_db = -140.0"});
    const std::string text = with(all);
    const auto records = rows_of_record(text);
    Heard heard(text);
    heard.listen(0.001);
    heard(R"({"command": "ping"})");
    heard(R"({"command": "ping", "time": 2})");
    heard.listen(7.0);
    const auto length = std::size_t(2 * 5 * rate), later = std::size_t(2 * 2 * rate);
    for (std::size_t c = 0; c < channels; ++c) {
      ASSERT_EQ(records[c].size(), 2 * length);
      std::vector<float> sum(length + later, 0.0F);
      for (std::size_t i = 0; i < length; ++i) sum[i] += records[c][i];
      for (std::size_t i = 0; i < length; ++i) sum[later + i] += records[c][length + i];
      EXPECT_EQ(first_difference(heard.rows[c], sum, 3.0F / 16777216.0F), -1) << text;
    }
  }
}

// The schedule has its next ping at 10 s: who listens pings when they say so.
TEST(Listening, PingsWithoutATimeLeaveNow) {
  Heard heard;
  heard.listen(1.0);
  EXPECT_EQ(heard(R"({"command": "ping"})")["time"], 1.0);
  heard.listen(2.0);
  EXPECT_EQ(heard(R"({"command": "ping"})")["time"], 3.0);
}

// The rock is 3000 m away: what leaves at 0 strikes it at 2 s, and comes back at 4 s. A change acts
// from its sample on: that of what receives at once, that of what is struck on what was struck by
// then (here to the sample after 2·t), that of the ocean with the next ping.
TEST(Listening, AChangeActsWhereAndWhenItHappens) {
  const auto heard_with = [](const std::string& update) {
    Heard heard;
    heard.listen(0.001);
    heard(R"({"command": "ping"})");
    heard.listen(1.5);
    if (!update.empty()) heard(R"({"command": "update", )" + update + "}");
    heard.listen(5.0);
    heard(R"({"command": "ping"})");
    heard.listen(5.0);
    return heard.rows[1];
  };
  const std::vector<float> plain = heard_with("");
  const auto changed_at = [&](const std::string& update, float share = 0.0F) {
    return static_cast<double>(first_difference(plain, heard_with(update), share)) / rate;
  };
  // A ping's sound is made again from the change on, without what is not heard: other sums.
  constexpr float rounding = 1e-6F;
  EXPECT_EQ(changed_at(R"("seed": 4)"), 1.5);  // noise: at once
  EXPECT_EQ(changed_at(R"("noise": {"spectral_level_db": 41.0})"), 1.5);
  EXPECT_EQ(changed_at(R"("array": {"heading_deg": 80})"), 1.5);
  EXPECT_EQ(changed_at(R"("platform": {"velocity": [0, 2, 0]})"), 1.5);
  EXPECT_EQ(changed_at(R"("wind_speed": 15)", rounding), 3.0);
  const double louder = changed_at(R"("targets": {"strength_db": 43})", 1e-3F);
  EXPECT_GT(louder, 3.95);  // the whole echo; before it, the rounding of a transform
  EXPECT_LT(louder, 4.05);
  EXPECT_GE(changed_at(R"("sound_speed": {"kind": "isovelocity", "speed": 1490})", rounding), 6.5);
}

// An update to the present values changes no bit of the samples (sound computed again would be
// rounded differently), makes no new scenario, and does not count as a change that later ones must
// follow.
TEST(Listening, AnUpdateThatChangesNothingCostsNothing) {
  std::string text = support::served_scenario;
  const std::string place = "position = [0.0, 0.0, 200.0]\n";
  text.insert(text.find(place) + place.size(), "velocity = [0.0, 2.0, 0.0]\n");
  const auto heard_with = [&](const std::vector<std::string>& updates) {
    Heard heard(text);
    heard.listen(0.001);
    heard(R"({"command": "ping"})");
    heard.listen(1.499);
    const std::string key = heard.served.session().state().live.state().key;
    for (const std::string& update : updates) {
      const auto said = heard(R"({"command": "update", )" + update + "}");
      EXPECT_FALSE(said.contains("sea_drawn_anew")) << update;
      EXPECT_EQ(heard.served.session().state().live.state().key, key) << update;
      EXPECT_EQ(heard.served.session().state().live.changed(), -infinity) << update;
      heard.listen(0.25);
    }
    heard.listen(4.0 - 0.25 * double(updates.size()));
    return heard.rows;
  };
  const auto plain = heard_with({});
  const auto updated =
      heard_with({R"("wind_speed": 8)", R"("targets": {"name": "rock", "strength_db": 10})",
                  R"("targets": {"velocity": [0, 0, 0], "position": [3000, 0, 200]}, "seed": 3)",
                  R"("array": {"spacing": 0.75}, "noise": {"spectral_level_db": 40})",
                  R"("platform": {"heading_deg": 360, "speed": 2})",
                  R"("platform": {"position": [0, 5.5, 200]}, "time": 2.75)"});
  for (std::size_t c = 0; c < channels; ++c) EXPECT_EQ(updated[c], plain[c]);
}

// A change that is known beforehand changes nothing before it: not even the rounding of what a
// change before it has made anew, in steps that end after it.
TEST(Listening, AChangeThatIsKnownChangesNothingBefore) {
  const auto heard_until = [](double known) {
    Heard heard;
    heard.listen(0.001);
    heard(R"({"command": "ping"})");
    heard.listen(1.0);
    heard(R"({"command": "update", "time": 1.5, "array": {"heading_deg": 80}})");
    if (known > 1.0) heard.listen(known - 1.0);
    heard(R"({"command": "update", "time": 3.2, "array": {"heading_deg": 70}})");
    heard.listen(5.0 - known);
    return heard.rows;
  };
  const auto late = heard_until(3.0), beforehand = heard_until(1.0);
  for (std::size_t c = 0; c < channels; ++c) EXPECT_EQ(beforehand[c], late[c]);
}

// A target that moves from 1.5 s on at 20 m/s is met at 2 s 10 m farther on, and 6.7 ms later.
TEST(Listening, ATargetIsWhereItIsWhenItIsStruck) {
  std::string text = support::served_scenario;
  const std::string strength = "strength_db = 10.0", sea = "azimuths = 8";
  text.replace(text.find(strength), strength.size(), "strength_db = 50.0");
  text.replace(text.find(sea), sea.size(), "enabled = false");
  const auto echo_time = [&](const std::string& update) {
    Heard heard(text);
    heard.listen(0.001);
    heard(R"({"command": "ping"})");
    heard.listen(1.5);
    if (!update.empty()) heard(update);
    heard.listen(4.0);
    double power = 0.0, moment = 0.0;  // centre of gravity of the echo
    const std::vector<float>& row = heard.rows[0];
    for (std::size_t i = std::size_t(3.8 * rate); i < std::size_t(4.5 * rate); ++i) {
      const double p = std::norm(std::complex<double>(row[2 * i], row[2 * i + 1]));
      power += p;
      moment += p * double(i) / rate;
    }
    return moment / power;
  };
  const double later = echo_time(
      R"({"command": "update", "targets": {"velocity": [20, 0, 0], "fluctuation": "none"}})");
  // Struck at t with 1500 t = 3000 + 20 (t − 1.5), the echo 2t; the pulse is drawn out by 2.7 %.
  const double t = (3000.0 - 30.0) / 1480.0;
  EXPECT_NEAR(later - echo_time(""), 2.0 * t - 4.0 + 0.05 * 0.027, 2e-3);
}

// After a change it is what a session hears that began with the scenario that it led to.
TEST(Listening, AfterAChangeItIsTheScenarioItLedTo) {
  Heard changed;
  changed.listen(0.001);
  changed(R"({"command": "ping"})");
  changed.listen(1.5);
  changed(R"({"command": "update", "array": {"heading_deg": 80}})");
  changed.listen(4.0);
  std::string text = support::served_scenario;
  const std::string spacing = "spacing = 0.75\n";
  text.insert(text.find(spacing), "heading_deg = 80.0\n");
  Heard from_the_start(text);
  from_the_start.listen(0.001);
  from_the_start(R"({"command": "ping"})");
  from_the_start.listen(5.5);
  for (std::size_t c = 0; c < channels; ++c) {
    const auto &a = changed.rows[c], &b = from_the_start.rows[c];
    ASSERT_EQ(a.size(), b.size());
    const auto from = std::ptrdiff_t(2 * 1.5 * rate);
    const std::vector<float> later(a.begin() + from, a.end()), right(b.begin() + from, b.end());
    EXPECT_EQ(first_difference(later, right, 1e-6F), -1);
    EXPECT_FALSE(std::equal(a.begin() + from / 2, a.begin() + from, b.begin() + from / 2));
  }
}

// A track keeps where things were: after a turn on the way they have not always gone there.
TEST(Listening, APlatformKeepsWhereItWas) {
  Heard heard;
  heard.listen(3.0);
  heard(R"({"command": "update", "platform": {"velocity": [0, 10, 0]}})");
  heard.listen(2.0);
  heard(R"({"command": "update", "platform": {"heading_deg": 90}})");
  heard.listen(1.0);
  const auto state = heard(R"({"command": "state"})");
  EXPECT_EQ(state["time"], 6.0);
  EXPECT_NEAR(state["platforms"][0]["position"][0].get<double>(), 10.0, 1e-9);
  EXPECT_NEAR(state["platforms"][0]["position"][1].get<double>(), 20.0, 1e-9);
  const Track& track = heard.served.session().state().live.state().scenario.platforms[0].track;
  EXPECT_NEAR(track.at(4.0).position.y(), 10.0, 1e-9);
  EXPECT_NEAR(track.at(2.0).position.y(), 0.0, 1e-9);
}

// Another course gives the sea other Doppler factors: that is said, while a ping sounds.
TEST(Listening, TellsThatTheSeaIsDrawnAnew) {
  Heard heard;
  heard.listen(0.1);
  const std::string turn = R"({"command": "update", "platform": {"velocity": [0, 2, 0]}})";
  EXPECT_FALSE(heard(turn).contains("sea_drawn_anew"));
  heard(R"({"command": "ping"})");
  heard.listen(0.5);
  EXPECT_FALSE(heard(turn).contains("sea_drawn_anew"));  // it moves like that already
  EXPECT_EQ(
      heard(R"({"command": "update", "platform": {"velocity": [0, 3, 0]}})")["sea_drawn_anew"],
      true);
  EXPECT_FALSE(heard(R"({"command": "update", "wind_speed": 3})").contains("sea_drawn_anew"));
}

TEST(Listening, RefusesWhatIsPast) {
  Heard heard;
  heard.listen(3.0);
  Served& served = heard.served;
  EXPECT_THAT(served.refusal(R"({"command": "ping", "time": 2.5})"),
              HasSubstr("time: found 2.5 s, expected at least 3 s"));
  EXPECT_THAT(served.refusal(R"({"command": "update", "time": 2, "wind_speed": 3})"),
              HasSubstr("time: found 2 s, expected at least 3 s"));
  EXPECT_THAT(served.refusal(R"({"command": "ping", "deliver": "samples"})"),
              HasSubstr("in a session that listens"));
  EXPECT_THAT(served.refusal(R"({"command": "listen"})"), HasSubstr("seconds"));
  EXPECT_THAT(served.refusal(R"({"command": "listen", "seconds": 1, "block": 0})"),
              HasSubstr("block"));
  // A change that cannot be is none.
  EXPECT_THAT(served.refusal(R"({"command": "update", "platform": {"velocity": [90, 0, 0]}})"),
              HasSubstr("scenario"));
  EXPECT_EQ(heard(R"({"command": "state"})")["platforms"][0]["velocity"][0], 0.0);
}

// Whatever goes on for hours takes as much memory as its pings that still sound.
TEST(Listening, ForgetsWhatIsOver) {
  Heard heard(often(support::served_scenario));
  for (int i = 0; i < 40; ++i) {
    heard(R"({"command": "update", "platform": {"velocity": [0, )" + std::to_string(i % 3) +
          ", 0]}}");
    heard(R"({"command": "listen", "seconds": 2, "block": 1, "schedule": true})");
  }
  const auto& scenario = heard.served.session().state().live.state().scenario;
  EXPECT_LT(scenario.platforms[0].track.waypoints.size(), 8U);
}

}  // namespace
}  // namespace asdic::detail
