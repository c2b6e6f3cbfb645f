#include "sonar/signal/waveforms/costas.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <set>
#include <string>

#include "core/quantities.h"
#include "core/text.h"
#include "core/units.h"

namespace asdic::detail {
namespace {

constexpr int most_chips = 256;

/// Whether each of 1…N is there once.
bool is_permutation_of_steps(const std::vector<double>& order) {
  std::vector<double> sorted = order;
  std::sort(sorted.begin(), sorted.end());
  for (std::size_t i = 0; i < sorted.size(); ++i)
    if (sorted[i] != static_cast<double>(i + 1)) return false;
  return true;
}

/// "chips 1 and 2 are as far apart as 3 and 4"; "" of a Costas array.
std::string repeated_difference(const std::vector<double>& order) {
  for (std::size_t lag = 1; lag < order.size(); ++lag)
    for (std::size_t i = 0; i + lag < order.size(); ++i)
      for (std::size_t j = i + 1; j + lag < order.size(); ++j)
        if (order[i + lag] - order[i] == order[j + lag] - order[j])
          return "chips " + std::to_string(i + 1) + " and " + std::to_string(i + lag + 1) +
                 " as many steps apart as " + std::to_string(j + 1) + " and " +
                 std::to_string(j + lag + 1);
  return "";
}

void describe_welch(Fields& field, std::vector<double>& order) {
  int prime = static_cast<int>(order.size()) + 1;
  std::optional<int> root;
  field(required("prime"), prime, 3, most_chips + 1,
        "of Welch's construction, which has prime - 1 chips");
  field(by_default("root", "the smallest"), root, 2, most_chips, "of the prime, a primitive one");
  if (!field.reads()) return;
  std::vector<double> made = root ? welch_costas(prime, *root) : welch_costas(prime);
  if (made.empty() && welch_costas(prime).empty())
    field.fault("prime", "a prime number", std::to_string(prime));
  if (made.empty())
    field.fault("root", "a primitive root of " + std::to_string(prime), std::to_string(*root));
  order = std::move(made);
}

}  // namespace

std::vector<double> welch_costas(int prime, int root) {
  std::vector<double> order;
  std::set<int> seen;
  int power = 1;
  for (int k = 0; k + 1 < prime; ++k) {
    order.push_back(power);
    seen.insert(power);
    power = power * root % prime;
  }
  // A root whose powers are all of 1…p − 1: there is one of primes alone.
  if (prime < 3 || seen.size() != order.size() || seen.contains(0)) order.clear();
  return order;
}

std::vector<double> welch_costas(int prime) {
  for (int root = 2; root < prime; ++root)
    if (std::vector<double> order = welch_costas(prime, root); !order.empty()) return order;
  return {};
}

void Costas::describe(Fields& field) {
  field(required("frequency"), frequency, quantity::frequency, "in the middle of all chips'");
  Fields::Ways ways;
  if (const auto way = field.way(ways, {"order"}, true))
    field(required("order"), order,
          {.noun = "step", .low = 1.0, .high = static_cast<double>(most_chips)},
          "of the chips' frequencies, 1 the lowest, each once: a Costas array");
  if (const auto way = field.otherwise(ways, {"prime", "root"})) describe_welch(field, order);
  field(by_default("step", "chips / duration"), step, quantity::frequency_step,
        "from one frequency to the next");
  if (!field.checks()) return;
  if (order.size() < 2 || order.size() > most_chips)
    field.fault("order", "2 to " + std::to_string(most_chips) + " chips",
                std::to_string(order.size()));
  if (!is_permutation_of_steps(order))
    field.fault("order", "each of 1 to " + std::to_string(order.size()) + " once", "others");
  const std::string repeated = repeated_difference(order);
  if (!repeated.empty())
    field.fault("order", "a Costas array, where no two pairs of chips are alike", repeated);
}

void Costas::check(Fields& field, double duration) const {
  const double half = frequency - frequencies(duration).lowest;
  if (!(frequency > half))
    field.fault("frequency", "one above " + to_text(half) + " Hz, half of what the chips span");
}

PulseFrequencies Costas::frequencies(double duration) const noexcept {
  const auto chips = static_cast<double>(order.size());
  const double half = 0.5 * (chips - 1.0) * step.value_or(chips / duration);
  return {frequency - half, frequency + half};
}

double Costas::phase(double t, double duration) const noexcept {
  const auto chips = static_cast<double>(order.size());
  const double hop = step.value_or(chips / duration), middle = 0.5 * (chips + 1.0);
  const double place = std::clamp(t / duration * chips, 0.0, chips);
  const std::size_t k = std::min(static_cast<std::size_t>(place), order.size() - 1);
  double steps = (order[k] - middle) * (place - static_cast<double>(k));
  for (std::size_t i = 0; i < k; ++i) steps += order[i] - middle;
  return 2.0 * pi * (frequency * t + steps * hop * duration / chips);
}

}  // namespace asdic::detail
