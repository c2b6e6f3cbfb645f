#pragma once
#include <compare>
#include <vector>

#include "raytrace/bellhop_emulation/beam.h"
#include "raytrace/ocean/arrivals.h"

namespace asdic::detail::bellhop_emulation {

/// Sums of pressure or intensity at receivers, in float32 (or float64) and in the order of arrival.
template <class Real>
class FieldSums {
 public:
  FieldSums(FieldKind kind, std::size_t columns, std::size_t size)
      : kind_(kind), columns_(columns), sum_(size) {}

  /// Adds a contribution of a geometric beam: A·exp(−i(ωτ − φ)), or (A·e^{ω·Im τ})²·W.
  void add(const Contribution& c, double omega) noexcept;
  /// Adds a pressure times its weight (coherent), or its squared magnitude times the weight.
  void add(std::size_t row, std::size_t column, std::complex<double> pressure,
           double weight) noexcept;

  [[nodiscard]] FieldKind kind() const noexcept { return kind_; }
  [[nodiscard]] const std::vector<std::complex<Real>>& sums() const noexcept { return sum_; }

 private:
  FieldKind kind_;
  std::size_t columns_;
  std::vector<std::complex<Real>> sum_;  // [rows × columns]
};

/// One arrival as BELLHOP stores it, in float32 (or float64).
template <class Real>
struct StoredArrival {
  Real amplitude = 0;  ///< spreading by range left out
  Real phase = 0;      ///< not wrapped [rad]
  std::complex<Real> tau;
  Real launch_declination = 0, arrival_declination = 0;  ///< [rad]
  int surface_bounces = 0, bottom_bounces = 0;
};

/// Arrivals of all receivers, with BELLHOP's merging (only with the last one stored at the
/// receiver) and its limit of storage.
template <class Real>
class ArrivalStore {
 public:
  ArrivalStore(std::size_t receivers, bool merge);
  void add(std::size_t receiver, const Contribution& c, double launch_declination, double omega);
  [[nodiscard]] const std::vector<StoredArrival<Real>>& at(std::size_t receiver) const noexcept {
    return stored_[receiver];
  }

 private:
  std::vector<std::vector<StoredArrival<Real>>> stored_;
  std::size_t most_;  // per receiver
  bool merge_;
};

/// A beam that passes over a receiver: the eigenray is the ray up to the segment's end.
struct EigenrayHit {
  std::size_t beam = 0, segment = 0, column = 0, row = 0;
  [[nodiscard]] auto operator<=>(const EigenrayHit&) const noexcept = default;
};

}  // namespace asdic::detail::bellhop_emulation
