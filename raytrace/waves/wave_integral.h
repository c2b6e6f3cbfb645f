#pragma once
#include <complex>
#include <functional>
#include <span>
#include <vector>

#include "raytrace/waves/wave_column.h"

namespace asdic::detail {

/// p(r) = ∫ ξ·g(ξ)·J₀(ξr) dξ at ranges from r = 0 to a largest one, by even sampling of a contour
/// above the real axis. docs/theory/waves.md, "The integral over wavenumbers"
///
/// At `near` and beyond, the outgoing half of J₀ alone, without launches steeper than 84 to 89°;
/// what the sampling adds, the field one period further out, is 80 dB below itself. Nearer by: J₀,
/// all of it.
class WaveIntegral {
 public:
  /// \param column  kept by reference   \param rows  receivers of the column
  WaveIntegral(const WaveColumn& column, std::size_t rows, double depth,
               std::span<const double> ranges);

  /// Layers times wavenumbers: what it costs, each some 0.1 µs.
  [[nodiscard]] double steps() const noexcept;
  [[nodiscard]] std::size_t wavenumbers() const noexcept { return far_.count + near_.count; }
  [[nodiscard]] double bytes() const noexcept;

  /// \param progress  called with the share that is done; false: stop
  /// \return [rows × ranges], range fastest   \throws Interrupted
  [[nodiscard]] std::vector<std::complex<double>> field(
      const std::function<bool(double)>& progress = {}) const;

 private:
  /// ξ = (j + ½)·spacing + i·offset, weighted from nothing to one and back.
  struct Contour {
    double spacing = 0.0, offset = 0.0, period = 0.0;
    double steepest = 0.0, steep_width = 0.0;  ///< wavenumbers below are left out [1/m]
    double flattest = 0.0, flat_width = 0.0;   ///< and above
    std::size_t first = 0, count = 0;
    [[nodiscard]] std::complex<double> at(std::size_t j) const noexcept;
    [[nodiscard]] double weight(std::size_t j) const noexcept;
  };
  Contour far_contour() const;
  Contour near_contour() const;
  void kernels(const Contour& contour, std::size_t first, std::size_t count,
               std::vector<std::complex<double>>& g) const;
  void add_far(std::vector<std::complex<double>>& field,
               const std::function<void(double)>& done) const;
  void add_near(std::vector<std::complex<double>>& field,
                const std::function<void(double)>& done) const;

  const WaveColumn& column_;
  std::size_t rows_;
  double depth_;
  std::vector<double> ranges_;
  std::vector<std::size_t> near_columns_, far_columns_;
  double near_range_ = 0.0;
  Contour near_, far_;
};

/// J₀ of a complex number: its power series up to |z| = 12, beyond it four terms of Hankel's
/// expansion. 1e-7 of e^{|Im z|}.
[[nodiscard]] std::complex<double> bessel_j0(std::complex<double> z) noexcept;

}  // namespace asdic::detail
