#pragma once
#include <array>
#include <complex>
#include <functional>
#include <memory>
#include <vector>

#include "raytrace/layered/branch.h"
#include "raytrace/ocean/arrivals.h"
#include "raytrace/ocean/environment.h"
#include "raytrace/waves/water_window.h"

namespace asdic::detail {

/// Layers times wavenumbers of one pair of depths at one frequency: some tenths of a second of one
/// core. A target under way asks for it every few wavelengths.
inline constexpr double most_cycle_steps = 5e5;

/// Key of a BranchWaves, within one ocean.
struct BranchNeed {
  double upper, lower;         ///< depths of the ends [m]
  double frequency, furthest;  ///< [Hz], range [m]
  double steepest;             ///< wavenumber from which on all is summed in full [1/m]
};
/// \param rays  found between the two depths
[[nodiscard]] BranchNeed branch_need(const Environment& ocean, double upper, double lower,
                                     double range, double frequency, const Arrivals& rays);

/// The waves of each history that a ray may have between two depths, whole: those that leave and
/// arrive upward or downward with so many cycles between. With each other's reflection V_u above
/// and V_v below, at the upper end and at the lower one (′),
///
///   g = −2/W·T·(up + V_u·down)·(down′ + V_v′·up′)·Σ (V_u·V_v)^n
///
/// exactly, whatever is called up and down; T is what comes from the upper end to the lower one.
/// Each term is one integral over wavenumbers. So the boundaries reflect a spherical wave, where a
/// ray has their reflection at its own angle alone. docs/theory/waves.md, "Off the boundaries"
///
/// Wavenumbers that are as good as horizontal at an end, so that up and down are one, fade out.
class BranchWaves {
 public:
  /// \param ocean  is_layered()   \throws Interrupted
  BranchWaves(const Environment& ocean, const BranchNeed& need);

  /// False where it would have taken more than `most_cycle_steps` or the edges of its window do not
  /// fit: then there is nothing.
  [[nodiscard]] bool affordable() const noexcept { return !kernels_.empty(); }
  [[nodiscard]] std::size_t bytes() const noexcept;

  /// Weight of a wavenumber in the sums, 0 … 1. \param wavenumber  [1/m]
  [[nodiscard]] double share(double wavenumber) const noexcept;

  /// p of all histories with up to so many cycles. \param range  up to the furthest [m]
  /// \return [kind][cycles + 1]
  [[nodiscard]] std::array<std::vector<std::complex<double>>, 4> pressures(double range,
                                                                           int cycles) const;
  struct Place {
    int kind, cycles;
  };
  /// Finds the history of a ray. \param from_upper  as it goes from the upper end to the
  /// lower one   \param turns_above, turns_below  its vertices are turning points
  [[nodiscard]] Place place_of(Branch from_upper, double wavenumber, bool turns_above,
                               bool turns_below) const noexcept;

 private:
  /// k² at an end, its slope, and whether waves notice that.
  struct End {
    double k2, slope;
    bool noticed;
    [[nodiscard]] double airy(double wavenumber) const noexcept;
    [[nodiscard]] double resolved(double wavenumber) const noexcept;
    [[nodiscard]] bool is_level(double wavenumber) const noexcept;
  };
  /// Integrand at one wavenumber, times WaterWindow::factor().
  struct Kernel {
    std::array<std::complex<double>, 4> first;
    std::complex<double> cycle;
  };
  [[nodiscard]] Kernel kernel(const WaveColumn::AtDepths& at,
                              std::complex<double> xi) const noexcept;

  WaterWindow window_;
  std::array<WaveColumn::Squared, 2> k2_;
  std::array<End, 2> ends_;      // upper, lower
  std::vector<Kernel> kernels_;  // [window_.count]
};

using BranchMaker = std::function<std::shared_ptr<BranchWaves>()>;
/// Gives what is known, or makes it and keeps it.
using BranchKeeper =
    std::function<std::shared_ptr<const BranchWaves>(const BranchNeed&, const BranchMaker&)>;

}  // namespace asdic::detail
