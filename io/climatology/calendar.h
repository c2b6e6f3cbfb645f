#pragma once
#include <optional>
#include <string>
#include <string_view>

// Times of netCDF files, by the CF conventions (ch. 4.4): "hours since 2000-01-01 00:00:00".
namespace asdic::detail {

enum class Calendar {
  standard,             ///< Julian to 4 October 1582, Gregorian from the 15th; "gregorian"
  proleptic_gregorian,  ///< Gregorian always
  julian,
  no_leap,   ///< years of 365 days
  all_leap,  ///< years of 366 days
  days_360,  ///< twelve months of 30 days
};

/// By its name of CF ("" is the standard). \return nothing for a name that CF does not have
[[nodiscard]] std::optional<Calendar> calendar_of(std::string_view name) noexcept;

/// A moment of a calendar, in UTC.
struct Moment {
  int year = 1970, month = 1, day = 1;  ///< 1..12, 1..31
  double second = 0.0;                  ///< of the day [s]
  bool operator==(const Moment&) const = default;
};

/// Days from 1970-01-01 00:00 of a calendar: what times are compared and interpolated in.
[[nodiscard]] double days(Calendar calendar, const Moment& moment) noexcept;
/// The inverse, to a millisecond.
[[nodiscard]] Moment moment_of(Calendar calendar, double days) noexcept;
[[nodiscard]] int days_in_month(Calendar calendar, int year, int month) noexcept;

/// "2024-01-31", with "T06:00" or "T06:00:30" where it is not midnight.
[[nodiscard]] std::string iso(const Moment& moment);

/// "2024-01-31", "2024-01-31T06:00", "2000-1-1 00:00:00.0 +1:00", "…Z".
/// \return nothing for what is no moment of that calendar
[[nodiscard]] std::optional<Moment> parse_moment(std::string_view text,
                                                 Calendar calendar = Calendar::standard);

/// Units of time since a moment. A month is the calendar's, and its fraction one of its own days:
/// 0.5 months since 1 January is the middle of that month. So are years.
class TimeUnits {
 public:
  /// \return nothing for other units, or a calendar that CF does not have
  [[nodiscard]] static std::optional<TimeUnits> parse(std::string_view units,
                                                      std::string_view calendar);
  [[nodiscard]] Moment at(double value) const noexcept;
  [[nodiscard]] Calendar calendar() const noexcept { return calendar_; }

 private:
  Calendar calendar_ = Calendar::standard;
  Moment since_{};
  double days_ = 1.0;  ///< of a unit
  int months_ = 0;     ///< of a unit, else 0
};

}  // namespace asdic::detail
