// Part of case_parts.h: sources and receivers, and how vectors are given.
#include <algorithm>
#include <cmath>

#include "io/bellhop/case_parts.h"

namespace asdic::detail::bellhop {
namespace {

constexpr std::int64_t most_values = 1'000'000;

std::vector<double> read_depths(CaseReading& reading, const std::string& who, bool& sorted) {
  ListReader& env = reading.env;
  env.begin("number of " + who + " depths");
  const std::int64_t n = env.need_integer("", 1, most_values);
  env.end();
  std::vector<double> depths = single_precision(read_vector(env, n, who + " depths"), 1.0F, sorted);
  std::size_t above = 0, below = 0;
  for (double& z : depths) {
    above += z < reading.surface_depth ? 1 : 0;
    below += z > reading.bottom_depth ? 1 : 0;
    z = std::clamp(z, reading.surface_depth, reading.bottom_depth);
  }
  const auto tell = [&](std::size_t n_moved, const char* where, double to) {
    if (n_moved > 0)
      reading.note(std::to_string(n_moved) + " of " + std::to_string(depths.size()) + ' ' + who +
                   " depths were " + where + " and moved to " + shown(to) + " m");
  };
  tell(above, "above the surface", reading.surface_depth);
  tell(below, "below the bottom", reading.bottom_depth);
  return depths;
}

}  // namespace

GivenVector read_vector(ListReader& from, std::int64_t count, const std::string& field) {
  GivenVector given{.values = {}, .count = count};
  from.begin(field);
  double value = 0.0;
  while (std::int64_t(given.values.size()) < count &&
         from.real(value, "value " + std::to_string(given.values.size() + 1))) {
    given.values.push_back(value);
  }
  const std::size_t n = given.values.size();
  if (n == 0 || (n != std::size_t(count) && n > 2))
    from.fail("", std::to_string(n) + " values",
              std::to_string(count) + ", or the two ends of a vector evenly spaced, or one");
  given.left = from.number_left();
  from.end();
  return given;
}

std::vector<double> single_precision(const GivenVector& given, float factor, bool& sorted) {
  std::vector<float> x(given.values.begin(), given.values.end());
  const auto n = std::size_t(given.count);
  if (given.are_ends()) {
    const float first = x[0], spacing = (x[1] - x[0]) / float(n - 1);
    x.resize(n);
    for (std::size_t i = 0; i < n; ++i) x[i] = std::fma(float(i), spacing, first);
  }
  x.resize(n, x.front());
  if (!std::is_sorted(x.begin(), x.end())) {
    sorted = true;
    std::sort(x.begin(), x.end());
  }
  std::vector<double> result;
  result.reserve(n);
  for (const float value : x) result.push_back(double(value * factor));
  return result;
}

void read_receivers(CaseReading& reading) {
  ListReader& env = reading.env;
  PropagationCase& run_case = reading.run_case();
  bool of_sources = false;  // nothing pairs with them
  run_case.source_depths = read_depths(reading, "source", of_sources);
  run_case.receivers.depths = read_depths(reading, "receiver", reading.receivers_sorted);
  env.begin("number of receiver ranges");
  const std::int64_t n = env.need_integer("", 1, most_values);
  env.end();
  run_case.receivers.ranges =
      single_precision(read_vector(env, n, "receiver ranges"), 1000.0F, reading.receivers_sorted);
}

}  // namespace asdic::detail::bellhop
