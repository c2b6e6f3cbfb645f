#include "sonar/signal/band_response.h"

#include <algorithm>
#include <cmath>

namespace asdic::detail {
namespace {

constexpr double response_error = 1e-4;  // of the response, −80 dB
constexpr std::size_t most_nodes = 64;

}  // namespace

double BandNodes::product(std::size_t k, double frequency) const noexcept {
  if (frequencies.size() < 2) return 1.0;
  const double unit = 2.0 / half_width;
  double product = 1.0;
  for (std::size_t j = 0; j < frequencies.size(); ++j)
    if (j != k) product *= unit * (frequency - frequencies[j]);
  return product;
}

std::size_t nodes_for(double nepers, double radians, double error) {
  for (std::size_t count = 1; count < most_nodes; ++count) {
    double least = infinity;
    double rho = 1.05;
    while (rho < 1e6) {
      const double growth = 0.5 * nepers * (rho + 1.0 / rho) + 0.5 * radians * (rho - 1.0 / rho);
      least = std::min(least, std::log(4.0 / (rho - 1.0)) + growth +
                                  (1.0 - static_cast<double>(count)) * std::log(rho));
      rho *= 1.1;
    }
    if (least <= std::log(error)) return count;
  }
  return most_nodes;
}

BandNodes chebyshev_nodes(double centre, double half_width, std::size_t count) {
  BandNodes nodes{.centre = centre, .half_width = half_width, .frequencies = {}};
  for (std::size_t k = 0; k < count; ++k)
    nodes.frequencies.push_back(centre - half_width * std::cos(pi * (static_cast<double>(k) + 0.5) /
                                                               static_cast<double>(count)));
  return nodes;
}

BandNodes band_nodes(double centre, double half_width, double nepers, double delay) {
  return chebyshev_nodes(centre, half_width,
                         nodes_for(nepers, pi * half_width * delay, response_error));
}

}  // namespace asdic::detail
