#include "raytrace/ocean/samples.h"

#include <cmath>

#include "core/error.h"
#include "raytrace/ocean/number_text.h"

namespace asdic::detail {

void check_count(std::size_t count, const char* name, std::size_t least) {
  if (count >= least) return;
  throw InputError({.where = name,
                    .got = count == 0 ? "no samples" : std::to_string(count) + " samples",
                    .expected = least == 1 ? "at least one" : "at least " + std::to_string(least)});
}

void check_as_many(std::size_t values, const char* name, std::size_t places, const char* axis) {
  if (values == places) return;
  throw InputError({.where = name,
                    .got = std::to_string(values) + " values",
                    .expected = "as many as " + std::string(axis) + ": " + std::to_string(places)});
}

void check_place(std::span<const double> axis, std::size_t i, const char* name, const char* beyond,
                 bool steps) {
  const auto fault = [&](const std::string& expected) {
    return InputError(
        {.where = element(name, i), .got = with_unit(axis[i], "m"), .expected = expected});
  };
  if (!std::isfinite(axis[i])) throw fault("a finite " + std::string(name));
  if (i > 0 && (steps ? axis[i] < axis[i - 1] : axis[i] <= axis[i - 1]))
    throw fault(std::string(beyond) + " the one before, " + with_unit(axis[i - 1], "m"));
}

void check_speed(double speed, const std::string& where) {
  if (!std::isfinite(speed) || speed <= 0.0)
    throw InputError(
        {.where = where, .got = with_unit(speed, "m/s"), .expected = "a speed above 0 m/s"});
}

}  // namespace asdic::detail
