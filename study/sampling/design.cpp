#include "study/sampling/design.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "core/random.h"
#include "study/sampling/sobol.h"

namespace asdic::detail::study {

std::string_view name(Design design) noexcept {
  switch (design) {
    case Design::random:
      return "random";
    case Design::latin_hypercube:
      return "latin_hypercube";
    case Design::sobol:
      return "sobol";
    case Design::grid:
      return "grid";
    case Design::saltelli:
      return "saltelli";
  }
  return "";
}

double uniform_draw(std::uint64_t seed, std::uint64_t index, std::uint32_t dimension) noexcept {
  const auto words = RandomStream(seed, Draw::study_input, dimension, index).block(0);
  const std::uint64_t bits = (static_cast<std::uint64_t>(words[0]) << 32) | words[1];
  return (static_cast<double>(bits >> 12) + 0.5) * 0x1p-52;  // exact, so never 0 or 1
}

namespace {

/// A number that a key draws for one step of the permutation.
std::uint32_t keyed(std::uint64_t seed, std::uint32_t dimension, std::uint64_t step) noexcept {
  return RandomStream(seed, Draw::study_permutation, dimension, step).block(0)[0];
}

/// The place of `index` under a permutation of 0 … n − 1: a Feistel network on the smallest power
/// of two that holds them, walked until it comes back among them (Black & Rogaway, CT-RSA 2002).
/// Halves of unequal width take turns; every round is undone by itself, so the whole is one-to-one.
std::uint64_t permuted(std::uint64_t index, std::uint64_t n, std::uint64_t seed,
                       std::uint32_t dimension) noexcept {
  const auto bits = static_cast<unsigned>(std::bit_width(n - 1));
  const unsigned low_bits = bits / 2, high_bits = bits - low_bits;
  const std::uint64_t low_mask = (std::uint64_t{1} << low_bits) - 1,
                      high_mask = (std::uint64_t{1} << high_bits) - 1;
  std::uint64_t at = index;
  do {
    std::uint64_t low = at & low_mask, high = at >> low_bits;
    for (std::uint64_t round = 0; round < 8; round += 2) {
      high ^= keyed(seed, dimension, (low << 3) | round) & high_mask;
      low ^= keyed(seed, dimension, (high << 3) | (round + 1)) & low_mask;
    }
    at = (high << low_bits) | low;
  } while (at >= n);
  return at;
}

/// Rounding must not take a coordinate out of the open interval.
double inside(double u) noexcept { return std::clamp(u, 0x1p-54, 1.0 - 0x1p-53); }

/// Groups of coordinates, and one for chance.
std::size_t count_of(const std::vector<std::size_t>& groups, bool chance) {
  const std::size_t of_inputs =
      groups.empty() ? 0 : *std::max_element(groups.begin(), groups.end()) + 1;
  return of_inputs + (chance ? 1 : 0);
}

}  // namespace

PointDesign::PointDesign(Design design, std::uint64_t seed, std::uint64_t points,
                         std::size_t dimensions, const DesignOptions& options,
                         std::vector<std::size_t> groups)
    : design_(design),
      seed_(seed),
      points_(points),
      dimensions_(dimensions),
      options_(options),
      groups_(std::move(groups)),
      blocks_(count_of(groups_, options.chance), options.second_order) {}

void PointDesign::point(std::uint64_t index, std::span<double> u) const noexcept {
  for (std::size_t i = 0; i < u.size(); ++i) {
    const auto d = static_cast<std::uint32_t>(i);
    if (design_ == Design::saltelli) {
      const bool of_b = blocks_.of_b(index % blocks_.rows(), groups_[i]);
      u[i] = uniform_draw(seed_, index / blocks_.rows(),
                          of_b ? d + static_cast<std::uint32_t>(dimensions_) : d);
      continue;
    }
    const double within = uniform_draw(seed_, index, d);
    u[i] = within;
    if (design_ == Design::latin_hypercube && index < points_) {
      const auto stratum = static_cast<double>(permuted(index, points_, seed_, d));
      u[i] = inside((stratum + within) / static_cast<double>(points_));
    } else if (design_ == Design::sobol && i < most_sobol_dimensions) {
      const auto point = static_cast<std::uint32_t>(index / options_.replicates);
      const std::uint32_t digits =
          owen_scrambled(sobol_digits(point, i), seed_, d, index % options_.replicates);
      u[i] = inside((static_cast<double>(digits) + within) * 0x1p-32);
    }
  }
}

std::uint64_t PointDesign::chance_of(std::uint64_t index) const noexcept {
  if (design_ != Design::saltelli) return index;
  // The last group, if it is one; else A's rows share A's, and B's rows B's.
  const std::size_t chance = options_.chance ? blocks_.groups() - 1 : blocks_.rows();
  return 2 * (index / blocks_.rows()) + (blocks_.of_b(index % blocks_.rows(), chance) ? 1 : 0);
}

}  // namespace asdic::detail::study
