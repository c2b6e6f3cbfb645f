#include "processing/mvdr.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "raytrace/parallel/parallel.h"

namespace asdic::detail {
namespace {

using Matrix = Eigen::MatrixXcd;
using Vector = Eigen::VectorXcd;

void load(Matrix& covariance, double loading) {
  const double mean = covariance.trace().real() / static_cast<double>(covariance.rows());
  // Silence has no covariance: the weights become the conventional ones.
  covariance.diagonal().array() += mean > 0.0 ? loading * mean : 1.0;
}

/// w out of a factorised, loaded covariance.
Vector weights_for(const Eigen::LLT<Matrix>& factor, const Vector& steering) {
  const Vector solved = factor.solve(steering);
  return solved / steering.dot(solved).real();
}

/// w of a covariance V·diag(λ)·Vᴴ, loaded as much more as keeps |w|² within `most`/N.
class ConstrainedWeights {
 public:
  ConstrainedWeights(const Matrix& covariance, double most)
      : principal_(covariance), most_(most), spread_(covariance.rows()) {}

  void operator()(const Vector& steering, Vector& w) {
    const auto n = static_cast<double>(steering.size());
    rotated_.noalias() = principal_.eigenvectors().adjoint() * steering;
    spread_ = rotated_.cwiseAbs2();
    // |w|² = Σ|b|²/(λ + μ)² / (Σ|b|²/(λ + μ))², b = Vᴴa, falls with μ towards 1/N.
    const Eigen::ArrayXd& power = spread_;
    const Eigen::ArrayXd lambda = principal_.eigenvalues().array();
    const auto norm = [&](double mu) {
      return n * (power / (lambda + mu).square()).sum() /
             std::pow((power / (lambda + mu)).sum(), 2.0);
    };
    double mu = 0.0;
    if (norm(0.0) > most_) {
      double low = std::log(1e-3 * lambda[0]), high = std::log(1e3 * lambda[lambda.size() - 1]);
      for (int i = 0; i < 24; ++i) {
        const double middle = 0.5 * (low + high);
        (norm(std::exp(middle)) > most_ ? low : high) = middle;
      }
      mu = std::exp(high);
    }
    const double sum = (power / (lambda + mu)).sum();
    rotated_.array() /= (lambda + mu) * sum;
    w.noalias() = principal_.eigenvectors() * rotated_;
  }

 private:
  Eigen::SelfAdjointEigenSolver<Matrix> principal_;
  double most_;
  Eigen::ArrayXd spread_;
  Vector rotated_;
};

/// The record as blocks: [channels × blocks × bins].
struct Blocks {
  std::size_t length = 0, hop = 0, count = 0;
  std::vector<float> window;                 // root of Hann's
  std::vector<std::complex<float>> spectra;  // [channels × count × length]

