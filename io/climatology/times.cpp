#include "io/climatology/times.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/error.h"
#include "core/text.h"

namespace asdic::detail {

std::string OceanTime::text() const {
  if (date) return iso(*date);
  if (month) return "month " + std::to_string(*month);
  return "mean of all times";
}

namespace climatology {
namespace {

/// One step of one file.
struct Step {
  std::size_t file = 0, step = 0;
  Moment at{};
  double days = 0.0;        ///< of the file's calendar
  double year_day = 0.0;    ///< days since 1 January, scaled to a year of 365.25
  bool every_year = false;  ///< of a climatology
  double months = 0.0;      ///< that it stands for; 0: not known
  int first_month = 1;      ///< of those
};

constexpr double days_of_year = 365.25;

double day_in_year(Calendar calendar, const Moment& moment) {
  const double begin = days(calendar, {moment.year, 1, 1}),
               end = days(calendar, {moment.year + 1, 1, 1});
  return (days(calendar, moment) - begin) / (end - begin) * days_of_year;
}

std::vector<Step> steps_of(const std::vector<DataGrid>& files) {
  std::vector<Step> steps;
  for (std::size_t f = 0; f < files.size(); ++f) {
    const DataGrid& grid = files[f];
    for (std::size_t t = 0; t < grid.moments().size(); ++t) {
      Step step{.file = f, .step = t, .at = grid.moments()[t], .every_year = grid.every_year()};
      step.days = days(grid.calendar(), step.at);
      step.year_day = day_in_year(grid.calendar(), step.at);
      if (!grid.spans().empty()) {
        const Moment begin = grid.spans()[2 * t], end = grid.spans()[2 * t + 1];
        const double length = days(grid.calendar(), end) - days(grid.calendar(), begin);
        step.months = length / (days_of_year / 12.0);
        step.first_month = begin.month;
        // From 1 January 1955 to 1 February 2022: the Januaries of those years (CF, ch. 7.4).
        if (step.every_year && step.months > 11.5) {
          const double rest = std::fmod(std::round(step.months), 12.0);
          step.months = rest == 0.0 ? 12.0 : rest;
        }
      }
      steps.push_back(step);
    }
  }
  std::stable_sort(steps.begin(), steps.end(),
                   [](const Step& a, const Step& b) { return a.days < b.days; });
  return steps;
}

std::string names_of(const std::vector<DataGrid>& files) {
  const std::string first = files[0].path().string() + ": " + files[0].variable();
  return files.size() == 1 ? first : first + " and " + count_of(files.size() - 1, "file") + " more";
}

TimeChoice mean_of(const std::vector<Step>& steps, int fit, const std::string& what) {
  TimeChoice choice{.fit = fit};
  for (const Step& step : steps)
    choice.parts.push_back({step.file, step.step, 1.0 / static_cast<double>(steps.size())});
  choice.said = steps.size() == 1 ? "one time" : "mean of " + count_of(steps.size(), "step");
  if (!what.empty()) choice.said += ' ' + what;
  if (steps[0].every_year) return choice;
  choice.said += ", " + iso(steps.front().at);
  if (steps.size() > 1) choice.said += " to " + iso(steps.back().at);
  return choice;
}

/// "2024-01-01 to 2024-01-01T23:00", or the months that a climatology has.
std::string times_of(const std::vector<Step>& steps) {
  if (!steps[0].every_year)
    return count_of(steps.size(), "step") + " from " + iso(steps.front().at) + " to " +
           iso(steps.back().at);
  std::string text = "a climatology of month";
  for (const Step& step : steps) text += ' ' + std::to_string(step.at.month);
  return text;
}

InputError no_such_time(const std::vector<DataGrid>& files, const std::vector<Step>& steps,
                        const OceanTime& when) {
  return InputError({.where = names_of(files),
                     .got = times_of(steps),
                     .expected = "data of " + when.text() +
                                 "; without --month and --date the mean of all is taken"});
}

bool is_whole_year(const Step& step) { return step.months > 11.5; }
bool is_season(const Step& step) { return step.months > 1.5 && !is_whole_year(step); }

/// Whether the months that a step stands for hold a month.
bool covers(const Step& step, int month) {
  const int after = (month - step.first_month + 12) % 12;
  return after < static_cast<int>(std::round(step.months));
}

template <class Rule>
std::vector<Step> those(const std::vector<Step>& steps, Rule&& rule) {
  std::vector<Step> some;
  std::copy_if(steps.begin(), steps.end(), std::back_inserter(some), rule);
  return some;
}

/// What covers a month without being of it: its season, else the year. Or nothing.
std::optional<TimeChoice> wider(const std::vector<Step>& steps, int month) {
  if (const auto seasons =
          those(steps, [&](const Step& s) { return is_season(s) && covers(s, month); });
      !seasons.empty())
    return mean_of({seasons[0]}, 1,
                   "of " + to_text(std::round(seasons[0].months)) + " months from month " +
                       std::to_string(seasons[0].first_month));
  if (const auto years = those(steps, is_whole_year); !years.empty())
    return mean_of(years, 2, "of the whole year, not of month " + std::to_string(month));
  return std::nullopt;
}

TimeChoice of_month(const std::vector<DataGrid>& files, const std::vector<Step>& steps, int month) {
  const auto narrow = those(steps, [&](const Step& s) {
    return !is_season(s) && !is_whole_year(s) && s.at.month == month;
  });
  if (!narrow.empty()) return mean_of(narrow, 0, "of month " + std::to_string(month));
  if (const auto choice = wider(steps, month)) return *choice;
  throw no_such_time(files, steps, {.month = month});
}

TimeChoice between(const Step& before, const Step& after, double share, const std::string& said) {
  TimeChoice choice{.said = said};
  if (share < 1.0) choice.parts.push_back({before.file, before.step, 1.0 - share});
  if (share > 0.0) choice.parts.push_back({after.file, after.step, share});
  return choice;
}

/// Of a climatology: in the year.
TimeChoice in_the_year(const std::vector<DataGrid>& files, std::vector<Step> steps,
                       const Moment& date) {
  const double day = day_in_year(Calendar::standard, date);
  auto narrow = those(steps, [](const Step& s) { return !is_season(s) && !is_whole_year(s); });
  if (narrow.empty()) {
    if (const auto choice = wider(steps, date.month)) return *choice;
    throw no_such_time(files, steps, {.date = date});
  }
  std::sort(narrow.begin(), narrow.end(),
            [](const Step& a, const Step& b) { return a.year_day < b.year_day; });
  const auto next =
      std::find_if(narrow.begin(), narrow.end(), [&](const Step& s) { return s.year_day >= day; });
  const Step& after = next == narrow.end() ? narrow.front() : *next;
  const Step& before = next == narrow.begin() ? narrow.back() : *(next - 1);
  const auto ahead = [](double from, double to) {
    return std::fmod(to - from + days_of_year, days_of_year);
  };
  double gap = ahead(before.year_day, after.year_day);
  if (narrow.size() == 1) gap = days_of_year;
  const double gone = ahead(before.year_day, day);
  if (gap <= 100.0)
    return between(before, after, gap > 0.0 ? gone / gap : 0.0,
                   "between the steps of months " + std::to_string(before.at.month) + " and " +
                       std::to_string(after.at.month) + " of a climatology");
  if (const auto choice = wider(steps, date.month)) return *choice;
  const Step& nearest = gone <= gap / 2.0 ? before : after;
  if (std::min(gone, gap - gone) > 31.0) throw no_such_time(files, steps, {.date = date});
  TimeChoice choice = mean_of({nearest}, 0, "of month " + std::to_string(nearest.at.month));
  if (nearest.at.month != date.month) {
    const double apart = std::round(10.0 * std::min(gone, gap - gone)) / 10.0;
    choice.said = "the nearest time, of month " + std::to_string(nearest.at.month) + ", " +
                  to_text(apart) + (apart == 1.0 ? " day from " : " days from ") + iso(date);
  }
  return choice;
}

TimeChoice of_date(const std::vector<DataGrid>& files, const std::vector<Step>& steps,
                   const Moment& date) {
  if (std::all_of(steps.begin(), steps.end(), [](const Step& s) { return s.every_year; }))
    return in_the_year(files, steps, date);
  const double day = days(files[steps[0].file].calendar(), date);
  const auto next =
      std::find_if(steps.begin(), steps.end(), [&](const Step& s) { return s.days >= day; });
  if (next != steps.end() && next->days == day) return mean_of({*next}, 0, "");
  if (next != steps.begin() && next != steps.end()) {
    const Step &before = *(next - 1), &after = *next;
    return between(before, after, (day - before.days) / (after.days - before.days),
                   "between " + iso(before.at) + " and " + iso(after.at));
  }
  const Step& nearest = next == steps.end() ? steps.back() : steps.front();
  if (std::abs(nearest.days - day) > 31.0) throw no_such_time(files, steps, {.date = date});
  TimeChoice choice = mean_of({nearest}, 0, "");
  const double apart = std::round(10.0 * std::abs(nearest.days - day)) / 10.0;
  choice.said = "the nearest time, " + iso(nearest.at) + ", " + to_text(apart) +
                (apart == 1.0 ? " day from " : " days from ") + iso(date);
  return choice;
}

TimeChoice of_all(const std::vector<Step>& steps) {
  std::array<int, 12> in_month{};
  for (const Step& step : steps) ++in_month[static_cast<std::size_t>(step.at.month - 1)];
  const bool even = std::all_of(in_month.begin(), in_month.end(),
                                [&](int n) { return n > 0 && n == in_month[0]; });
  if (const auto years = those(steps, is_whole_year); !years.empty())
    return mean_of(years, 0, "of the whole year");
  return mean_of(steps, 0, even ? "of all months" : steps.size() > 1 ? "of all times" : "");
}

/// Files that tell no times: twelve steps are taken for the months, and nothing else.
TimeChoice without_times(const std::vector<DataGrid>& files, const OceanTime& when) {
  TimeChoice choice{.fit = 3};
  std::optional<int> month = when.month;
  if (when.date) month = when.date->month;
  std::size_t all = 0;
  for (const DataGrid& grid : files) all += grid.times();
  const bool monthly = all == 12;
  std::size_t number = 0;
  for (std::size_t f = 0; f < files.size(); ++f)
    for (std::size_t t = 0; t < files[f].times(); ++t, ++number)
      if (!month || !monthly || number % 12 == static_cast<std::size_t>(*month - 1))
        choice.parts.push_back({f, t, 1.0});
  for (auto& part : choice.parts) part.weight = 1.0 / static_cast<double>(choice.parts.size());
  if (all == 1) {
    choice.said = "has no time axis";
    if (month) choice.said += ": taken as it is, whatever the month";
  } else if (monthly) {
    choice.said = "12 steps without times, taken for the months: ";
    choice.said += month ? "number " + std::to_string(*month) : "mean of all";
  } else {
    choice.said = "mean of " + count_of(all, "step") + ", whose times the file does not tell";
    if (month)
      throw InputError({.where = names_of(files),
                        .got = count_of(all, "step") + " without times by CF (\"days since …\")",
                        .expected = "data of " + when.text()});
  }
  return choice;
}

}  // namespace

TimeChoice choose_steps(const std::vector<DataGrid>& files, const OceanTime& when) {
  const auto steps = steps_of(files);
  std::size_t all = 0;
  for (const DataGrid& grid : files) all += grid.times();
  if (steps.size() != all) return without_times(files, when);
  if (when.date) return of_date(files, steps, *when.date);
  if (when.month) return of_month(files, steps, *when.month);
  return of_all(steps);
}

}  // namespace climatology
}  // namespace asdic::detail
