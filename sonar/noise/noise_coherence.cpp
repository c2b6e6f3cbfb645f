#include "sonar/noise/noise_coherence.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

#include "core/propagation_memory.h"
#include "raytrace/parallel/parallel.h"
#include "sonar/signal/windowed_sinc.h"

namespace asdic::detail {
namespace {

using Matrix = Eigen::MatrixXcd;

constexpr double loading = 1e-6;  // ε

/// Gauss–Legendre nodes on (−1, 1) by Newton's method from Tricomi's places.
struct Rule {
  std::vector<double> node, weight;

  explicit Rule(int n) : node(static_cast<std::size_t>(n)), weight(static_cast<std::size_t>(n)) {
    for (int i = 0; i < n; ++i) {
      double x = std::cos(pi * (i + 0.75) / (n + 0.5)), slope = 1.0;
      for (int step = 0; step < 6; ++step) {
        double p = 1.0, before = 0.0;
        for (int k = 1; k <= n; ++k) {
          const double next = ((2.0 * k - 1.0) * x * p - (k - 1.0) * before) / k;
          before = p;
          p = next;
        }
        slope = n * (x * p - before) / (x * x - 1.0);
        x -= p / slope;
      }
      node[static_cast<std::size_t>(i)] = x;
      weight[static_cast<std::size_t>(i)] = 2.0 / ((1.0 - x * x) * slope * slope);
    }
  }
};

/// Where noise comes from as a sum of cones: μ = sin ε and weights that add up to 1.
struct Cones {
  std::vector<double> sine, cosine, weight;

  void add(double elevation, double w) {
    sine.push_back(std::sin(elevation));
    cosine.push_back(std::cos(elevation));
    weight.push_back(w);
  }
};

/// Gauss–Legendre over elevation in every segment on which the law is smooth, enough nodes for a
/// phase of `reach` = k·d radians to be resolved.
Cones cones_of(NoiseCoherence kind, const NoiseDirections& directions, double reach) {
  std::vector<double> ends;
  if (kind == NoiseCoherence::surface) ends = {0.0, 0.5 * pi};
  if (kind == NoiseCoherence::profile) {
    ends = {-0.5 * pi};
    for (const double e : directions.elevation)
      if (e > ends.back() + 1e-9 && e < 0.5 * pi - 1e-9) ends.push_back(e);
    ends.push_back(0.5 * pi);
  }
  const auto density = [&](double elevation) {  // per solid angle
    if (kind == NoiseCoherence::surface)
      return std::pow(std::sin(elevation), 2.0 * directions.dipole_exponent - 1.0);
    const auto& e = directions.elevation;
    const auto& level = directions.level_db;
    if (elevation <= e.front()) return power_from_db(level.front());
    if (elevation >= e.back()) return power_from_db(level.back());
    const auto i =
        static_cast<std::size_t>(std::upper_bound(e.begin(), e.end(), elevation) - e.begin()) - 1;
    return power_from_db(std::lerp(level[i], level[i + 1], (elevation - e[i]) / (e[i + 1] - e[i])));
  };
  // e^{iax} over |x| ≤ 1 is right to 10⁻¹⁰ by 4 + ¾a + min(a, 12) nodes, and what changes by as
  // many nepers. Powers of the sine are no polynomials: there more.
  const auto nodes = [&](double half, double phase, double first, double last) {
    const double a = half + phase + 0.5 * std::abs(std::log(last / first));
    return static_cast<int>(std::ceil(kind == NoiseCoherence::profile
                                          ? 4.0 + 0.75 * a + std::min(a, 12.0)
                                          : 16.0 + 0.75 * phase));
  };
  Cones cones;
  double sum = 0.0;
  std::map<int, Rule> rules;
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
    const double half = 0.5 * (ends[i + 1] - ends[i]), middle = 0.5 * (ends[i + 1] + ends[i]);
    const int n = nodes(half, reach * half, density(ends[i]), density(ends[i + 1]));
    const Rule& rule = rules.try_emplace(n, n).first->second;
    for (std::size_t j = 0; j < rule.node.size(); ++j) {
      const double elevation = middle + half * rule.node[j];
      const double w = half * rule.weight[j] * density(elevation) * std::cos(elevation);
      cones.add(elevation, w);
      sum += w;
    }
  }
  for (double& w : cones.weight) w /= sum;
  return cones;
}

/// Σ w J₀(kh cos ε) e^{−ik Δz sin ε}
std::complex<double> sum_of(const Cones& cones, double across, double down) {
  std::complex<double> sum = 0.0;
  for (std::size_t i = 0; i < cones.weight.size(); ++i) {
    const double j = across == 0.0 ? 1.0 : ::j0(across * cones.cosine[i]);
    sum += cones.weight[i] * j * std::polar(1.0, -down * cones.sine[i]);
  }
  return sum;
}

/// Σ w J₀(x cos ε) over x = kh: the coherence of phones side by side, at all frequencies. By cubics
/// between sixteenths (Catmull & Rom), to 10⁻⁶.
class SideBySide {
 public:
  SideBySide(const Cones& cones, double longest)
      : value_(static_cast<std::size_t>(std::ceil(longest * per_radian)) + 4) {
    constexpr std::size_t at_once = 64;
    in_parallel((value_.size() + at_once - 1) / at_once, [&](std::size_t part) {
      for (std::size_t i = part * at_once; i < std::min((part + 1) * at_once, value_.size()); ++i)
        value_[i] = sum_of(cones, std::abs(static_cast<double>(i) - 1.0) / per_radian, 0.0).real();
    });
  }
  [[nodiscard]] double at(double x) const {
    const double place = x * per_radian;
    const auto i = std::min(static_cast<std::size_t>(place), value_.size() - 4);
    const double t = place - static_cast<double>(i), u = 1.0 - t;
    return -0.5 * t * u * u * value_[i] + u * (1.0 + t - 1.5 * t * t) * value_[i + 1] +
           t * (1.0 + u - 1.5 * u * u) * value_[i + 2] - 0.5 * u * t * t * value_[i + 3];
  }

