#include "reverb/power/phone_mean.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/rotate_back.h"
#include "core/units.h"

namespace asdic::detail {
namespace {

// Places are even where phases by any two paths are what they would be to 0.02 rad.
constexpr double alike = 0.02;  // [rad]

/// Least phones whose regularity is worth a form of its own.
constexpr std::size_t few = 6;

/// Up to which x the order n and all higher ones of Jacobi and Anger's series are nothing.
double furthest_of(std::size_t n) {
  constexpr double nothing = 5e-7;
  const auto order = static_cast<double>(n);
  double below = 0.0, above = order;  // J_n rises from 0 to beyond n
  for (int i = 0; i < 40; ++i) {
    const double x = 0.5 * (below + above);
    (std::cyl_bessel_j(order, x) < nothing ? below : above) = x;
  }
  return below;
}

/// to += amplitude·e^{−i2π·cycles}
void add(double amplitude, double cycles, std::complex<double>& to) noexcept {
  double across = 0.0;
  rotate_back(cycles, amplitude, across);
  to += std::complex<double>(amplitude, across);
}

}  // namespace

PhoneMean::PhoneMean(std::span<const Vec3> phones, double frequency) {
  for (const Vec3& x : phones) phones_.emplace_back(frequency * x);
  line_ = line();
  if (line_) return;
  std::vector<Vec3> by_height = phones_;
  std::stable_sort(by_height.begin(), by_height.end(),
                   [](const Vec3& a, const Vec3& b) { return a.z() < b.z(); });
  constexpr double height = alike / (2.0 * pi);
  for (auto first = by_height.begin(); first != by_height.end();) {
    const auto last = std::find_if(first, by_height.end(), [&](const Vec3& x) {
      return (x.z() - first->z()) * most_apart > height;
    });
    if (std::optional<Ring> even = ring({first, last}))
      rings_.push_back(std::move(*even));
    else
      others_.insert(others_.end(), first, last);
    first = last;
  }
  double most = 0.0;
  for (const Ring& one : rings_) most = std::max(most, one.furthest);
  if (!rings_.empty()) bessel_.emplace(most + 1.0);
}

std::optional<PhoneMean::Line> PhoneMean::line() const {
  if (phones_.size() < few) return std::nullopt;
  Line found{.count = static_cast<double>(phones_.size())};
  found.step = (phones_.back() - phones_.front()) / (found.count - 1.0);
  found.centre = 0.5 * (phones_.front() + phones_.back());
  for (std::size_t k = 0; k < phones_.size(); ++k) {
    const Vec3 even = phones_.front() + static_cast<double>(k) * found.step;
    if (!(2.0 * pi * most_apart * (phones_[k] - even).norm() < alike)) return std::nullopt;
  }
  return found;
}

std::optional<PhoneMean::Ring> PhoneMean::ring(std::vector<Vec3> level) const {
  if (level.size() < few) return std::nullopt;
  const auto n = static_cast<double>(level.size());
  Ring found{.share = n / static_cast<double>(phones_.size())};
  for (const Vec3& x : level) found.centre += x / n;
  const auto bearing = [&](const Vec3& x) {
    return std::atan2(x.x() - found.centre.x(), x.y() - found.centre.y());
  };
  for (const Vec3& x : level) found.radius += (x - found.centre).head<2>().norm() / n;
  std::sort(level.begin(), level.end(),
            [&](const Vec3& a, const Vec3& b) { return bearing(a) < bearing(b); });
  const double first = bearing(level.front());
  for (std::size_t k = 0; k < level.size(); ++k) {
    const double at = first + 2.0 * pi * static_cast<double>(k) / n;
    const Vec3 even = found.centre + found.radius * Vec3(std::sin(at), std::cos(at), 0.0);
    if (!(2.0 * pi * most_apart * (level[k] - even).norm() < 2.0 * alike)) return std::nullopt;
  }
  found.furthest = furthest_of(level.size());
  found.phones = std::move(level);
  return found;
}

std::complex<double> PhoneMean::operator()(const Vec3& apart) const noexcept {
  std::complex<double> sum = 0.0;
  if (line_) {
    const double half = pi * apart.dot(line_->step), under = line_->count * std::sin(half);
    add(std::abs(under) > 1e-9 ? std::sin(line_->count * half) / under
                               : std::cos(line_->count * half) * std::cos(half),
        apart.dot(line_->centre), sum);
    return sum;
  }
  const double level = 2.0 * pi * apart.head<2>().norm();
  const auto whole = static_cast<double>(phones_.size());
  for (const Ring& ring : rings_) {
    if (const double x = level * ring.radius; x < ring.furthest)
      add(ring.share * (*bessel_)(x), apart.dot(ring.centre), sum);
    else
      for (const Vec3& phone : ring.phones) add(1.0 / whole, apart.dot(phone), sum);
  }
  for (const Vec3& phone : others_) add(1.0 / whole, apart.dot(phone), sum);
  return sum;
}

std::complex<double> PhoneMean::plain(const Vec3& apart) const noexcept {
  std::complex<double> sum = 0.0;
  for (const Vec3& phone : phones_) add(1.0, apart.dot(phone), sum);
  return sum / static_cast<double>(phones_.size());
}

}  // namespace asdic::detail
