// Solutions of the depth equation for several wavenumbers side by side, against one by one.
#include "raytrace/waves/depth_waves.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <vector>

#include "core/units.h"

namespace asdic::detail {
namespace {

using Complex = std::complex<double>;

struct Piece {
  double from, to, thickness;  // speeds [m/s], [m]
};

// Pieces that waves go through, turn in, are far from or die out in, of slopes of either sign, with
// and without loss. Both forms have the same formulas, so that only roundings differ.
TEST(DepthWaves, AreThoseOfEachWavenumber) {
  const std::vector<Piece> pieces = {{1500.0, 1500.0, 20.0}, {1500.0, 1500.001, 50.0},
                                     {1480.0, 1520.0, 30.0}, {1520.0, 1480.0, 30.0},
                                     {1490.0, 1500.0, 2.0},  {1560.0, 1540.0, 15.0}};
  for (const double f : {30.0, 400.0, 3500.0})
    for (const double loss : {0.0, 1e-4})
      for (const Piece& piece : pieces)
        for (const double cosine : {0.3, 0.9, 0.98, 0.999}) {
          const double omega = 2.0 * pi * f;
          const Complex a(omega / piece.from, -loss), b(omega / piece.to, -loss);
          const Complex from = a * a, to = b * b;
          const Wavenumbers xi(7, [&](std::size_t lane) {
            return Complex(omega / 1500.0 * (cosine + 0.002 * double(lane)), 1e-5 * f);
          });
          DepthWaves waves;
          for (std::size_t l = 0; l < DepthWaves::count; ++l)
            waves.set(l, {.u = {1.0, 0.1 * double(l)}, .du = {0.0, omega / 1500.0}});
          DepthWaves begun = waves;
          follow(waves, xi, from, to, piece.thickness);
          for (std::size_t l = 0; l < DepthWaves::count; ++l) {
            DepthWave one = begun.get(l);
            const Complex square = xi.xi[l] * xi.xi[l];
            follow(one, from - square, to - square, piece.thickness);
            const DepthWave side = waves.get(l);
            const double scale = std::exp(side.growth - one.growth), k = std::abs(a);
            const double size = std::abs(one.u) + std::abs(one.du) / k;
            EXPECT_LT(std::abs(side.u * scale - one.u), 1e-9 * size)
                << f << " Hz, " << piece.from << " to " << piece.to << ", " << cosine << ", " << l;
            EXPECT_LT(std::abs(side.du * scale - one.du) / k, 1e-9 * size)
                << f << " Hz, " << piece.from << " to " << piece.to << ", " << cosine << ", " << l;
          }
        }
}

}  // namespace
}  // namespace asdic::detail
