#include "processing/array_shape.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/geometry.h"

namespace asdic::detail {
namespace {

/// Extent across a line, in wavelengths, from which on a shape tells elevation. About the
/// horizontal the wave's component along a bend of extent W changes by 1 − cos e; phones that are
/// spread by σ = 0.3·W (an even spread 0.29, an arc 0.30) lose 3 dB where 2πσ(1 − cos e)/λ is √(ln
/// 2) = 0.83: at e = 45° for W = 1.5λ.
constexpr double slight_bend = 1.5;
constexpr double slight_sag = 0.88;  // one that hangs down: sin e, 3 dB at 30°
constexpr double much_longer = 4.0;  // than wide: else it is no line at all

double extent(std::span<const Vec3> phones, const Vec3& along) {
  double low = infinity, high = -infinity;
  for (const Vec3& x : phones) {
    low = std::min(low, along.dot(x));
    high = std::max(high, along.dot(x));
  }
  return high - low;
}

double power_towards(std::span<const std::complex<double>> snapshot, std::span<const Vec3> phones,
                     const Vec3& centre, std::span<const double> weights, const Vec3& look,
                     double wavenumber) {
  std::complex<double> sum = 0.0;
  for (std::size_t n = 0; n < phones.size(); ++n)
    sum += weights[n] * snapshot[n] * std::polar(1.0, -wavenumber * look.dot(phones[n] - centre));
  return std::norm(sum);
}

/// Offset of the top of the parabola through three powers at −1, 0, 1, at most one step.
double top_of(double before, double here, double after) {
  const double bend = before - 2.0 * here + after;
  if (!(bend < 0.0)) return after > before ? 1.0 : -1.0;
  return std::clamp(0.5 * (before - after) / bend, -1.0, 1.0);
}

}  // namespace

Vec3 mirrored(const ArrayShape& shape, const Vec3& look) {
  if (shape.kind == ArrayKind::line) {
    const Vec3 right = right_of(shape.axis);
    return look - 2.0 * look.dot(right) * right;
  }
  if (shape.kind == ArrayKind::plane && !shape.bent)
    return look - 2.0 * look.dot(shape.normal) * shape.normal;
  return look;
}

Vec3 right_of(const Vec3& axis) {
  const double horizontal = std::hypot(axis.x(), axis.y());
  if (horizontal > 1e-6) return Vec3(axis.y(), -axis.x(), 0.0) / horizontal;
  return Vec3::UnitY();
}

ArrayShape shape_of(std::span<const Vec3> phones, double wavelength) {
  ArrayShape shape;
  if (phones.empty()) return shape;
  shape.centre = std::accumulate(phones.begin(), phones.end(), Vec3(Vec3::Zero())) /
                 static_cast<double>(phones.size());
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const Vec3& x : phones) scatter += (x - shape.centre) * (x - shape.centre).transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> principal(scatter);
  const Vec3 longest = principal.eigenvectors().col(2), middle = principal.eigenvectors().col(1),
             shortest = principal.eigenvectors().col(0);
  shape.length = extent(phones, longest);
  shape.height = extent(phones, Vec3::UnitZ());
  for (int i = 0; i < 36; ++i)
    shape.breadth = std::max(shape.breadth, extent(phones, direction(pi / 36.0 * i, 0.0)));
  const double thin = 0.25 * wavelength;  // from side to side
  if (shape.length < thin) return shape;
  shape.axis = longest.dot(phones.back() - phones.front()) < 0.0 ? Vec3(-longest) : longest;
  shape.normal = shortest;
  shape.across = middle;
  shape.width = extent(phones, middle);
  if (shape.width < thin) {
    shape.kind = ArrayKind::line;
    return shape;
  }
  const bool lying = std::abs(shape.axis.z()) <= std::sqrt(0.5);
  const bool sideways = extent(phones, right_of(shape.axis)) >= thin;
  if (lying && shape.width < (sideways ? slight_bend : slight_sag) * wavelength &&
      shape.length > much_longer * shape.width) {
    shape.bent = sideways;  // a bow that only sags tells no side either
    shape.kind = sideways ? ArrayKind::plane : ArrayKind::line;
    return shape;
  }
  shape.kind = extent(phones, shortest) < thin ? ArrayKind::plane : ArrayKind::volume;
  return shape;
}

Vec3 on_cone(const Vec3& axis, double cosine) {
  const double c = std::clamp(cosine, -1.0, 1.0);
  return (c * axis + std::sqrt(1.0 - c * c) * right_of(axis)).normalized();
}

