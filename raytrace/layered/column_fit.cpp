#include "raytrace/layered/column_fit.h"

#include <cmath>

#include "core/units.h"

namespace asdic {
namespace {

constexpr double range_error = 1e-6, time_error = 1e-12, slope_error = 3e-8;

}  // namespace

ColumnFit::ColumnFit(const Column& column, double c_ref, double low, double high)
    : middle_(0.5 * (low + high)), per_half_(2.0 / (high - low)) {
  static const auto cosines = [] {  // cos(πk(j + ½)/n)
    std::array<std::array<double, terms>, terms> t{};
    for (std::size_t k = 0; k < terms; ++k)
      for (std::size_t j = 0; j < terms; ++j)
        t[k][j] = std::cos(pi * double(k) * (double(j) + 0.5) / terms);
    return t;
  }();
  for (std::size_t j = 0; j < terms; ++j) {
    const RayParameter ray(c_ref, middle_ + cosines[1][j] / per_half_);
    const auto [sums, details] = column.all(ray);
    const double chain = ray.slowness_per_sigma();
    turns_above_ = sums.turns_above;
    turns_below_ = sums.turns_below;
    const Pass* passes[3] = {&sums.up, &sums.middle, &sums.down};
    const PassDetail* parts[3] = {&details.up, &details.middle, &details.down};
    Lanes sum{}, detail{};
    for (std::size_t i = 0; i < 3; ++i) {
      sum[i] = passes[i]->range;
      sum[3 + i] = passes[i]->d_range * chain;
      detail[i] = parts[i]->time - ray.slowness * passes[i]->range;
      detail[3 + i] = parts[i]->length;
    }
    for (std::size_t k = 0; k < terms; ++k) {
      const double weight = (k == 0 ? 1.0 : 2.0) / terms * cosines[k][j];
      for (std::size_t i = 0; i < lanes; ++i) {
        sums_[k][i] += weight * sum[i];
        details_[k][i] += weight * detail[i];
      }
    }
  }
  good_ = true;
  for (std::size_t i = 0; i < 3; ++i)
    good_ = good_ && holds(sums_, i, 1e-15, range_error) && holds(sums_, 3 + i, slope_error, 0.0) &&
            holds(details_, i, 1e-15, time_error) && holds(details_, 3 + i, 1e-15, range_error);
}

bool ColumnFit::holds(const Series& series, std::size_t lane, double relative,
                      double absolute) const noexcept {
  const double tail = std::abs(series[terms - 1][lane]) + std::abs(series[terms - 2][lane]);
  return tail <= absolute + relative * std::abs(series[0][lane]);  // not if it is not finite
}

/// Clenshaw's recurrence.
ColumnFit::Lanes ColumnFit::sum(const Series& series, double sigma) const noexcept {
  const double x = (sigma - middle_) * per_half_;
  Lanes before{}, here = series[terms - 1];
  for (std::size_t k = terms - 2; k > 0; --k)
    for (std::size_t i = 0; i < lanes; ++i) {
      const double next = series[k][i] + 2.0 * x * here[i] - before[i];
      before[i] = here[i];
      here[i] = next;
    }
  for (std::size_t i = 0; i < lanes; ++i) here[i] = series[0][i] + x * here[i] - before[i];
  return here;
}

ColumnSums ColumnFit::sums(const RayParameter& ray) const noexcept {
  const Lanes value = sum(sums_, ray.sigma);
  const double per_chain = 1.0 / ray.slowness_per_sigma();
  return {.up = {value[0], value[3] * per_chain},
          .middle = {value[1], value[4] * per_chain},
          .down = {value[2], value[5] * per_chain},
          .turns_above = turns_above_,
          .turns_below = turns_below_};
}

Column::All ColumnFit::all(const RayParameter& ray) const noexcept {
  const ColumnSums s = sums(ray);
  const Lanes value = sum(details_, ray.sigma);
  const double xi = ray.slowness;
  return {s,
          {.up = {value[0] + xi * s.up.range, value[3]},
           .middle = {value[1] + xi * s.middle.range, value[4]},
           .down = {value[2] + xi * s.down.range, value[5]}}};
}

const ColumnFit* ColumnFits::fit_at(double sigma) {
  for (std::size_t i = 0;;) {
    if (!pieces_[i].fit) pieces_[i].fit.emplace(*column_, c_ref_, pieces_[i].low, pieces_[i].high);
    if (pieces_[i].fit->good()) return &*pieces_[i].fit;
    if (pieces_[i].depth == deepest) return nullptr;
    const double middle = 0.5 * (pieces_[i].low + pieces_[i].high);
    if (pieces_[i].halves == 0) {
      const double low = pieces_[i].low, high = pieces_[i].high;
      const int depth = pieces_[i].depth + 1;
      pieces_[i].halves = pieces_.size();
      pieces_.push_back({low, middle, depth});
      pieces_.push_back({middle, high, depth});
    }
    i = pieces_[i].halves + (sigma < middle ? 0 : 1);
  }
}

}  // namespace asdic
