#pragma once
#include <array>
#include <complex>
#include <optional>
#include <vector>

#include "io/bellhop/bellhop_files.h"
#include "io/compare/statistics.h"

namespace asdic::detail::compare {

struct FieldOptions {
  double floor_db = 120.0;  ///< cells are compared where both transmission losses are below this
  double min_range = 0.0;   ///< and at least this far from the source [m]
  bool resample = false;    ///< take from A the cells of B's grid, where it has them (within 1 mm)
};

/// Two pressure fields on one grid; B is the reference. TL = −20·log₁₀|p|, ΔTL = TL(A) − TL(B).
///
/// The complex measures weight pressures with √r, because a field that loses 1/r would be ruled by
/// its nearest cells. They mean little for incoherent fields, whose pressures have no phase.
struct FieldDifference {
  std::size_t cells = 0, compared = 0;
  std::size_t not_finite = 0;  ///< cells with a NaN or an infinity in either file
  std::size_t one_sided = 0;   ///< cells below the floor in one file only
  double one_sided_pct = 0.0;  ///< of the cells below the floor in either: those in one only
  Spread tl_db;                ///< ΔTL
  static constexpr std::array within_db = {0.01, 0.1, 0.5, 1.0, 3.0};
  std::array<double, within_db.size()> within_pct{};  ///< share of cells with |ΔTL| ≤ within_db
  double tl_correlation = 1.0;                        ///< Pearson's, of the two maps
  double relative_error = 0.0;                        ///< ‖a − b‖ / ‖b‖
  double complex_correlation = 1.0;                   ///< |⟨a, b⟩| / (‖a‖ ‖b‖)
  double mean_phase_deg = 0.0;                        ///< arg ⟨b, a⟩: by how much A leads
  Spread phase_deg;                                   ///< arg(a·b*)
  double level_db = 0.0;  ///< 10·log₁₀ Σ r|a|² / Σ r|b|²: the incoherent mean level of A over B's

  /// Of the cells that should be compared (below the floor in either file, or not finite) those
  /// that could be.
  [[nodiscard]] double compared_pct() const noexcept {
    return share_pct(compared, compared + one_sided + not_finite);
  }
};

/// Fields that can be put side by side: B's grid, and A's pressures on it.
struct AlignedFields {
  std::vector<double> source_depths, receiver_depths, receiver_ranges;  ///< [m], B's
  bool irregular = false;
  std::vector<std::complex<float>> a, b;  ///< [planes × sources × rows × ranges]
};

/// \throws InputError{where: "grid"} that says which axis differs, where the grids differ (with
///         `resample`: where B asks for a cell that A has not)
[[nodiscard]] AlignedFields align(const bellhop::ShadeFile& a, const bellhop::ShadeFile& b,
                                  bool resample);

[[nodiscard]] FieldDifference compare_fields(const AlignedFields& fields,
                                             const FieldOptions& options = {});
[[nodiscard]] FieldDifference compare_fields(const bellhop::ShadeFile& a,
                                             const bellhop::ShadeFile& b,
                                             const FieldOptions& options = {});

}  // namespace asdic::detail::compare
