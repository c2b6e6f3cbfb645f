#include "io/climatology/calendar.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <vector>

#include "io/climatology/words.h"

namespace asdic::detail {
namespace {

using climatology::lower;

constexpr std::array<int, 12> month_days{31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};

long floor_div(long a, long b) { return a / b - (a % b < 0 ? 1 : 0); }

bool before_reform(int year, int month, int day) {
  if (year != 1582) return year < 1582;
  return month < 10 || (month == 10 && day < 15);
}

/// Which rule of leap years holds then.
Calendar rule(Calendar calendar, int year, int month, int day) {
  if (calendar != Calendar::standard) return calendar;
  return before_reform(year, month, day) ? Calendar::julian : Calendar::proleptic_gregorian;
}

/// Days from 1 March of year 0 with years that begin in March, so that a leap day is the last one:
/// the months before one are (153·m + 2)/5 days long. Julian: a leap day every 4 years. Gregorian:
/// less one a century, more one in four of them.
long leap_day_number(bool gregorian, long year, int month, int day) {
  if (month <= 2) --year;
  const long in_year = (153 * (month + (month > 2 ? -3 : 9)) + 2) / 5 + day - 1;
  long number = 365 * year + floor_div(year, 4) + in_year;
  if (gregorian) number += floor_div(year, 400) - floor_div(year, 100);
  return number;
}

/// 1 March of year 0 (Gregorian) is 719 468 days before 1970; the Julian one is two days earlier.
long day_number(Calendar calendar, int year, int month, int day) {
  switch (rule(calendar, year, month, day)) {
    case Calendar::days_360:
      return 360L * (year - 1970) + 30L * (month - 1) + day - 1;
    case Calendar::no_leap:
    case Calendar::all_leap: {
      long number = (calendar == Calendar::no_leap ? 365L : 366L) * (year - 1970) + day - 1;
      for (int m = 1; m < month; ++m) number += days_in_month(calendar, year, m);
      return number;
    }
    case Calendar::julian:
      return leap_day_number(false, year, month, day) - 719'470;
    case Calendar::standard:
    case Calendar::proleptic_gregorian:
      break;
  }
  return leap_day_number(true, year, month, day) - 719'468;
}

}  // namespace

std::optional<Calendar> calendar_of(std::string_view name) noexcept {
  const std::string word = lower(name);
  if (word.empty() || word == "standard" || word == "gregorian") return Calendar::standard;
  if (word == "proleptic_gregorian") return Calendar::proleptic_gregorian;
  if (word == "julian") return Calendar::julian;
  if (word == "noleap" || word == "365_day") return Calendar::no_leap;
  if (word == "all_leap" || word == "366_day") return Calendar::all_leap;
  if (word == "360_day") return Calendar::days_360;
  return std::nullopt;
}

int days_in_month(Calendar calendar, int year, int month) noexcept {
  if (calendar == Calendar::days_360) return 30;
  const int days = month_days[static_cast<std::size_t>(month - 1)];
  if (month != 2) return days;
  switch (rule(calendar, year, month, 1)) {
    case Calendar::no_leap:
      return 28;
    case Calendar::all_leap:
      return 29;
    case Calendar::julian:
      return year % 4 == 0 ? 29 : 28;
    default:
      return year % 4 == 0 && (year % 100 != 0 || year % 400 == 0) ? 29 : 28;
  }
}

double days(Calendar calendar, const Moment& moment) noexcept {
  return static_cast<double>(day_number(calendar, moment.year, moment.month, moment.day)) +
         moment.second / 86'400.0;
}

Moment moment_of(Calendar calendar, double days) noexcept {
  const double milliseconds = std::round(days * 86'400e3);
  const auto number = static_cast<long>(std::floor(milliseconds / 86'400e3));
  Moment moment;
  moment.second = (milliseconds - static_cast<double>(number) * 86'400e3) / 1e3;
  // The year is guessed from its mean length and mended; then its months are gone through.
  const double length = calendar == Calendar::days_360 ? 360.0 : 365.2425;
  moment.year = 1970 + static_cast<int>(std::floor(static_cast<double>(number) / length));
  while (day_number(calendar, moment.year, 1, 1) > number) --moment.year;
  while (day_number(calendar, moment.year + 1, 1, 1) <= number) ++moment.year;
  while (moment.month < 12 && day_number(calendar, moment.year, moment.month + 1, 1) <= number)
    ++moment.month;
  moment.day = 1 + static_cast<int>(number - day_number(calendar, moment.year, moment.month, 1));
  if (calendar == Calendar::standard && moment.year == 1582 && moment.month == 10 && moment.day > 4)
    moment.day += 10;  // the 4th was followed by the 15th
  return moment;
}

std::string iso(const Moment& moment) {
  char text[64] = {};
  std::snprintf(text, sizeof text, "%04d-%02d-%02d", moment.year, moment.month, moment.day);
  std::string result = text;
  const auto second = static_cast<long>(std::floor(moment.second + 1e-3));
  if (second == 0) return result;
  std::snprintf(text, sizeof text, "T%02ld:%02ld", second / 3600, second / 60 % 60);
  result += text;
  if (second % 60 != 0) {
    std::snprintf(text, sizeof text, ":%02ld", second % 60);
    result += text;
  }
  return result;
}

std::optional<Moment> parse_moment(std::string_view text, Calendar calendar) {
  std::size_t at = 0;
  const auto skip = [&] {
    while (at < text.size() && text[at] == ' ') ++at;
  };
  const auto number = [&]() -> std::optional<double> {
    const std::size_t begin = at;
    while (at < text.size() &&
           (std::isdigit(static_cast<unsigned char>(text[at])) != 0 || text[at] == '.'))
      ++at;
    if (at == begin || at - begin > 15) return std::nullopt;
    try {
      std::size_t used = 0;
      const std::string digits(text.substr(begin, at - begin));
      const double value = std::stod(digits, &used);
      return used == digits.size() ? std::optional(value) : std::nullopt;
    } catch (const std::exception&) {
      return std::nullopt;
    }
  };
  const auto take = [&](char c) {
    if (at >= text.size() || text[at] != c) return false;
    ++at;
    return true;
  };
  skip();
  const bool negative = take('-');
  const auto year = number();
  if (!year || !take('-')) return std::nullopt;
  const auto month = number();
  if (!month || !take('-')) return std::nullopt;
  const auto day = number();
  if (!day) return std::nullopt;
  if (*year > 9999.0 || *month < 1.0 || *month > 12.0 || *day < 1.0) return std::nullopt;
  Moment moment{.year = static_cast<int>(negative ? -*year : *year),
                .month = static_cast<int>(*month),
                .day = static_cast<int>(*day)};
  if (*year != std::floor(*year) || *month != std::floor(*month) || *day != std::floor(*day) ||
      moment.day > days_in_month(calendar, moment.year, moment.month))
    return std::nullopt;
  if (!take('T') && !take('t')) skip();
  double parts[3] = {0.0, 0.0, 0.0};  // hours, minutes, seconds
  if (at < text.size() && std::isdigit(static_cast<unsigned char>(text[at])) != 0) {
    for (int i = 0; i < 3; ++i) {
      const auto part = number();
      if (!part || *part > (i == 0 ? 24.0 : 60.0)) return std::nullopt;
      parts[i] = *part;
      if (!take(':')) break;
    }
  }
  moment.second = 3600.0 * parts[0] + 60.0 * parts[1] + parts[2];
  skip();
  double shift = 0.0;  // of the zone [s]
  if (at < text.size() && (text[at] == '+' || text[at] == '-')) {
    const double sign = text[at++] == '-' ? -1.0 : 1.0;
    const auto hours = number();
    if (!hours) return std::nullopt;
    const bool joined = *hours > 99.0;  // +0130
    shift = joined ? 3600.0 * std::floor(*hours / 100.0) + 60.0 * std::fmod(*hours, 100.0)
                   : 3600.0 * *hours;
    if (take(':')) {
      const auto minutes = number();
      if (!minutes) return std::nullopt;
      shift += 60.0 * *minutes;
    }
    shift *= sign;
  } else if (const std::string zone = lower(text.substr(at)); zone == "z" || zone == "utc") {
    at = text.size();
  }
  skip();
  if (at != text.size()) return std::nullopt;
  if (shift == 0.0 && moment.second < 86'400.0) return moment;
  return moment_of(calendar, days(calendar, moment) - shift / 86'400.0);
}

std::optional<TimeUnits> TimeUnits::parse(std::string_view units, std::string_view calendar) {
  const auto rule = calendar_of(calendar);
  const std::string words = lower(units);
  const std::size_t since = words.find(" since ");
  if (!rule || since == std::string::npos) return std::nullopt;
  std::string unit = words.substr(0, since);
  unit.erase(unit.find_last_not_of(' ') + 1);
  unit.erase(0, unit.find_first_not_of(' '));
  TimeUnits result;
  result.calendar_ = *rule;
  const auto is = [&](std::initializer_list<std::string_view> names) {
    return std::find(names.begin(), names.end(), unit) != names.end();
  };
  if (is({"days", "day", "d"}))
    result.days_ = 1.0;
  else if (is({"hours", "hour", "hrs", "hr", "h"}))
    result.days_ = 1.0 / 24.0;
  else if (is({"minutes", "minute", "mins", "min"}))
    result.days_ = 1.0 / 1440.0;
  else if (is({"seconds", "second", "secs", "sec", "s"}))
    result.days_ = 1.0 / 86'400.0;
  else if (is({"milliseconds", "millisecond", "msecs", "msec", "ms"}))
    result.days_ = 1.0 / 86'400e3;
  else if (is({"weeks", "week"}))
    result.days_ = 7.0;
  else if (is({"months", "month", "mon"}))
    result.months_ = 1;
  else if (is({"years", "year", "yrs", "yr"}))
    result.months_ = 12;
  else
    return std::nullopt;
  const auto moment = parse_moment(units.substr(since + 7), *rule);
  if (!moment) return std::nullopt;
  result.since_ = *moment;
  return result;
}

Moment TimeUnits::at(double value) const noexcept {
  if (!(std::abs(value) < 1e15)) return since_;
  if (months_ == 0) return moment_of(calendar_, days(calendar_, since_) + value * days_);
  const double months = value * months_;
  const auto whole = static_cast<long>(std::floor(months));
  const long number = 12L * since_.year + since_.month - 1 + std::clamp(whole, -120'000L, 120'000L);
  Moment moment = since_;
  moment.year = static_cast<int>(floor_div(number, 12));
  moment.month = static_cast<int>(number - 12L * moment.year) + 1;
  const int length = days_in_month(calendar_, moment.year, moment.month);
  moment.day = std::min(moment.day, length);
  return moment_of(calendar_, days(calendar_, moment) + (months - std::floor(months)) * length);
}

}  // namespace asdic::detail
