#include "processing/factor_estimate.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <vector>

#include "core/random.h"
#include "core/units.h"
#include "processing/matched_filter.h"

namespace asdic::detail {
namespace {

/// Of the factors' span in which a filter answers within 3 dB, measured with echoes of 40 dB.
constexpr double error_of_table = 0.004;

/// A root R of a covariance, R·Rᴴ, but for what is 30 dB below its diagonal: Cholesky's, the
/// largest first. Neighbouring filters have little of their own. \return [n × rank]
Eigen::MatrixXcd root_of(const Eigen::MatrixXcd& covariance) {
  constexpr double least = 1e-3;
  const Eigen::Index n = covariance.rows();
  Eigen::MatrixXcd root(n, n);
  Eigen::VectorXd left = covariance.diagonal().real();
  Eigen::Index rank = 0, at = 0;
  for (; rank < n && left.maxCoeff(&at) > least; ++rank) {
    root.col(rank) =
        (covariance.col(at) - root.leftCols(rank) * root.row(at).head(rank).adjoint()) /
        std::sqrt(left[at]);
    left -= root.col(rank).cwiseAbs2();
    left[at] = 0.0;
  }
  return root.leftCols(rank);
}

}  // namespace

RidgeDelay::RidgeDelay(const Replica& replica, double reach, int sub_bands) {
  const double above = doppler_answer(replica, 1.0 + reach, sub_bands).delay,
               below = doppler_answer(replica, 1.0 - reach, sub_bands).delay;
  slope_ = 0.5 * (above - below) / reach;
  bend_ = 0.5 * (above + below) / (reach * reach);
}

FactorEstimate::FactorEstimate(const Replica& replica, double apart, double cell, int sub_bands)
    : apart_(apart), floor_(error_of_table * 2.0 * cell) {
  const auto rho = [&](double echo, double filter) {  // both from the loudest filter's factor
    const double ratio = (1.0 + echo) / (1.0 + filter);
    return std::max(doppler_answer(replica, ratio, sub_bands).response, 1e-6);
  };
  double near = 0.0;
  for (int k = -side; k <= side; ++k) {
    const double offset = k * apart / side, above = rho(offset, apart), below = rho(offset, -apart);
    difference_[static_cast<std::size_t>(k + side)] = 2.0 * std::log(above) - 2.0 * std::log(below);
    if (k == 0) near = 0.5 * (above + below);
  }
  const double slope = (difference_[side + 1] - difference_[side - 1]) / (2.0 * apart / side);
  const double far = std::min(rho(apart, -apart), 1.0);
  unit_ = slope > 0.0 ? 2.0 * std::sqrt((1.0 - far) / sub_bands) / (near * slope) : apart;
}

double FactorEstimate::offset(double difference) const noexcept {
  const double step = apart_ / side;
  for (int k = -side; k < side; ++k) {
    const double low = difference_[static_cast<std::size_t>(k + side)],
                 high = difference_[static_cast<std::size_t>(k + side + 1)];
    if (difference >= high && k + 1 < side) continue;
    if (!(high > low)) return k * step;
    return step * (k + std::clamp((difference - low) / (high - low), 0.0, 1.0));
  }
  return apart_;
}

double FactorEstimate::sigma(double snr) const noexcept {
  const double s = std::max(snr - 1.0, 0.1);
  const double level = std::clamp(db_from_power(s), nodes.front(), nodes.back());
  const auto above = std::upper_bound(nodes.begin() + 1, nodes.end() - 1, level);
  const auto i = static_cast<std::size_t>(above - nodes.begin());
  const double part = (level - nodes[i - 1]) / (nodes[i] - nodes[i - 1]);
  const double log_g = log_g_[i - 1] + part * (log_g_[i] - log_g_[i - 1]);
  return std::hypot(plain(s) * std::exp(log_g), floor_);
}

void FactorEstimate::simulated(const Scatter& scatter) noexcept {
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (scatter[i] > 0.0) log_g_[i] = std::log(scatter[i] / plain(power_from_db(nodes[i])));
}

/// Echoes in noise as a bank's filters have them where each answers most: the products of the
/// filters' spectra are the echo's answers and the noise's covariance. A sub-band is cut at other
/// frequencies in each filter, so that neighbouring ones of two filters share noise.
class FactorFinder::Simulation {
 public:
  Simulation(const Replica& replica, double step, const RidgeDelay& late, std::ptrdiff_t side,
             int sub_bands)
      : step_(step), side_(side), parts_(sub_bands) {
    // A pulse is told by values 1/T apart; products along the ridge are as long as two.
    spacing_ = 0.5 / replica.duration();
    const double room = 0.25 * replica.bandwidth();
    const double reach = 1.0 + step * static_cast<double>(side);
    first_ = (replica.lowest_frequency() - room) / reach;
    bins_ = static_cast<Eigen::Index>(
        std::ceil(((replica.highest_frequency() + room) * reach - first_) / spacing_));
    Eigen::MatrixXcd filter(bins_, filters());
    for (Eigen::Index m = 0; m < filters(); ++m) filter.col(m) = along(replica, late, factor_of(m));
    const std::vector<double> cuts = sub_band_edges(replica, sub_bands);
    const auto from = [&](Eigen::Index m, Eigen::Index part) -> Eigen::Index {  // its first bin
      if (part == 0) return 0;
      if (part == parts_) return bins_;
      const double cut = cuts[static_cast<std::size_t>(part - 1)] * factor_of(m);
      return std::clamp<Eigen::Index>(
          static_cast<Eigen::Index>(std::ceil((cut - first_) / spacing_)), 0, bins_);
    };
    for (Eigen::Index m = 0; m < filters(); ++m)  // each sub-band's noise is 1
      for (Eigen::Index part = 0; part < parts_; ++part) {
        auto band = filter.col(m).segment(from(m, part), from(m, part + 1) - from(m, part));
        band /= std::max(band.norm(), std::numeric_limits<double>::min());
      }
    constexpr Eigen::Index delays = 17;
    const double cell = sub_bands / replica.noise_bandwidth();  // of time
    const double apart = cell / static_cast<double>(delays - 1);
    Eigen::MatrixXcd ramps(bins_, delays);
    for (Eigen::Index t = 0; t < delays; ++t)
      ramps.col(t) = ramp(apart * static_cast<double>(t - delays / 2));
    for (Eigen::Index e = 0; e < offsets; ++e) {
      Eigen::VectorXcd echo = along(replica, late, 1.0 + step * offset_of(e));
      echo *= std::sqrt(static_cast<double>(sub_bands)) / echo.norm();  // each sub-band has 1
      Eigen::MatrixXcd at_top = filter;
      for (Eigen::Index m = 0; m < filters(); ++m) {
        Eigen::VectorXd power = Eigen::VectorXd::Zero(delays);
        const Eigen::VectorXcd cross = filter.col(m).conjugate().cwiseProduct(echo);
        for (Eigen::Index part = 0; part < parts_; ++part) {
          const Eigen::Index i = from(m, part), n = from(m, part + 1) - i;
          power += (ramps.middleRows(i, n).adjoint() * cross.segment(i, n)).cwiseAbs2();
        }
        Eigen::Index t = 0;
        power.maxCoeff(&t);
        double top = static_cast<double>(t - delays / 2);
        if (t > 0 && t < delays - 1)
          top += 0.5 * (power[t - 1] - power[t + 1]) /
                 std::min(power[t - 1] - 2.0 * power[t] + power[t + 1], -1e-9);
        at_top.col(m).array() *= ramp(apart * top).array();
      }
      const Eigen::Index rows = filters() * parts_;
      Eigen::VectorXcd answer(rows);
      Eigen::MatrixXcd covariance = Eigen::MatrixXcd::Zero(rows, rows);
      for (Eigen::Index m = 0; m < filters(); ++m)
        for (Eigen::Index part = 0; part < parts_; ++part) {
          const Eigen::Index i = from(m, part), end = from(m, part + 1), row = m * parts_ + part;
          answer[row] = at_top.col(m).segment(i, end - i).dot(echo.segment(i, end - i));
          for (Eigen::Index k = m; k < filters(); ++k)
            for (Eigen::Index other = 0; other < parts_; ++other) {
              const Eigen::Index both = std::max(i, from(k, other)),
                                 stop = std::min(end, from(k, other + 1));
              if (both >= stop) continue;
              const std::complex<double> shared =
                  at_top.col(m)
                      .segment(both, stop - both)
                      .dot(at_top.col(k).segment(both, stop - both));
              covariance(row, k * parts_ + other) = shared;
              covariance(k * parts_ + other, row) = std::conj(shared);
            }
        }
      answer_.push_back(std::move(answer));
      noise_.push_back(root_of(covariance));
    }
  }

