#pragma once
#include <complex>
#include <functional>
#include <memory>
#include <vector>

#include "raytrace/layered/branch.h"
#include "raytrace/ocean/arrivals.h"
#include "raytrace/paths/eigenrays.h"
#include "raytrace/waves/branch_waves.h"
#include "raytrace/waves/water_window.h"

namespace asdic::detail {

/// The field of one range by the number of cycles, turn above and turn below, that its waves have
/// gone through. With u, the solution that obeys the surface, and v, that obeys the bottom, as a
/// wave that goes down and one that goes up, each other's reflection V_u and V_v,
///
///   g = −2·u·v/(W·(1 − V_u·V_v)) = −2·u·v/W·Σ (V_u·V_v)^n
///
/// exactly, turns beside corners, barriers, caustics, cusps and foci included; a term is one
/// integral over wavenumbers, of those that stay in the water. docs/theory/waves.md, "Cycles"
///
/// Good for all ranges up to a furthest, by the kernels of its wavenumbers, which are all the cost.
class CycleWaves {
 public:
  /// \param ocean  is_layered()   \param furthest  range [m]   \throws Interrupted
  CycleWaves(const Environment& ocean, double frequency, double source_depth, double receiver_depth,
             double furthest);

  /// False where it would have taken more than `most_cycle_steps`: then there is nothing.
  [[nodiscard]] bool affordable() const noexcept { return affordable_; }
  [[nodiscard]] const WaterWindow& window() const noexcept { return window_; }
  [[nodiscard]] std::size_t bytes() const noexcept;

  /// Which term the rays of a history belong to. Those that go into each other through the
  /// horizontal at source or receiver have one term.
  [[nodiscard]] int term_of(const Branch& branch) const noexcept;

  /// Share of a wavenumber's waves that is in the terms, 1 … 0. Waves so flat that a cycle is not
  /// resolved at the furthest range have no terms.   \param wavenumber  [1/m]
  [[nodiscard]] double cycled(double wavenumber) const noexcept;
  /// Approximate number of cycles of flat waves up to a range.
  [[nodiscard]] int flat_cycles(double range) const noexcept;

  /// Pressures of the first terms, followed by that of flat waves with any number of cycles
  /// \return [count + 1]
  /// \param range  up to the furthest [m]
  [[nodiscard]] std::vector<std::complex<double>> terms(std::size_t count, double range) const;

 private:
  /// Parts of g at one wavenumber, times WaterWindow::factor(): the first term, the next one, the
  /// factor from each term to the next, and the flat waves.
  struct Kernel {
    std::complex<double> first, next, cycle, flat;
  };
  [[nodiscard]] Kernel kernel(const WaveColumn::AtDepths& at,
                              std::complex<double> xi) const noexcept;

  /// Where rays that are horizontal at an end turn: both ends between two turns, above and below;
  /// above both ends; below both ends.
  enum class Turns { between, above, below };

  WaterWindow window_;
  bool source_is_upper_, affordable_ = false;
  WaveColumn::Squared slowest_;
  Turns turns_;
  double flattest_, fade_;       // wavenumber at the slowest depth; interval over which terms fade
  double least_slope_;           // least slope that waves resolve [1/m³]
  std::vector<Kernel> kernels_;  // [window_.count]
};

/// What decides a CycleWaves of one ocean, but for the boundaries that return nothing.
struct CycleNeed {
  double source_depth, receiver_depth, frequency, furthest;
  bool without_surface, without_bottom;
  [[nodiscard]] bool operator==(const CycleNeed&) const = default;
};
using CyclesMaker = std::function<std::shared_ptr<CycleWaves>()>;
/// Gives what is known, or makes it and keeps it.
using CyclesKeeper =
    std::function<std::shared_ptr<const CycleWaves>(const CycleNeed&, const CyclesMaker&)>;

/// Gives rays that ray theory gets wrong the amplitudes of waves: those at a focus, a cusp or the
/// end of their family, those that turn beside a corner of the profile, and those that boundaries
/// reflect otherwise than plane waves. What a term of CycleWaves has more than its rays is shared
/// by them, most by those whose amplitude is least sure (ray_errors.h): their sum is the waves'
/// field. Where reflection is what is wrong and no ray turns in the water, each ray has the waves
/// of its own history (BranchWaves) before. All are of kind `caustic` then, each with its own delay
/// and angles. Rays whose amplitude changes by less than 0.1 % of the whole stay as they are, and
/// all do where their errors would be 1 % of the whole at most, and where it would take more than
/// `most_cycle_steps`. What a `diffracted` arrival holds is left to it. \param solver  layered()
/// \param found  all arrivals of these places within the limits \param keeper, branches  without
/// them nothing is kept
/// \return whether they hold all that the bottom does to the field in the water, so that a
/// `diffracted` arrival is that of water without it   \throws Interrupted
bool put_waves(const EigenraySolver& solver, double source_depth, double receiver_depth,
               double range, double frequency, const PathLimits& limits, Arrivals& found,
               const CyclesKeeper& keeper = {}, const BranchKeeper& branches = {});

}  // namespace asdic::detail