 private:
  static constexpr double per_radian = 16.0;
  std::vector<double> value_;  // at x = (i − 1)/per_radian
};

/// Separations of an array's pairs, each of those that are alike once.
class Separations {
 public:
  explicit Separations(std::span<const Vec3> phones) : phones_(phones.size()) {
    std::map<std::pair<long long, long long>, std::size_t> known;
    constexpr double grain = 1e-7;  // [m]
    for (std::size_t i = 0; i < phones.size(); ++i) {
      for (std::size_t j = 0; j <= i; ++j) {
        const Vec3 apart = phones[i] - phones[j];
        const double across = apart.head<2>().norm(), down = apart.z();
        const bool turned = down < -0.5 * grain;
        const std::pair key(std::llround(across / grain), std::llround(std::abs(down) / grain));
        const auto [place, fresh] = known.try_emplace(key, across_.size());
        if (fresh) {
          across_.push_back(across);
          down_.push_back(std::abs(down));
          reach_ = std::max(reach_, apart.norm());
        }
        index_.push_back(place->second);
        turned_.push_back(turned);
      }
    }
  }

  [[nodiscard]] double reach() const { return reach_; }  ///< the longest [m]
  /// Whether all phones lie side by side.
  [[nodiscard]] bool level() const {
    return std::all_of(down_.begin(), down_.end(), [](double z) { return z == 0.0; });
  }