  /// Root mean square of the errors of those within the 3 dB span that `counted` told.
  /// \param last  the bank's last filter
  [[nodiscard]] FactorEstimate::Scatter operator()(const FactorFinder& finder, std::ptrdiff_t last,
                                                   const FactorEstimate& counted) const {
    constexpr int draws = 512;
    constexpr std::uint64_t seed = 0x646f70706c6572;  // its own
    FactorEstimate::Scatter sum{}, number{};
    Eigen::VectorXcd white, noise, received;
    Eigen::VectorXd power(filters());
    for (int draw = 0; draw < draws; ++draw) {
      RandomStream stream(seed, Draw::study_noise, static_cast<std::uint32_t>(draw), 0);
      const auto e = static_cast<std::size_t>(draw % offsets);
      white.resize(noise_[e].cols());
      for (auto& w : white) w = stream.complex_normal();
      noise.noalias() = noise_[e] * white;
      for (std::size_t i = 0; i < sum.size(); ++i) {
        received = std::sqrt(power_from_db(FactorEstimate::nodes[i])) * answer_[e] + noise;
        for (Eigen::Index m = 0; m < filters(); ++m)
          power[m] = received.segment(m * parts_, parts_).squaredNorm();
        Eigen::Index loudest = 0;
        power.head(last + 1).maxCoeff(&loudest);
        const FactorFound found =
            finder.find(static_cast<std::size_t>(loudest), static_cast<std::size_t>(last),
                        [&](std::size_t f, std::size_t /*from*/) {
                          return std::log(power[static_cast<Eigen::Index>(f)]);
                        });
        const double error =
            step_ * (static_cast<double>(found.middle) - static_cast<double>(side_) -
                     offset_of(static_cast<Eigen::Index>(e))) +
            found.offset;
        if (found.estimate != &counted || std::abs(error) > finder.cell_) continue;
        sum[i] += error * error;
        number[i] += 1.0;
      }
    }
    constexpr double few = 0.1 * draws;
    for (std::size_t i = 0; i < sum.size(); ++i)
      sum[i] = number[i] > few ? std::sqrt(sum[i] / number[i]) : 0.0;
    return sum;
  }

