#include "io/climatology/calendar.h"

#include <gtest/gtest.h>

namespace asdic::detail {
namespace {

std::string at(const char* units, double value, const char* calendar = "") {
  const auto parsed = TimeUnits::parse(units, calendar);
  return parsed ? iso(parsed->at(value)) : "no units";
}

// Day numbers that everybody can look up: the Julian date of 1970-01-01 is 2 440 587.5, that of
// 2000-01-01 noon 2 451 545, that of 1858-11-17 2 400 000.5 (the origin of modified ones).
TEST(Calendar, CountsDays) {
  EXPECT_EQ(days(Calendar::standard, {2000, 1, 1, 43'200.0}), 2'451'545.0 - 2'440'587.5);
  EXPECT_EQ(days(Calendar::standard, {1858, 11, 17}), 2'400'000.5 - 2'440'587.5);
  // The day after 4 October 1582 (Julian) was the 15th (Gregorian).
  EXPECT_EQ(days(Calendar::standard, {1582, 10, 15}) - days(Calendar::standard, {1582, 10, 4}),
            1.0);
  EXPECT_EQ(days(Calendar::proleptic_gregorian, {1582, 10, 15}) -
                days(Calendar::proleptic_gregorian, {1582, 10, 4}),
            11.0);
  EXPECT_EQ(iso(moment_of(Calendar::standard, days(Calendar::standard, {1582, 10, 4}) + 1.0)),
            "1582-10-15");
}

TEST(Calendar, EveryDayThereAndBack) {
  for (const Calendar calendar :
       {Calendar::standard, Calendar::proleptic_gregorian, Calendar::julian, Calendar::no_leap,
        Calendar::all_leap, Calendar::days_360}) {
    Moment before = moment_of(calendar, -150'001.0);
    for (int day = -150'000; day < 30'000; ++day) {
      const Moment moment = moment_of(calendar, day);
      ASSERT_EQ(days(calendar, moment), day) << iso(moment);
      const bool follows = moment.day == before.day + 1 || moment.day == 1 || moment.day == 15;
      ASSERT_TRUE(follows) << iso(before) << " and " << iso(moment);
      before = moment;
    }
  }
}

TEST(Calendar, TimesOfMakers) {
  EXPECT_EQ(at("hours since 2000-01-01 00:00:00", 210'384.0), "2024-01-01");            // HYCOM
  EXPECT_EQ(at("hours since 1900-01-01 00:00:00.0", 1'086'972.0), "2024-01-01T12:00");  // ERA5
  EXPECT_EQ(at("seconds since 1970-01-01 00:00:00", 1'704'067'230.0), "2024-01-01T00:00:30");
  EXPECT_EQ(at("days since 1950-01-01 00:00:00 UTC", 27'028.25), "2024-01-01T06:00");  // Argo
  EXPECT_EQ(at("months since 1955-01-01 00:00:00", 372.5), "1986-01-16T12:00");        // WOA
  EXPECT_EQ(at("months since 1955-01-01 00:00:00", 0.5), "1955-01-16T12:00");
  EXPECT_EQ(at("days since 2001-01-01", 59.0, "360_day"), "2001-02-30");
  EXPECT_EQ(at("days since 2004-02-28", 1.0, "noleap"), "2004-03-01");
  EXPECT_EQ(at("hours since 2000-1-1 0:0:0 +1:00", 1.0), "2000-01-01");
  EXPECT_EQ(at("hour since 0000-01-01 00:00:00", 366.0), "0000-01-16T06:00");  // COADS
}

TEST(Calendar, OthersAreNothing) {
  for (const char* units : {"days", "parsecs since 2000-01-01", "days since now", "days since ",
                            "days since 2001-02-29", "days since 2000-13-01",
                            "hours since 2000-01-01 25:00", "hours since 2000-01-01 noon"})
    EXPECT_EQ(at(units, 0.0), "no units") << units;
  EXPECT_EQ(at("days since 2000-01-01", 0.0, "mayan"), "no units");
  EXPECT_FALSE(parse_moment("2024-06").has_value());
  EXPECT_FALSE(parse_moment("2024-06-31").has_value());
  EXPECT_EQ(parse_moment("2024-06-30T06:30Z"), (Moment{2024, 6, 30, 23'400.0}));
}

}  // namespace
}  // namespace asdic::detail
