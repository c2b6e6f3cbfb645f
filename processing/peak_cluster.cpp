#include "processing/peak_cluster.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <tuple>

#include "raytrace/parallel/parallel.h"

namespace asdic::detail {
namespace {

/// Echoes are not as clean as the pulse: nothing this much weaker beside a loud one is believed.
constexpr double cleanest = 1e-5;

}  // namespace

LeakTable::LeakTable(const Replica& replica, const MatchedFilterBank& bank, const RidgeDelay& late)
    : late_(late),
      lowest_(bank.doppler(0)),
      step_(bank.filters() > 1 ? bank.doppler(1) - bank.doppler(0) : 0.0),
      rate_(bank.sample_rate()),
      reach_(static_cast<std::ptrdiff_t>(std::ceil(1.1 * replica.duration() * bank.sample_rate()))),
      filters_(static_cast<std::ptrdiff_t>(bank.filters())) {
  const std::ptrdiff_t width = 2 * reach_ + 1;
  std::vector<double> delays;
  for (std::ptrdiff_t i = -reach_; i <= reach_; ++i)
    delays.push_back(static_cast<double>(i) / bank.sample_rate());
  values_.assign(static_cast<std::size_t>((2 * filters_ - 1) * width), 0.0F);
  // The cross spectrum of two factors, transformed at the rate of the filters' output.
  const double spacing = 1.0 / (3.0 * replica.duration());
  const auto n = fast_fft_length(static_cast<std::size_t>(std::ceil(bank.sample_rate() / spacing)));
  const double fine = bank.sample_rate() / static_cast<double>(n);
  static_cast<void>(ComplexFft<double>(n));
  const std::vector<double> cuts = sub_band_edges(replica, bank.sub_bands());
  in_parallel(static_cast<std::size_t>(2 * filters_ - 1), [&](std::size_t row_number) {
    const std::ptrdiff_t k = static_cast<std::ptrdiff_t>(row_number) + 1 - filters_;
    const double doppler = 1.0 + step_ * static_cast<double>(k);
    const double low = replica.lowest_frequency() - 0.25 * replica.bandwidth(),
                 high = replica.highest_frequency() + 0.25 * replica.bandwidth();
    if (low * doppler > high || high * doppler < low) return;  // apart in frequency
    FftBuffer<std::complex<double>> work(n);
    std::vector<double> power(n, 0.0);
    const auto bins = static_cast<std::size_t>((high - low) / fine);
    std::size_t i_bin = 0;
    for (std::size_t part = 0; part <= cuts.size(); ++part) {
      if (part > 0) work.clear();
      for (; i_bin < bins && i_bin < n; ++i_bin) {
        const double f = low + static_cast<double>(i_bin) * fine;
        if (part < cuts.size() && f >= cuts[part] * doppler) break;
        work[i_bin] = replica.spectrum(f) * std::conj(replica.spectrum(f, doppler));
      }
      ComplexFft<double>(n).inverse(work.data());
      for (std::size_t i = 0; i < n; ++i) power[i] += std::norm(work[i]);
    }
    // eq. (3) of an echo s₊(t) in the filter of factor 1 + k·step; the mean of the sub-bands
    const double scale =
        std::pow(fine * doppler / replica.energy(), 2.0) * static_cast<double>(cuts.size() + 1);
    float* row = values_.data() + (k + filters_ - 1) * width;
    const auto size = static_cast<std::ptrdiff_t>(n);
    for (std::ptrdiff_t i = -reach_; i <= reach_; ++i) {
      double most = 0.0;  // between samples as well
      for (std::ptrdiff_t j = i - 1; j <= i + 1; ++j)
        most = std::max(most, power[static_cast<std::size_t>(((j % size) + size) % size)]);
      row[i + reach_] = static_cast<float>(scale * most);
    }
  });
}

double LeakTable::at(std::ptrdiff_t samples, std::size_t matched,
                     std::size_t filter) const noexcept {
  const auto filters = static_cast<std::ptrdiff_t>(filter) - static_cast<std::ptrdiff_t>(matched);
  if (std::abs(filters) >= filters_) return 0.0;
  const auto factor = [&](std::size_t f) { return lowest_ + step_ * static_cast<double>(f); };
  const double told = late_(1.0, 1.0 + step_ * static_cast<double>(filters)),
               later = late_(factor(matched), factor(filter)) - told;
  samples -= std::lround(later * rate_);
  if (std::abs(samples) > reach_) return 0.0;
  return static_cast<double>(values_[static_cast<std::size_t>(
      (filters + filters_ - 1) * (2 * reach_ + 1) + samples + reach_)]);
}

std::vector<std::size_t> independent_peaks(
    const std::vector<Peak>& peaks, const LeakTable& leaks,
    const std::function<void(std::size_t)>& keep,
    const std::function<double(std::size_t, std::size_t)>& beam_leak, double margin,
    std::size_t most, bool together) {
  std::vector<std::size_t> order(peaks.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    const Peak &p = peaks[a], &q = peaks[b];
    return std::tuple(-p.power, p.beam, p.filter, p.sample) <
           std::tuple(-q.power, q.beam, q.filter, q.sample);
  });
  std::multimap<std::ptrdiff_t, std::size_t> kept;  // by sample
  std::vector<std::size_t> result;
  for (const std::size_t i : order) {
    const Peak& p = peaks[i];
    const auto sample = static_cast<std::ptrdiff_t>(p.sample);
    bool explained = false;
    double before = 0.0;  // that those looked at so far leak together
    for (auto it = kept.lower_bound(sample - leaks.reach());
         it != kept.end() && it->first <= sample + leaks.reach() && !explained; ++it) {
      const Peak& loud = peaks[it->second];
      const double in_time = leaks.at(sample - it->first, loud.filter, p.filter);
      const double leak = std::max(in_time * beam_leak(it->second, p.beam), cleanest);
      const double all = before + leak * static_cast<double>(loud.power);
      explained = static_cast<double>(p.power) < margin * all + static_cast<double>(p.threshold);
      if (together) before = all;
    }
    if (explained) continue;
    kept.emplace(sample, i);
    keep(i);
    result.push_back(i);
    if (result.size() == most) break;
  }
  return result;
}

}  // namespace asdic::detail