 private:
  static constexpr Eigen::Index offsets = 4;  // of echoes, even between two filters' middles
  static double offset_of(Eigen::Index e) {
    return (static_cast<double>(e) + 0.5) / static_cast<double>(offsets) - 0.5;
  }
  [[nodiscard]] Eigen::Index filters() const { return 2 * side_ + 1; }
  [[nodiscard]] double factor_of(Eigen::Index m) const {
    return 1.0 + step_ * static_cast<double>(m - side_);
  }
  /// \return [bins] what a delay makes of a spectrum
  [[nodiscard]] Eigen::VectorXcd ramp(double delay) const {
    Eigen::VectorXcd turns(bins_);
    for (Eigen::Index k = 0; k < bins_; ++k)
      turns[k] = std::polar(1.0, -2.0 * pi * (first_ + static_cast<double>(k) * spacing_) * delay);
    return turns;
  }
  /// \return [bins] spectrum of an echo that the middle filter has at 0
  [[nodiscard]] Eigen::VectorXcd along(const Replica& replica, const RidgeDelay& late,
                                       double factor) const {
    Eigen::VectorXcd spectrum = ramp(late(1.0, factor));
    for (Eigen::Index k = 0; k < bins_; ++k)
      spectrum[k] *= replica.spectrum(first_ + static_cast<double>(k) * spacing_, factor);
    return spectrum;
  }

  double step_ = 0.0, first_ = 0.0, spacing_ = 0.0;  // of the bins [Hz]
  std::ptrdiff_t side_ = 0;                          // filters to either side
  Eigen::Index parts_ = 1, bins_ = 0;
  std::vector<Eigen::VectorXcd> answer_;  // [offsets] filters × sub-bands
  std::vector<Eigen::MatrixXcd> noise_;   // [offsets] root of their covariance
};

FactorFinder::FactorFinder(const Replica& replica, double step, std::size_t filters, double cell,
                           int sub_bands)
    : step_(step), cell_(cell) {
  // Filters this far apart differ by more than the jitter of the top, also for a pulse whose answer
  // falls with |offset|. A narrower bank has no such filters.
  constexpr double wide = 0.27;
  const double wanted = std::max(1.0, std::round(wide * 2.0 * cell / step));
  late_ = RidgeDelay(replica, wanted * step, sub_bands);
  aside_ = static_cast<std::size_t>(std::min(wanted, static_cast<double>((filters - 1) / 2)));
  const double apart = static_cast<double>(aside_) * step;
  close_ = FactorEstimate(replica, step, cell, sub_bands);
  const auto side = static_cast<std::ptrdiff_t>(2 * aside_ + 1);
  const Simulation simulation(replica, step, late_, side, sub_bands);
  if (aside_ > 1) {
    wide_ = FactorEstimate(replica, apart, cell, sub_bands);
    wide_.simulated(simulation(*this, 2 * side, wide_));
  }
  // Of several filters aside the close ones tell at the bank's ends alone.
  close_.simulated(simulation(*this, aside_ > 1 ? side + 1 : 2 * side, close_));
}

}  // namespace asdic::detail
