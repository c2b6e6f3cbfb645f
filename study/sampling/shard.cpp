#include "study/sampling/shard.h"

#include <charconv>

#include "core/error.h"

namespace asdic::detail::study {
namespace {

std::optional<std::uint64_t> whole_number(std::string_view text) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || error != std::errc() || end != text.data() + text.size()) return {};
  return value;
}

/// Two whole numbers with a mark between.
std::optional<IndexRange> pair(const std::string& text, char mark) {
  const auto at = text.find(mark);
  if (at == std::string::npos) return {};
  const auto first = whole_number(std::string_view(text).substr(0, at));
  const auto second = whole_number(std::string_view(text).substr(at + 1));
  if (!first || !second) return {};
  return IndexRange{*first, *second};
}

/// A number that Slurm gives to the tasks of an array.
std::uint64_t slurm_number(const Environment& environment, const std::string& name) {
  const std::optional<std::string> text = environment(name);
  const auto value = whole_number(text.value_or(""));
  if (!value)
    throw InputError({.where = "--shard slurm",
                      .got = text ? name + "=\"" + *text + "\"" : name + " not set",
                      .expected = "a whole number there, as in the tasks of a Slurm job array"});
  return *value;
}

IndexRange slurm_shard(std::uint64_t count, const Environment& environment) {
  const std::uint64_t id = slurm_number(environment, "SLURM_ARRAY_TASK_ID");
  const std::uint64_t n = slurm_number(environment, "SLURM_ARRAY_TASK_COUNT");
  const std::uint64_t first =
      environment("SLURM_ARRAY_TASK_MIN") ? slurm_number(environment, "SLURM_ARRAY_TASK_MIN") : 1;
  if (id < first || id - first >= n)  // --array=1,5,9: there are gaps between the tasks
    throw InputError({.where = "--shard slurm",
                      .got = "task " + std::to_string(id) + " of " + std::to_string(n) +
                             " that begin at " + std::to_string(first),
                      .expected = "tasks in a row, as of --array=1-" + std::to_string(n)});
  return shard(id - first + 1, n, count);
}

}  // namespace

IndexRange parse_range(const std::string& text, std::uint64_t count) {
  const auto range = pair(text, ':');
  if (!range || range->empty() || range->end > count)
    throw InputError({.where = "--realisations",
                      .got = "\"" + text + "\"",
                      .expected = "FIRST:END with 0 ≤ FIRST < END ≤ " + std::to_string(count) +
                                  " (END itself is not included)"});
  return *range;
}

IndexRange shard(std::uint64_t i, std::uint64_t n, std::uint64_t count) noexcept {
  // i·count/n without leaving 64 bits
  const auto cut = [&](std::uint64_t k) { return count / n * k + count % n * k / n; };
  return {cut(i - 1), cut(i)};
}

IndexRange parse_shard(const std::string& text, std::uint64_t count,
                       const Environment& environment) {
  if (text == "slurm") return slurm_shard(count, environment);
  const auto numbers = pair(text, '/');
  if (!numbers || numbers->first < 1 || numbers->first > numbers->end || numbers->end > count)
    throw InputError({.where = "--shard",
                      .got = "\"" + text + "\"",
                      .expected = "I/N with 1 ≤ I ≤ N ≤ " + std::to_string(count) +
                                  " (the realisations), or slurm"});
  return shard(numbers->first, numbers->end, count);
}

}  // namespace asdic::detail::study
