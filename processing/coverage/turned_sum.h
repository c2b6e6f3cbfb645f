#pragma once
#include <complex>
#include <cstddef>
#include <vector>

namespace asdic::detail {

/// Sums over all pairs (i, j) of sounds whose phases turn over a cell, each pair by the Gaussian of
/// what the two turn against one another, Δ: K = e^{−½|Δ|²}.
///
///   power  Σ_i Σ_j p_i·p_j*·K_ij    open  the same of the second pressure
///   kept   Σ_i Σ_j |p_i|²·|p_j|²·K_ij²
///
/// One by one while there are few. Of many, those that turn by more than 4.2 against one another
/// are passed over in order of one phase; or, where they lie close, all are put on a grid of phases
/// a quarter of a radian wide, by cubics, on which the Gaussian is a product of two lines of
/// weights. The grid is right to some 10⁻³ of Σ|p|²: its cubics miss a Gaussian by 3/128·h⁴·3.
class TurnedSum {
 public:
  struct Sound {
    std::complex<double> pressure, open;
    double along, across;  ///< phases, in standard deviations [rad]
    double power;          ///< |pressure|²
  };
  struct Sums {
    double power = 0.0, open = 0.0, kept = 0.0;
  };

  /// That many are added up one by one, in their order.
  static constexpr std::size_t few = 400;

  /// \param sounds  are put in another order where they are many
  [[nodiscard]] Sums operator()(std::vector<Sound>& sounds);

  /// The two ways of many, whatever is cheaper; for tests.
  [[nodiscard]] static Sums one_by_one(std::vector<Sound>& sounds);
  [[nodiscard]] Sums on_grid(const std::vector<Sound>& sounds);

 private:
  std::vector<double> grid_, along_, blurred_;  // used again
};

}  // namespace asdic::detail