  /// Γ + εI over 1 + ε.
  [[nodiscard]] Matrix matrix(NoiseCoherence kind, const NoiseDirections& directions, double k,
                              const SideBySide* table) const {
    std::vector<std::complex<double>> value(across_.size());
    const bool summed = kind != NoiseCoherence::isotropic && table == nullptr;
    const Cones cones = summed ? cones_of(kind, directions, k * reach_) : Cones{};
    for (std::size_t s = 0; s < value.size(); ++s)
      value[s] = summed             ? sum_of(cones, k * across_[s], k * down_[s])
                 : table != nullptr ? table->at(k * across_[s])
                                    : sine_over(k * std::hypot(across_[s], down_[s]));
    const auto n = static_cast<Eigen::Index>(phones_);
    Matrix gamma(n, n);
    std::size_t pair = 0;
    for (Eigen::Index i = 0; i < n; ++i) {
      for (Eigen::Index j = 0; j <= i; ++j, ++pair) {
        const std::complex<double> g = value[index_[pair]] / (1.0 + loading);
        gamma(i, j) = i == j ? 1.0 : turned_[pair] ? std::conj(g) : g;
        gamma(j, i) = std::conj(gamma(i, j));
      }
    }
    return gamma;
  }

 private:
  std::size_t phones_;
  double reach_ = 0.0;
  std::vector<double> across_, down_;  // of the different ones [m]
  std::vector<std::size_t> index_;     // [pairs] which of them
  std::vector<bool> turned_;           // [pairs] with the sign of `down` changed
};

/// Cholesky's factor. A pivot that rounding has left below zero is none.
Matrix factor_of(const Matrix& gamma) {
  const Eigen::Index n = gamma.rows();
  Matrix l = Matrix::Zero(n, n);
  for (Eigen::Index j = 0; j < n; ++j) {
    const double pivot = gamma(j, j).real() - l.row(j).head(j).squaredNorm();
    if (pivot < 1e-12) continue;
    l(j, j) = std::sqrt(pivot);
    for (Eigen::Index i = j + 1; i < n; ++i)
      l(i, j) = (gamma(i, j) - l.row(j).head(j).dot(l.row(i).head(j))) / l(j, j);  // conj of row j
  }
  return l;
}

struct Node {
  std::size_t bin;
  Matrix gamma, factor;
};

/// What is kept of a node: its triangle, row by row.
struct Packed {
  std::size_t bin;
  std::vector<std::complex<float>> factor;
};

Packed packed(const Node& node) {
  Packed kept{.bin = node.bin, .factor = {}};
  for (Eigen::Index i = 0; i < node.factor.rows(); ++i)
    for (Eigen::Index j = 0; j <= i; ++j)
      kept.factor.push_back(std::complex<float>(node.factor(i, j)));
  return kept;
}

}  // namespace

std::complex<double> noise_coherence(NoiseCoherence kind, const NoiseDirections& directions,
                                     const Vec3& apart, double wavenumber) {
  const double d = apart.norm();
  if (kind == NoiseCoherence::independent) return d == 0.0 ? 1.0 : 0.0;
  if (kind == NoiseCoherence::isotropic) return sine_over(wavenumber * d);
  return sum_of(cones_of(kind, directions, wavenumber * d), wavenumber * apart.head<2>().norm(),
                wavenumber * apart.z());
}

