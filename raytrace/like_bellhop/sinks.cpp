#include "raytrace/like_bellhop/sinks.h"

#include <algorithm>
#include <cmath>

namespace asdic::like_bellhop {
namespace {

constexpr double same_phase = 0.05;         // arrivals nearer than this in ωτ and in phase are one [rad]
constexpr std::size_t storage = 20'000'000;  // arrivals in all

double to_float(double x) noexcept { return static_cast<double>(static_cast<float>(x)); }

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
void FieldSums<Real>::add(std::size_t row, std::size_t column,
                          std::complex<double> pressure) noexcept {
  auto& sum = sum_[row * columns_ + column];
  if (kind_ == FieldKind::coherent)
    sum += std::complex<Real>(static_cast<Real>(pressure.real()), static_cast<Real>(pressure.imag()));
  else
    sum += static_cast<Real>(std::norm(pressure));
}

template class FieldSums<float>;
template class FieldSums<double>;

ArrivalStore::ArrivalStore(std::size_t receivers, bool merge, bool single_precision)
    : stored_(receivers),
      most_(std::max<std::size_t>(storage / std::max<std::size_t>(receivers, 1), 10)),
      merge_(merge),
      single_precision_(single_precision) {}

StoredArrival ArrivalStore::rounded(StoredArrival a) const noexcept {
  if (!single_precision_) return a;
  a.amplitude = to_float(a.amplitude);
  a.phase = to_float(a.phase);
  a.tau = {to_float(a.tau.real()), to_float(a.tau.imag())};
  a.launch_declination = to_float(a.launch_declination);
  a.arrival_declination = to_float(a.arrival_declination);
  return a;
}

void ArrivalStore::add(std::size_t receiver, const StoredArrival& arrival, double omega) {
  std::vector<StoredArrival>& list = stored_[receiver];
  if (merge_ && !list.empty()) {
    StoredArrival& last = list.back();
    if (omega * std::abs(arrival.tau - last.tau) < same_phase &&
        std::abs(last.phase - arrival.phase) < same_phase) {
      const double total = last.amplitude + arrival.amplitude;
      const double w0 = last.amplitude / total, w1 = arrival.amplitude / total;
      last.tau = w0 * last.tau + w1 * arrival.tau;
      last.launch_declination =
          w0 * last.launch_declination + w1 * arrival.launch_declination;
      last.arrival_declination =
          w0 * last.arrival_declination + w1 * arrival.arrival_declination;
      last.amplitude = total;
      last = rounded(last);
      return;
    }
  }
  if (list.size() < most_) {
    list.push_back(rounded(arrival));
    return;
  }
  const auto weakest = std::min_element(list.begin(), list.end(), [](const auto& a, const auto& b) {
    return a.amplitude < b.amplitude;
  });
  if (arrival.amplitude > weakest->amplitude) *weakest = rounded(arrival);
}

}  // namespace asdic::like_bellhop
