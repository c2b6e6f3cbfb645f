#include "study/measures/cell_counts.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

namespace asdic::detail::study {
namespace {

void put(std::vector<std::uint8_t>& bytes, std::uint64_t value) {  // seven bits a byte
  for (; value >= 128; value >>= 7) bytes.push_back(static_cast<std::uint8_t>(value | 128U));
  bytes.push_back(static_cast<std::uint8_t>(value));
}

/// \return 0 at the end
std::uint64_t take(std::span<const std::uint8_t> bytes, std::size_t& at) {
  std::uint64_t value = 0;
  for (int shift = 0; at < bytes.size() && shift < 64; shift += 7) {
    const std::uint8_t byte = bytes[at++];
    value |= static_cast<std::uint64_t>(byte & 127U) << shift;
    if (byte < 128) break;
  }
  return value;
}

}  // namespace

std::vector<double> cell_levels(double false_alarm_probability) {
  constexpr int of_a_decade = 10, decades = 20;
  std::vector<double> levels;
  for (int i = 0; i <= of_a_decade * decades; ++i)
    levels.push_back(std::log(10.0) * i / of_a_decade);
  const double set = -std::log(false_alarm_probability);
  // One that is a tenth of a decade but for its last digits is that, with its own digits.
  const auto near = std::min_element(levels.begin() + 1, levels.end(), [&](double a, double b) {
    return std::abs(a - set) < std::abs(b - set);
  });
  if (std::abs(*near - set) < 1e-9 * set) {
    *near = set;
  } else if (set < levels.back()) {
    levels.insert(std::upper_bound(levels.begin(), levels.end(), set), set);
  }
  return levels;
}

std::vector<std::uint8_t> packed_counts(std::span<const std::uint32_t> counts) {
  std::vector<std::uint8_t> bytes;
  std::size_t before = 0;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (counts[i] == 0) continue;
    put(bytes, i - before);
    put(bytes, counts[i]);
    before = i;
  }
  return bytes;
}

std::vector<std::uint32_t> unpacked_counts(std::span<const std::uint8_t> bytes, std::size_t size) {
  std::vector<std::uint32_t> counts(size, 0);
  std::size_t place = 0;
  for (std::size_t at = 0; at < bytes.size();) {
    place += take(bytes, at);
    const std::uint64_t count = take(bytes, at);
    if (place >= size) break;
    counts[place] = static_cast<std::uint32_t>(count);
  }
  return counts;
}

CellSums cell_sums(const CellShape& shape) {
  const std::size_t rows = shape.targets * (shape.times() + 1), levels = shape.levels.size();
  if (shape.targets * shape.times() * levels == 0) return {};
  CellSums sums{.shape = shape};
  sums.count.assign(rows * levels, 0);
  sums.squares = sums.with_all = sums.count;
  sums.realisations.assign(rows, 0);
  return sums;
}

void CellSums::add(std::span<const std::uint8_t> bytes) {
  const std::size_t targets = shape.targets, times = shape.times(), levels = shape.levels.size();
  const std::vector<std::uint32_t> row = unpacked_counts(bytes, targets * times * levels);
  std::vector<std::int64_t> of_all(levels);
  const auto take_in = [&](std::size_t place, const std::vector<std::int64_t>& counts) {
    std::int64_t all = 0;
    for (const std::int64_t n : counts) all += n;
    if (all == 0) return;
    ++realisations[place];
    std::int64_t above = 0;
    for (std::size_t level = levels; level-- > 0;) {
      above += counts[level];
      const std::size_t at = place * levels + level;
      count[at] += counts[level];
      squares[at] += above * above;
      with_all[at] += above * all;
    }
  };
  std::vector<std::int64_t> counts(levels);
  for (std::size_t target = 0; target < targets; ++target) {
    std::fill(of_all.begin(), of_all.end(), 0);
    for (std::size_t time = 0; time < times; ++time) {
      const std::size_t from = (target * times + time) * levels;
      for (std::size_t level = 0; level < levels; ++level) {
        counts[level] = row[from + level];
        of_all[level] += counts[level];
      }
      take_in(target * (times + 1) + 1 + time, counts);
    }
    take_in(target * (times + 1), of_all);
  }
}

void CellSums::add(const CellSums& others) {
  if (others.empty()) return;
  if (empty()) *this = cell_sums(others.shape);
  const auto plus = [](std::vector<std::int64_t>& to, const std::vector<std::int64_t>& from) {
    for (std::size_t i = 0; i < std::min(to.size(), from.size()); ++i) to[i] += from[i];
  };
  plus(count, others.count);
  plus(squares, others.squares);
  plus(with_all, others.with_all);
  plus(realisations, others.realisations);
}

std::vector<std::uint8_t> bytes_of(const CellSums& sums) {
  const CellShape& shape = sums.shape;
  std::vector<std::int64_t> numbers{static_cast<std::int64_t>(shape.targets),
                                    static_cast<std::int64_t>(shape.edges.size()),
                                    static_cast<std::int64_t>(shape.levels.size())};
  for (const auto* part : {&shape.edges, &shape.levels})
    for (const double x : *part) numbers.push_back(std::bit_cast<std::int64_t>(x));
  for (const auto* part : {&sums.count, &sums.squares, &sums.with_all, &sums.realisations})
    numbers.insert(numbers.end(), part->begin(), part->end());
  std::vector<std::uint8_t> bytes(numbers.size() * sizeof(std::int64_t));
  std::memcpy(bytes.data(), numbers.data(), bytes.size());
  return bytes;
}

CellSums cell_sums_of(std::span<const std::uint8_t> bytes) {
  std::vector<std::int64_t> numbers(bytes.size() / sizeof(std::int64_t));
  if (!numbers.empty()) std::memcpy(numbers.data(), bytes.data(), numbers.size() * 8);
  std::size_t at = 0;
  const auto next = [&] { return at < numbers.size() ? numbers[at++] : 0; };
  CellShape shape{.targets = static_cast<std::size_t>(next())};
  const auto edges = static_cast<std::size_t>(next()), levels = static_cast<std::size_t>(next());
  if (edges + levels > numbers.size()) return {};
  for (std::size_t i = 0; i < edges; ++i) shape.edges.push_back(std::bit_cast<double>(next()));
  for (std::size_t i = 0; i < levels; ++i) shape.levels.push_back(std::bit_cast<double>(next()));
  CellSums sums = cell_sums(shape);
  for (auto* part : {&sums.count, &sums.squares, &sums.with_all, &sums.realisations})
    for (std::int64_t& n : *part) n = next();
  return sums;
}

}  // namespace asdic::detail::study
