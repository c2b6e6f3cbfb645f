#pragma once
#include <compare>
#include <vector>

#include "raytrace/arrivals.h"
#include "raytrace/like_bellhop/beam.h"

namespace asdic::like_bellhop {

/// Sums of pressure or intensity at receivers, in float32 (or float64) and in the order of arrival.
template <class Real>
class FieldSums {
 public:
  FieldSums(FieldKind kind, std::size_t columns, std::size_t size)
      : kind_(kind), columns_(columns), sum_(size) {}

  /// Adds a contribution of a geometric beam: A·exp(−i(ωτ − φ)), or (A·e^{ω·Im τ})²·W.
  void add(const Contribution& c, double omega) noexcept;
  /// Adds a pressure (coherent) or its squared magnitude.
  void add(std::size_t row, std::size_t column, std::complex<double> pressure) noexcept;

  [[nodiscard]] FieldKind kind() const noexcept { return kind_; }
  [[nodiscard]] const std::vector<std::complex<Real>>& sums() const noexcept { return sum_; }

 private:
  FieldKind kind_;
  std::size_t columns_;
  std::vector<std::complex<Real>> sum_;  // [rows × columns]
};

/// One arrival as BELLHOP stores it.
struct StoredArrival {
  double amplitude = 0.0;  ///< spreading by range left out
  double phase = 0.0;      ///< not wrapped [rad]
  std::complex<double> tau;
  double launch_declination = 0.0, arrival_declination = 0.0;  ///< [rad]
  int surface_bounces = 0, bottom_bounces = 0;
};

/// Arrivals of all receivers, with BELLHOP's merging (only with the last one stored at the receiver),
/// its limit of storage and its float32.
class ArrivalStore {
 public:
  ArrivalStore(std::size_t receivers, bool merge, bool single_precision);
  void add(std::size_t receiver, const StoredArrival& arrival, double omega);
  [[nodiscard]] const std::vector<StoredArrival>& at(std::size_t receiver) const noexcept {
    return stored_[receiver];
  }

 private:
  [[nodiscard]] StoredArrival rounded(StoredArrival a) const noexcept;
  std::vector<std::vector<StoredArrival>> stored_;
  std::size_t most_;  // per receiver
  bool merge_, single_precision_;
};

/// A beam that passes over a receiver: the eigenray is the ray up to the segment's end.
struct EigenrayHit {
  std::size_t beam = 0, segment = 0, column = 0, row = 0;
  [[nodiscard]] auto operator<=>(const EigenrayHit&) const noexcept = default;
};

}  // namespace asdic::like_bellhop
