#include "study/sampling/proposal.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace asdic::detail::study {
namespace {

constexpr double nowhere = -std::numeric_limits<double>::infinity();  // ln of a density of 0

/// Which of the choices u takes.
std::size_t choice_at(const std::vector<double>& cumulative, double u) noexcept {
  return static_cast<std::size_t>(std::upper_bound(cumulative.begin(), cumulative.end() - 1, u) -
                                  cumulative.begin());
}

double weight_of(const std::vector<double>& cumulative, std::size_t choice) noexcept {
  return cumulative[choice] - (choice > 0 ? cumulative[choice - 1] : 0.0);
}

double within_cube(double u) noexcept { return std::clamp(u, 0x1p-54, 1.0 - 0x1p-53); }

double drawn(const std::monostate&, double v) noexcept { return v; }

double drawn(const ScoreLaw& law, double v) noexcept {
  return normal_share(law.centre + law.deviation * normal_score(v));
}

double drawn(const LawInstead& laws, double v) noexcept {
  return within_cube(laws.law.distribution(laws.instead.quantile(v)));
}

double drawn(const WeightsInstead& weights, double v) noexcept {
  const std::size_t choice = choice_at(weights.instead, v);
  const double before = choice > 0 ? weights.instead[choice - 1] : 0.0;
  const double within = (v - before) / weight_of(weights.instead, choice);
  const double low = choice > 0 ? weights.cumulative[choice - 1] : 0.0,
               high = weights.cumulative[choice];
  // Never the upper end, which is the next choice's.
  return within_cube(std::clamp(std::lerp(low, high, within), low, std::nextafter(high, low)));
}

double log_of(const std::monostate&, double) noexcept { return 0.0; }

double log_of(const ScoreLaw& law, double u) noexcept {
  const double z = normal_score(u), other = (z - law.centre) / law.deviation;
  return 0.5 * (z * z - other * other) - std::log(law.deviation);
}

double log_of(const LawInstead& laws, double u) noexcept {
  const double x = laws.law.quantile(u), p = laws.law.density(x), q = laws.instead.density(x);
  return q > 0.0 ? std::log(q) - std::log(p) : nowhere;
}

double log_of(const WeightsInstead& weights, double u) noexcept {
  const std::size_t choice = choice_at(weights.cumulative, u);
  const double q = weight_of(weights.instead, choice);
  return q > 0.0 ? std::log(q / weight_of(weights.cumulative, choice)) : nowhere;
}

}  // namespace

double drawn_coordinate(const CoordinateDraw& draw, double v) noexcept {
  return std::visit([&](const auto& one) { return drawn(one, v); }, draw);
}

double log_density(const CoordinateDraw& draw, double u) noexcept {
  return std::visit([&](const auto& one) { return log_of(one, u); }, draw);
}

Proposal::Proposal(std::vector<ProposalPart> parts) : parts_(std::move(parts)) {}

Proposal::Drawn Proposal::draw(double which, std::span<double> u) const noexcept {
  if (empty()) return {};
  std::size_t part = 0;
  for (double before = parts_[0].share; part + 1 < parts_.size() && which >= before;)
    before += parts_[++part].share;
  const std::vector<CoordinateDraw>& draws = parts_[part].draws;
  for (std::size_t i = 0; i < draws.size(); ++i) u[i] = drawn_coordinate(draws[i], u[i]);
  return {.log_weight = log_weight(u), .part = part};
}

double Proposal::log_weight(std::span<const double> u) const noexcept {
  // w = 1/Σ a_k q_k(u), by the largest of the terms.
  std::vector<double> terms;
  for (const ProposalPart& part : parts_) {
    double sum = std::log(part.share);
    for (std::size_t i = 0; i < part.draws.size(); ++i) sum += log_density(part.draws[i], u[i]);
    terms.push_back(sum);
  }
  if (terms.empty()) return 0.0;
  const double most = *std::max_element(terms.begin(), terms.end());
  double sum = 0.0;
  for (const double term : terms) sum += std::exp(term - most);
  return -(most + std::log(sum));
}

}  // namespace asdic::detail::study