  Blocks(const Baseband& b, double transit_time) {
    // A bin is a tenth of a cycle wide over the time sound takes across the array.
    const double wanted = 10.0 * transit_time * b.sample_rate;
    length = fast_fft_length(static_cast<std::size_t>(std::max(16.0, std::ceil(wanted))));
    length += length % 2;
    hop = length / 2;
    count = b.samples / hop + 2;  // the first begins half a block before the record
    for (std::size_t i = 0; i < length; ++i)
      window.push_back(static_cast<float>(
          std::sin(pi * (static_cast<double>(i) + 0.5) / static_cast<double>(length))));
    spectra.resize(b.channels * count * length);
    const ComplexFft<float> fft(length);
    in_parallel(b.channels, [&](std::size_t c) {
      FftBuffer<std::complex<float>> work(length);
      const auto row = b.channel(c);
      for (std::size_t j = 0; j < count; ++j) {
        for (std::size_t i = 0; i < length; ++i) {
          const std::size_t at = j * hop + i;  // half a block ahead of the sample
          work[i] = at >= hop && at - hop < row.size() ? window[i] * row[at - hop]
                                                       : std::complex<float>(0.0F);
        }
        fft.forward(work.data());
        std::copy_n(work.data(), length, spectra.data() + (c * count + j) * length);
      }
    });
  }
  [[nodiscard]] std::complex<double> at(std::size_t c, std::size_t j, std::size_t k) const {
    return std::complex<double>(spectra[(c * count + j) * length + k]);
  }
};

double transit_time(std::span<const Vec3> phones, double sound_speed) {
  double longest = 0.0;
  for (const Vec3& a : phones)
    for (const Vec3& b : phones) longest = std::max(longest, (a - b).norm());
  return longest / sound_speed;
}

}  // namespace

std::vector<std::complex<double>> mvdr_weights(std::span<const std::complex<double>> covariance,
                                               std::span<const std::complex<double>> steering,
                                               double loading) {
  const auto n = static_cast<Eigen::Index>(steering.size());
  Matrix r(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j) r(i, j) = covariance[static_cast<std::size_t>(i * n + j)];
  load(r, loading);
  const Vector a = Eigen::Map<const Vector>(steering.data(), n);
  const Vector w = weights_for(Eigen::LLT<Matrix>(r), a);
  return {w.data(), w.data() + n};
}

BeamSpectra mvdr_beams(const Baseband& baseband, std::span<const Vec3> phones,
                       std::span<const Vec3> looks, double sound_speed,
                       const MvdrSettings& settings) {
  const std::size_t n = phones.size(), beams = looks.size();
  const double loading = power_from_db(settings.loading_db);
  const Blocks blocks(baseband, transit_time(phones, sound_speed));
  // Blocks that share weights, and those around them that the covariance is averaged over.
  const auto snapshots = std::max<std::size_t>(
      4, static_cast<std::size_t>(settings.snapshots_per_phone * static_cast<double>(n)));
  const std::size_t group = std::max<std::size_t>(1, snapshots / 4);
  const std::size_t groups = (blocks.count + group - 1) / group;

  BeamSpectra result{.beams = beams,
                     .bins = baseband.samples,
                     .stride = FftBuffer<std::complex<float>>::row_stride(baseband.samples),
                     .values = {}};
  result.values = FftBuffer<std::complex<float>>(beams * result.stride);
  // Spectra of the beams' blocks: [beams × count × length].
  std::vector<std::complex<float>> received(beams * blocks.count * blocks.length);
  in_parallel(groups, [&](std::size_t g) {
    const std::size_t begin = g * group, end = std::min(begin + group, blocks.count);
    const std::size_t wing = (snapshots - group) / 2;
    const std::size_t from = begin > wing ? begin - wing : 0;
    const std::size_t to = std::min(end + wing, blocks.count);
    Matrix covariance(n, n);
    Vector snapshot(n), steering(n), w(n);
    for (std::size_t k = 0; k < blocks.length; ++k) {
      covariance.setZero();
      for (std::size_t j = from; j < to; ++j) {
        for (std::size_t c = 0; c < n; ++c)
          snapshot[static_cast<Eigen::Index>(c)] = blocks.at(c, j, k);
        covariance.selfadjointView<Eigen::Lower>().rankUpdate(snapshot);
      }
      covariance /= static_cast<double>(to - from);
      load(covariance, loading);
      ConstrainedWeights weights(covariance, power_from_db(settings.most_noise_db));
      const double bin = k < (blocks.length + 1) / 2
                             ? static_cast<double>(k)
                             : static_cast<double>(k) - static_cast<double>(blocks.length);
      const double frequency =
          baseband.carrier + bin * baseband.sample_rate / static_cast<double>(blocks.length);
      for (std::size_t b = 0; b < beams; ++b) {
        for (std::size_t c = 0; c < n; ++c)
          steering[static_cast<Eigen::Index>(c)] = std::polar(
              1.0, std::remainder(2.0 * pi * frequency * looks[b].dot(phones[c]) / sound_speed,
                                  2.0 * pi));
        weights(steering, w);
        for (std::size_t j = begin; j < end; ++j) {
          std::complex<double> sum = 0.0;
          for (std::size_t c = 0; c < n; ++c)
            sum += std::conj(w[static_cast<Eigen::Index>(c)]) * blocks.at(c, j, k);
          received[(b * blocks.count + j) * blocks.length + k] = std::complex<float>(sum);
        }
      }
    }
  });
  const ComplexFft<float> back(blocks.length), fft(baseband.samples);
  in_parallel(beams, [&](std::size_t b) {
    FftBuffer<std::complex<float>> work(blocks.length);
    std::complex<float>* row = result.beam(b);
    for (std::size_t j = 0; j < blocks.count; ++j) {
      std::copy_n(received.data() + (b * blocks.count + j) * blocks.length, blocks.length,
                  work.data());
      back.inverse(work.data());
      for (std::size_t i = 0; i < blocks.length; ++i) {
        const std::size_t at = j * blocks.hop + i;
        if (at >= blocks.hop && at - blocks.hop < baseband.samples)
          row[at - blocks.hop] += work[i] * (blocks.window[i] / static_cast<float>(blocks.length));
      }
    }
    fft.forward(row);
  });
  return result;
}

}  // namespace asdic::detail
