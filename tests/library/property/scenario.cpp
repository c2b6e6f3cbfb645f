// Scenarios that were built in C++ are the same when they are read out of the file that they were
// written to: every number by its bits, every text by its letters, every word of validate().
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <bit>
#include <cmath>

#include "asdic/asdic.h"
#include "support/temporary_directory.h"

namespace {

using asdic::Value;
using asdic::detail::support::TemporaryDirectory;

/// A number with all its bits, between two ends.
double between(double low, double high) {
  const double share = static_cast<double>(*rc::gen::arbitrary<std::uint64_t>() >> 11) * 0x1p-53;
  return std::clamp(low + (high - low) * share, low, high);
}
bool perhaps() { return *rc::gen::arbitrary<bool>(); }
int whole(int low, int high) { return *rc::gen::inRange(low, high + 1); }
template <class T>
T one_of(std::initializer_list<T> all) {
  return *(all.begin() + whole(0, static_cast<int>(all.size()) - 1));
}

/// Letters of one to four bytes, and what TOML escapes.
std::string any_text() {
  std::string text;
  for (int n = whole(0, 8); n > 0; --n)
    text += one_of({"a", "Z", " ", "\"", "\\", "\n", "\t", "\x01", "#", "=", ".", "é", "€", "𝄞"});
  return text;
}

asdic::Vector any_place() { return {between(-2e3, 2e3), between(-2e3, 2e3), between(20.0, 900.0)}; }

std::vector<double> axis(int count, double low, double high) {
  std::vector<double> values;
  for (int i = 0; i < count; ++i)
    values.push_back(low + (high - low) * (i + between(0.1, 0.9)) / count);
  return values;
}

Value any_pulse() {
  const double f = between(300.0, 1500.0), duration = between(0.05, 0.3);
  const std::string window = one_of<std::string>({"none", "hann", "tukey"});
  const auto tapers =
      window == "tukey" && perhaps() ? std::optional(between(0.1, 0.9)) : std::optional<double>();
  if (perhaps()) return asdic::Cw{f, duration, window, tapers};
  if (perhaps()) return asdic::Lfm{f, f + between(-200.0, 200.0), duration, window, tapers};
  return asdic::Hfm{f, f + between(50.0, 200.0), duration, window, tapers};
}

Value any_water() {
  const int n = whole(2, 30);
  asdic::SoundSpeed water{.depth = axis(n, 0.0, 1000.0), .speed = {}};
  for (int i = 0; i < n; ++i) water.speed.push_back(between(1480.0, 1520.0));
  if (perhaps()) return asdic::Munk{.axis_depth = between(300.0, 900.0)};
  return water;
}

Value any_target() {
  asdic::Target target{.name = any_text()};
  if (perhaps()) {
    target.range = between(500.0, 3000.0);
    target.bearing_deg = between(-360.0, 360.0);
    target.depth = between(20.0, 900.0);
  } else {
    target.position = any_place();
  }
  if (perhaps()) target.velocity = {between(-5.0, 5.0), between(-5.0, 5.0), -0.0};
  if (perhaps()) {
    target.aspect = asdic::Aspect{between(0.0, 9.0), between(5.0, 20.0), between(0.0, 9.0)};
    target.heading_deg = between(0.0, 360.0);
  } else {
    target.strength_db = between(-20.0, 30.0);
  }
  return target;
}

/// One in ten has a fault.
asdic::Scenario any_scenario() {
  asdic::Scenario sea;
  sea.set("title", any_text())
      .set("seed", *rc::gen::inRange<std::int64_t>(0, std::int64_t{1} << 62))
      .set("environment.sound_speed", any_water())
      .set("environment.bottom", asdic::Bottom{.depth = 1000.0, .kind = "rigid"})
      .set("platform.position", any_place())
      .set("transmitter",
           asdic::Transmitter{.source_level_db = between(150.0, 230.0), .taper = "omnidirectional"})
      .set("pulse", any_pulse())
      .set("array", asdic::LineArray{.name = any_text(),
                                     .phones = whole(1, 4),
                                     .spacing = between(0.1, 1.0),
                                     .heading_deg = between(-180.0, 180.0)})
      .set("reverberation.enabled", false)
      .set("propagation.max_surface_bounces", whole(0, 2))
      .set("propagation.max_bottom_bounces", whole(0, 2))
      .set("pings.recording_duration", between(2.0, 6.0))
      .set("pings.sample_rate", 8000.0);
  for (int n = whole(0, 3); n > 0; --n) sea.add("target", any_target());
  if (perhaps()) sea.set("environment.wind_speed", between(0.0, 15.0));
  if (whole(1, 10) == 1) sea.set("pulse.duration", -between(0.0, 1.0));
  return sea;
}

/// The same, number by number: one that is whole may be read as an integer.
bool same(const Value& a, const Value& b) {
  using Kind = Value::Kind;
  const auto is_number = [](const Value& v) {
    return v.kind() == Kind::whole || v.kind() == Kind::number;
  };
  if (is_number(a) && is_number(b))
    return std::bit_cast<std::uint64_t>(a.number()) == std::bit_cast<std::uint64_t>(b.number());
  if (a.kind() != b.kind()) return false;
  if (a.kind() == Kind::text) return a.text() == b.text();
  if (a.kind() == Kind::flag) return a.flag() == b.flag();
  if (a.size() != b.size()) return false;
  if (a.kind() == Kind::list) {
    for (std::size_t i = 0; i < a.size(); ++i)
      if (!same(a.at(i), b.at(i))) return false;
    return true;
  }
  for (const std::string& key : a.keys())
    if (!b.has(key) || !same(a.at(key), b.at(key))) return false;
  return true;
}

/// What validate() says, warnings or a fault.
std::vector<std::string> said_of(const asdic::Scenario& sea) {
  try {
    return sea.validate();
  } catch (const asdic::InputError& error) {
    return {error.key(), error.found(), error.expected()};
  }
}

RC_GTEST_PROP(BuiltScenario, IsTheSameOutOfItsFile, ()) {
  const asdic::Scenario built = any_scenario();
  const TemporaryDirectory folder;
  const auto path = folder.write("sea.toml", built.to_toml());
  const asdic::Scenario read = asdic::Scenario::read(path);
  RC_ASSERT(read.to_toml() == built.to_toml());
  for (const char* part : {"title", "seed", "environment", "platform", "transmitter", "pulse",
                           "array", "reverberation", "propagation", "pings"})
    RC_ASSERT(same(built.get(part), read.get(part)));
  RC_ASSERT(built.has("target") == read.has("target"));
  if (built.has("target")) RC_ASSERT(same(built.get("target"), read.get("target")));
  RC_ASSERT(said_of(built) == said_of(read));
  // Changed and put back, it is written anew from what was read.
  asdic::Scenario again = read;
  again.set("seed", 1).set("seed", read.get("seed"));
  RC_ASSERT(said_of(asdic::Scenario::parse(again.to_toml())) == said_of(built));
}

}  // namespace