BeamGrid beam_grid(const ArrayShape& shape, double wavelength, double lowest, double highest) {
  BeamGrid grid;
  if (shape.kind == ArrayKind::point) {
    grid.looks = {Vec3::UnitY()};
    grid.spacing = 2.0;
    return grid;
  }
  const double step = 0.5 * wavelength / shape.length;
  if (shape.kind == ArrayKind::line) {
    const int half = std::max(1, static_cast<int>(std::ceil(1.0 / step)));
    for (int i = -half; i <= half; ++i) {
      grid.cosine.push_back(static_cast<double>(i) / half);
      grid.looks.push_back(on_cone(shape.axis, grid.cosine.back()));
    }
    grid.spacing = 1.0 / half;
    return grid;
  }
  grid.spacing = std::min(step, 0.5);
  if (shape.bent) {
    const int count = static_cast<int>(std::ceil(2.0 * pi / step));
    for (int i = 0; i < count; ++i)
      grid.looks.push_back(direction(2.0 * pi / count * i, std::clamp(0.0, lowest, highest)));
    return grid;
  }
  const auto add = [&](const Vec3& look) {
    // Of a plane's two mirror images the one on the side of its normal; in the plane, both are one.
    if (shape.kind == ArrayKind::volume || look.dot(shape.normal) > -1e-9)
      grid.looks.push_back(look);
  };
  for (double elevation = std::max(lowest, -0.5 * pi);;) {
    const double across_row = shape.breadth * std::cos(elevation);
    const int count =
        std::max(1, static_cast<int>(std::ceil(2.0 * pi * across_row / (0.5 * wavelength))));
    for (int i = 0; i < count; ++i) add(direction(2.0 * pi / count * i, elevation));
    if (elevation >= highest) break;
    // Phases change with elevation by the height's cos and the breadth's sin of it.
    const double reach = shape.height * std::cos(elevation) +
                         shape.breadth * std::max(std::abs(std::sin(elevation)), 0.25);
    elevation = std::min(elevation + std::min(0.5 * wavelength / reach, 0.5), highest);
  }
  if (grid.looks.empty()) grid.looks.push_back(direction(0.0, 0.5 * (lowest + highest)));
  return grid;
}

std::vector<double> shading(std::span<const Vec3> phones, bool hann) {
  std::vector<double> weights(phones.size(), 1.0);
  if (hann && phones.size() > 2) {
    const ArrayShape shape = shape_of(phones, 0.0);
    // Zero one half spacing beyond the ends: no phone is wasted.
    const double width = shape.length * (1.0 + 1.0 / static_cast<double>(phones.size() - 1));
    for (std::size_t n = 0; n < phones.size(); ++n) {
      const double x = shape.axis.dot(phones[n] - shape.centre) / width;
      weights[n] = std::pow(std::cos(pi * std::clamp(x, -0.5, 0.5)), 2);
    }
  }
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  for (double& w : weights) w /= sum;
  return weights;
}

std::vector<std::complex<double>> steering_vector(std::span<const Vec3> phones, const Vec3& centre,
                                                  const Vec3& look, double wavenumber) {
  std::vector<std::complex<double>> steering;
  for (const Vec3& x : phones)
    steering.push_back(std::polar(1.0, wavenumber * look.dot(x - centre)));
  return steering;
}

double beam_pattern(std::span<const Vec3> phones, std::span<const double> weights,
                    const Vec3& steered, const Vec3& from, double wavenumber) {
  std::complex<double> sum = 0.0;
  const Vec3 difference = from - steered;
  for (std::size_t n = 0; n < phones.size(); ++n)
    sum += std::polar(weights[n], wavenumber * difference.dot(phones[n]));
  return std::norm(sum);
}

Vec3 refine_direction(std::span<const std::complex<double>> snapshot, std::span<const Vec3> phones,
                      const ArrayShape& shape, std::span<const double> weights, const Vec3& look,
                      double step, double wavenumber) {
  const auto power = [&](const Vec3& u) {
    return power_towards(snapshot, phones, shape.centre, weights, u, wavenumber);
  };
  if (shape.kind == ArrayKind::point) return look;
  if (shape.kind == ArrayKind::line) {
    double cosine = look.dot(shape.axis);
    const auto at = [&](double c) {  // beyond the axis the phases go on: a line's beam depends on c
      std::complex<double> sum = 0.0;
      for (std::size_t n = 0; n < phones.size(); ++n)
        sum += weights[n] * snapshot[n] *
               std::polar(1.0, -wavenumber * c * shape.axis.dot(phones[n] - shape.centre));
      return std::norm(sum);
    };
    double h = 0.5 * step;
    while (h > 1e-6) {
      cosine += h * top_of(at(cosine - h), at(cosine), at(cosine + h));
      h *= 0.6;
    }
    return on_cone(shape.axis, cosine);
  }
  double bearing = std::atan2(look.x(), look.y()),
         elevation = std::asin(std::clamp(-look.z(), -1.0, 1.0));
  double h = 0.5 * step;
  while (h > 1e-6) {
    const double here = power(direction(bearing, elevation));
    const double turn = h / std::max(std::cos(elevation), 0.1);
    bearing += turn * top_of(power(direction(bearing - turn, elevation)), here,
                             power(direction(bearing + turn, elevation)));
    if (!shape.bent) {
      const double again = power(direction(bearing, elevation));
      elevation += h * top_of(power(direction(bearing, elevation - h)), again,
                              power(direction(bearing, elevation + h)));
      elevation = std::clamp(elevation, -0.5 * pi, 0.5 * pi);
    }
    h *= 0.7;
  }
  return direction(bearing, elevation);
}

}  // namespace asdic::detail