CoherenceFactors::CoherenceFactors(NoiseCoherence kind, const NoiseDirections& directions,
                                   std::span<const Vec3> phones, double sound_speed, double first,
                                   double step, std::size_t bins)
    : phones_(phones.size()) {
  const Separations separations(phones);
  const double longest =
      2.0 * pi * (first + static_cast<double>(bins) * step) / sound_speed * separations.reach();
  std::optional<SideBySide> table;
  if (kind != NoiseCoherence::isotropic && separations.level())
    table.emplace(cones_of(kind, directions, longest), longest);
  const auto node = [&](std::size_t bin) {
    const double f = std::max(0.0, first + static_cast<double>(bin) * step);
    Node made{
        bin,
        separations.matrix(kind, directions, 2.0 * pi * f / sound_speed, table ? &*table : nullptr),
        {}};
    made.factor = factor_of(made.gamma);
    return made;
  };
  // Segments of about a radian of the longest separation, each then halved as needed.
  const double per_bin = 2.0 * pi * step / sound_speed * separations.reach();
  const auto segment = static_cast<std::size_t>(
      std::clamp(std::ceil(1.0 / std::max(per_bin, 1e-9)), 1.0, static_cast<double>(bins)));
  const std::size_t last = bins - 1,
                    segments = std::max<std::size_t>(1, (last + segment - 1) / segment);
  const std::size_t pairs = phones_ * (phones_ + 1) / 2;
  std::vector<std::vector<Packed>> found(segments);
  in_parallel(segments, [&](std::size_t s) {
    Node left = node(s * segment);
    found[s].push_back(packed(left));
    std::vector<Node> waiting;  // right ends, the nearest last
    waiting.push_back(node(std::min(last, (s + 1) * segment)));
    while (!waiting.empty()) {
      const Node& right = waiting.back();
      if (right.bin > left.bin + 1) {
        Node half = node(left.bin + (right.bin - left.bin) / 2);
        const double a =
            static_cast<double>(half.bin - left.bin) / static_cast<double>(right.bin - left.bin);
        const Matrix l = (1.0 - a) * left.factor + a * right.factor;
        if ((l * l.adjoint() - half.gamma).cwiseAbs().maxCoeff() > tolerance) {
          waiting.push_back(std::move(half));
          continue;
        }
      }
      left = std::move(waiting.back());
      waiting.pop_back();
      // A segment's right end is the next one's first node.
      if (!waiting.empty() || (s + 1 == segments && left.bin > found[s].back().bin))
        found[s].push_back(packed(left));
    }
  });
  std::vector<const Packed*> all;
  for (const auto& some : found)
    for (const Packed& one : some) all.push_back(&one);
  const std::size_t n = all.size();
  factor_.resize(pairs * n);
  for (std::size_t i = 0; i < n; ++i) {
    nodes_.push_back(all[i]->bin);
    for (std::size_t pair = 0; pair < pairs; ++pair) {
      factor_[pair * n + i] = all[i]->factor[pair];
      if (std::abs(factor_[pair * n + i].imag()) > 1e-7F) real_ = false;
    }
  }
}

std::shared_ptr<const CoherenceFactors> CoherenceFactors::recalled(
    PropagationMemory* memory, NoiseCoherence kind, const NoiseDirections& directions,
    std::span<const Vec3> phones, double sound_speed, double first, double step, std::size_t bins) {
  const auto made = [&] {
    return std::make_shared<CoherenceFactors>(kind, directions, phones, sound_speed, first, step,
                                              bins);
  };
  if (memory == nullptr) return made();
  return memory->remember(ExactKey(Kept::noise_factors, 0, NoiseField{kind, directions}, phones,
                                   sound_speed, first, step, bins),
                          made);
}

std::size_t CoherenceFactors::bytes() const noexcept {
  return sizeof *this + nodes_.capacity() * sizeof(nodes_[0]) +
         factor_.capacity() * sizeof(factor_[0]);
}

void CoherenceFactors::element(std::size_t row, std::size_t column, std::size_t first,
                               std::span<float> real, std::span<float> imaginary) const noexcept {
  const std::size_t n = nodes_.size();
  const std::complex<float>* at = factor_.data() + (row * (row + 1) / 2 + column) * n;
  if (n < 2) {
    std::ranges::fill(real, at->real());
    std::ranges::fill(imaginary, at->imag());
    return;
  }
  const std::size_t end = first + real.size();
  const auto next = std::upper_bound(nodes_.begin() + 1, nodes_.end() - 1, first);
  auto k = static_cast<std::size_t>(next - nodes_.begin()) - 1;
  for (std::size_t bin = first; bin < end; ++k) {  // the straight piece from node k on
    const std::size_t stop = k + 2 < n ? std::min(end, nodes_[k + 1]) : end;
    const auto wide = static_cast<float>(nodes_[k + 1] - nodes_[k]);
    const float re = at[k].real(), im = at[k].imag();
    const float more_re = at[k + 1].real() - re, more_im = at[k + 1].imag() - im;
    auto past = static_cast<std::int32_t>(bin - nodes_[k]);
    for (; bin < stop; ++bin, ++past) {
      const float t = static_cast<float>(past) / wide;
      real[bin - first] = re + t * more_re;
      imaginary[bin - first] = im + t * more_im;
    }
  }
}

}  // namespace asdic::detail
