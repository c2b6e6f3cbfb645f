// Where an array receives reverberation: about the transmitter or its own middle, whole or in
// groups.
#include "sonar/reverberation/phone_groups.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "sonar/ping/ping.h"
#include "support/reverberant_sea.h"
#include "support/two_platforms.h"

namespace asdic::detail {
namespace {

using support::two_platforms;

constexpr double c = 1500.0;

/// A ship at rest at 100 m, the floor 300 m below her, which alone scatters; her array is `phones`.
Scenario ship(std::vector<Vec3> phones) {
  Scenario s = two_platforms();
  s.environment.bottom.depth = 400.0;
  s.arrays[0].platform = 0;
  s.arrays[0].phones = std::move(phones);
  s.reverberation.enabled = true;
  s.reverberation.surface_scatters = false;
  s.reverberation.bottom = Lambert{};
  s.reverberation.synthesis = ScattererSynthesis::scatterers;
  s.pings.recording_duration = 1.5;
  return s;
}

std::vector<Vec3> line(int phones, double spacing, double first) {
  std::vector<Vec3> places;
  for (int n = 0; n < phones; ++n) places.emplace_back(first + n * spacing, 0.0, 0.0);
  return places;
}

/// A line of 24 phones, 0.75 m apart, 300 m astern of a ship that goes east.
Scenario towed() {
  Scenario s = ship(line(24, 0.75, -317.25));
  TowedLine behind;
  for (int n = 0; n < 24; ++n) behind.behind.push_back(300.0 + 0.75 * n);
  s.arrays[0].towed = behind;
  s.platforms[0].track.start.velocity = {3.0, 0.0, 0.0};
  return s;
}

/// Rms of the difference of two records of a phone over the rms of the second.
double difference(const PingRecord& one, const PingRecord& other, std::size_t phone) {
  const std::size_t n = one.recording.samples;
  double sum = 0.0, power = 0.0;
  for (std::size_t i = phone * n; i < (phone + 1) * n; ++i) {
    sum += std::pow(double(one.pressure[i]) - double(other.pressure[i]), 2);
    power += std::pow(double(other.pressure[i]), 2);
  }
  EXPECT_GT(power, 0.0);
  return std::sqrt(sum / power);
}

Vec3 point_of(const Scenario& s) {
  return PingGeometry(s, {}, 1).reverberation_point(0, 1000.0).at(0.0).position;
}

// Phones 0 to 4 m east of where they are fixed: their middle at 2 m, a quarter of a wavelength is
// 0.375 m.
TEST(ReverberationPoint, IsTheTransmitterAtTheArraysMiddleElseThatMiddle) {
  Scenario s = ship(line(5, 1.0, 0.0));
  const Vec3 here = s.platforms[0].track.start.position;
  for (const double east : {2.0, 1.63, 2.37}) {
    s.transmitters[0].offset = {east, 0.0, 0.0};
    EXPECT_EQ(point_of(s), Vec3(here + s.transmitters[0].offset)) << east;
  }
  for (const double east : {0.0, 1.6, 2.4, 300.0}) {
    s.transmitters[0].offset = {east, 0.0, 0.0};
    EXPECT_LT((point_of(s) - here - Vec3(2, 0, 0)).norm(), 1e-9) << east;
  }
  // On another platform only if both stay.
  s.transmitters[0].offset = {1.8, 0.0, 0.0};
  s.platforms[1] = s.platforms[0];
  s.arrays[0].platform = 1;
  EXPECT_EQ(point_of(s), Vec3(here + Vec3(1.8, 0, 0)));
  s.platforms[1].track.start.velocity.x() = 1.0;
  EXPECT_LT((point_of(s) - here - Vec3(2, 0, 0)).norm(), 1e-9);
  EXPECT_LT((point_of(towed()) - here - Vec3(-308.625, 0, 0)).norm(), 1e-9);
}

/// A guide with many paths, a vertical line of phones 20 m below the source that reaches up to it
/// or not.
Scenario guide_below(double spacing) {
  std::vector<Vec3> phones;
  for (int n = 0; n < 33; ++n) phones.emplace_back(0.0, 0.0, 20.0 + spacing * (n - 16));
  Scenario s = ship(phones);
  s.environment.bottom = {.depth = 200.0, .material = Rigid{}};
  s.propagation.max_surface_bounces = 30;
  s.propagation.max_bottom_bounces = 30;
  s.pings.recording_duration = 4.0;
  return s;
}

// What is expected of the sea does not jump when a line of phones becomes longer than its distance
// to the transmitter: paths and their reciprocals are in phase at the transmitter's own place
// alone, 3 dB above what is received 20 m below.
TEST(ReverberationPoint, TheExpectedLevelDoesNotDependOnTheArraysLength) {
  const auto level = [](const Scenario& s) {
    const support::ReverberantSea sea(s);
    const PingReverberation ping = sea.ping(1);
    double sum = 0.0;
    for (double t = 2.0; t < 3.9; t += 0.05) sum += power_from_db(ping.expected_db(t));
    return db_from_power(sum);
  };
  const double within = level(guide_below(1.3)), beyond = level(guide_below(1.2));
  EXPECT_NEAR(within, beyond, 0.3);
}

// Wherever phones are seen from, they are in one place.
TEST(PhonesFrom, GiveTheirPlacesSeenFromAnyPoint) {
  for (Scenario s : {ship(line(5, 1.0, 0.0)), towed()}) {
    s.transmitters[0].offset = {3.0, -2.0, 5.0};
    const ArrayMotion motion(s, 0);
    const auto places = [&](const Carried& point) {
      std::vector<Vec3> found = motion.phones_from(point, 1, 7.0);
      for (Vec3& x : found) x += point.at(7.0).position;
      return found;
    };
    const std::vector<Vec3> about = places(motion.reference());
    for (const Carried& point :
         {sender_of(s, 0), motion.middle_of(1, {1, 2}), motion.phone(1, 4)}) {
      const std::vector<Vec3> found = places(point);
      ASSERT_EQ(found.size(), about.size());
      for (std::size_t n = 0; n < found.size(); ++n)
        EXPECT_LT((found[n] - about[n]).norm(), 1e-9) << n;
    }
    EXPECT_LT(motion.phones_from(motion.phone(1, 4), 1, 7.0)[4].norm(), 1e-9);
  }
}

// The transmitter a millionth less than a quarter of a wavelength from the array's middle, and
// more: received about the transmitter, by the same paths out and back, and about the middle, by
// pairs of paths. Both are plane waves to 2π times the error that is told, r.m.s. less, of what
// each phone receives from where it is.
TEST(ReverberationPoint, TheSoundGoesSmoothlyFromOneToTheOther) {
  Scenario s = ship(line(4, 1.0, -1.5));
  const auto record = [&](double east, bool exact) {
    s.transmitters[0].offset = {east, 0.0, 0.0};
    s.propagation.exact_per_phone = exact;
    return PingSimulator(s).sound(1);
  };
  constexpr double border = 0.375;
  const PingRecord within = record(border * (1.0 - 1e-6), false),
                   beyond = record(border * (1.0 + 1e-6), false), exact = record(border, true);
  EXPECT_EQ(within.plane_waves.groups, 1);
  EXPECT_EQ(exact.plane_waves.groups, 4);
  // 1.875²/(2·300·1.5) and 1.5²/(2·300·1.5) wavelengths: 0.025 and 0.016 rad at the ends.
  EXPECT_NEAR(within.plane_waves.error, 3.52 / 900.0, 0.15 * 3.52 / 900.0);
  EXPECT_NEAR(beyond.plane_waves.error, 2.25 / 900.0, 0.15 * 2.25 / 900.0);
  // Amplitudes are those of the point: 1/r and the square root of Lambert's sine there, at most
  // 1.5|x|/r, 0.0094 and 0.0075.
  for (std::size_t phone = 0; phone < 4; ++phone) {
    EXPECT_LT(difference(within, exact, phone), 0.025 + 0.0094) << phone;
    EXPECT_LT(difference(beyond, exact, phone), 0.016 + 0.0075) << phone;
    EXPECT_LT(difference(within, beyond, phone), 0.041 + 0.0094) << phone;
  }
}

// The floor is 300 m below and the ping 0.2 s long. At 0.2 s sound has travelled 300 m, which is
// just the distance to a line 300 m away. After a pulse of 2 s the ellipse reaches further than the
// floor is deep. The beginning of the record does not matter.
TEST(NearestReverberation, IsTheSheetsHeightOrTheEllipsesEnd) {
  Scenario s = ship(line(5, 1.0, 0.0));
  const PingGeometry geometry(s, {}, 1);
  EXPECT_DOUBLE_EQ(nearest_reverberation(geometry, 0, 0.2, 1000.0).length, 300.0);
  EXPECT_DOUBLE_EQ(nearest_reverberation(geometry, 0, 2.0, 1000.0).length,
                   1499.0);  // 2 m to the middle
  s.pings.recording_start = 2.0;
  EXPECT_DOUBLE_EQ(nearest_reverberation(geometry, 0, 0.2, 1000.0).length, 300.0);
  s.reverberation.surface_scatters = true;
  EXPECT_DOUBLE_EQ(nearest_reverberation(geometry, 0, 0.1, 1000.0).length, 100.0);
  s.reverberation.enabled = false;
  EXPECT_EQ(nearest_reverberation(geometry, 0, 0.2, 1000.0).length, infinity);
}

// Halves, until the front of a point at that distance is a plane wave to a sixteenth of a period in
// each: by the distances themselves, out of many directions.
TEST(PhoneGroups, AreSmallEnoughForPlaneWaves) {
  const Scenario s = towed();
  const ArrayMotion motion(s, 0);
  const Listening here{.scenario = s, .motion = motion};
  const Front front{.length = 60.0, .highest_frequency = 1000.0};
  const PhoneGroups groups = phone_groups(here, front, infinity);
  EXPECT_GT(groups.parts.size(), 2U);
  EXPECT_LE(groups.error, reverberation_periods);
  std::size_t next = 0;
  double worst = 0.0;
  for (const PhoneRange& part : groups.parts) {
    EXPECT_EQ(part.first, next);
    next += part.count;
    const std::vector<Vec3> phones = motion.phones_from(motion.middle_of(1, part), 1, 0.0);
    for (std::size_t n = part.first; n < next; ++n)
      for (int degree = 0; degree < 360; degree += 5) {
        const Vec3 look(std::cos(radians(degree)), 0.0, std::sin(radians(degree)));
        const double late = (60.0 * look - phones[n]).norm() - (60.0 - look.dot(phones[n]));
        worst = std::max(worst, std::abs(late) * 1000.0 / c);
      }
  }
  EXPECT_EQ(next, 24U);
  EXPECT_LE(worst, 1.001 * groups.error);
  EXPECT_GT(worst, 0.9 * groups.error);
  // As many as are allowed, and what that costs; every phone; one phone.
  const PhoneGroups two = phone_groups(here, front, 2.0);
  EXPECT_LE(two.parts.size(), 2U);
  EXPECT_GT(two.error, reverberation_periods);
  EXPECT_EQ(phone_groups(here, front, infinity, 0.0).parts.size(), 24U);
  EXPECT_EQ(phone_groups(here, front, infinity, 0.0).error, 0.0);
  const Scenario alone = ship({Vec3::Zero()});
  const ArrayMotion of_one(alone, 0);
  EXPECT_EQ(phone_groups({.scenario = alone, .motion = of_one}, front, infinity).parts.size(), 1U);
}

// A line so far astern, in a sea that is received one scatterer after the other, receives them in
// groups by itself: as exactly every phone for itself does, to 2π/16 at the worst phone and less in
// the mean. As one plane wave it is told by how much it is off, and is.
TEST(TowedReverberation, IsReceivedInGroupsAsEveryPhoneReceivesIt) {
  Scenario s = towed();
  s.environment.bottom.depth = 140.0;
  const PingRecord record = PingSimulator(s).sound(1);
  EXPECT_GT(record.plane_waves.groups, 1);
  EXPECT_LT(record.plane_waves.groups, 24);
  EXPECT_LE(record.plane_waves.error, reverberation_periods);
  s.propagation.exact_per_phone = true;
  const PingRecord exact = PingSimulator(s).sound(1);
  s.propagation.exact_per_phone = false;
  s.reverberation.most_returns = 1;  // sectors stand for all
  const PingRecord together = PingSimulator(s).sound(1);
  EXPECT_EQ(together.plane_waves.groups, 1);
  EXPECT_GT(together.plane_waves.error, reverberation_periods);
  for (const std::size_t phone : {0U, 6U, 11U, 17U, 23U})
    EXPECT_LT(difference(record, exact, phone), 0.2) << phone;
}

// A line that turns is received as it lies when sound comes, not when it is sent.
TEST(TowedReverberation, TurnsWithTheLine) {
  Scenario s = towed();
  s.arrays[0].towed = TowedLine{.behind = {20.0, 60.0, 100.0}};
  s.arrays[0].phones.resize(3);
  s.platforms[0].track.waypoints = {
      {-60.0, {0, -600, 100}}, {0.0, {0, 0, 100}}, {60.0, {600, 0, 100}}};
  const PingRecord record = PingSimulator(s).sound(1);
  EXPECT_EQ(record.plane_waves.groups, 3);
  s.propagation.exact_per_phone = true;
  EXPECT_EQ(PingSimulator(s).sound(1).pressure, record.pressure);
}

}  // namespace
}  // namespace asdic::detail
