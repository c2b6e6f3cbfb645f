#include "raytrace/bellhop_emulation/sinks.h"

#include <algorithm>
#include <cmath>

namespace asdic::detail::bellhop_emulation {
namespace {

constexpr double same_phase = 0.05;  // arrivals nearer than this in ωτ and in phase are one [rad]
constexpr std::size_t storage = 20'000'000;  // arrivals in all

}  // namespace

template <class Real>
void FieldSums<Real>::add(const Contribution& c, double omega) noexcept {
  const double magnitude = c.amplitude * std::exp(omega * c.tau.imag());
  auto& sum = sum_[c.row * columns_ + c.column];
  if (kind_ == FieldKind::coherent) {
    const double angle = c.phase - omega * c.tau.real();
    const double a = magnitude * c.weight;
    sum += std::complex<Real>(static_cast<Real>(a * std::cos(angle)),
                              static_cast<Real>(a * std::sin(angle)));
  } else {
    sum += static_cast<Real>(magnitude * magnitude * c.weight * c.intensity_factor);
  }
}

template <class Real>
void FieldSums<Real>::add(std::size_t row, std::size_t column, std::complex<double> pressure,
                          double weight) noexcept {
  auto& sum = sum_[row * columns_ + column];
  if (kind_ == FieldKind::coherent)
    sum += std::complex<Real>(weight * pressure);
  else
    sum += static_cast<Real>(weight * std::norm(pressure));
}

template class FieldSums<float>;
template class FieldSums<double>;

template <class Real>
ArrivalStore<Real>::ArrivalStore(std::size_t receivers, bool merge)
    : stored_(receivers),
      most_(std::max<std::size_t>(storage / std::max<std::size_t>(receivers, 1), 10)),
      merge_(merge) {}

template <class Real>
void ArrivalStore<Real>::add(std::size_t receiver, const Contribution& c, double launch_declination,
                             double omega) {
  const StoredArrival<Real> arrival{
      .amplitude = static_cast<Real>(c.amplitude * c.weight),
      .phase = static_cast<Real>(c.phase),
      .tau = {static_cast<Real>(c.tau.real()), static_cast<Real>(c.tau.imag())},
      .launch_declination = static_cast<Real>(launch_declination),
      .arrival_declination = static_cast<Real>(c.arrival_declination),
      .surface_bounces = c.end->surface_bounces,
      .bottom_bounces = c.end->bottom_bounces};
  std::vector<StoredArrival<Real>>& list = stored_[receiver];
  if (merge_ && !list.empty()) {
    StoredArrival<Real>& last = list.back();
    if (omega * std::abs(c.tau - std::complex<double>(last.tau)) < same_phase &&
        std::abs(static_cast<double>(last.phase) - c.phase) < same_phase) {
      const Real total = last.amplitude + arrival.amplitude;
      const Real w0 = last.amplitude / total, w1 = arrival.amplitude / total;
      // the second product rounded, the first not: as the reference outputs were computed
      const auto mean = [&](Real a, Real b) { return std::fma(w0, a, w1 * b); };
      last.tau = {mean(last.tau.real(), arrival.tau.real()),
                  mean(last.tau.imag(), arrival.tau.imag())};
      last.launch_declination = mean(last.launch_declination, arrival.launch_declination);
      last.arrival_declination = mean(last.arrival_declination, arrival.arrival_declination);
      last.amplitude = total;
      return;
    }
  }
  if (list.size() < most_) {
    list.push_back(arrival);
    return;
  }
  const auto weakest = std::min_element(list.begin(), list.end(), [](const auto& a, const auto& b) {
    return a.amplitude < b.amplitude;
  });
  if (arrival.amplitude > weakest->amplitude) *weakest = arrival;
}

template class ArrivalStore<float>;
template class ArrivalStore<double>;

}  // namespace asdic::detail::bellhop_emulation
