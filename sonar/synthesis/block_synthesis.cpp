#include "sonar/synthesis/block_synthesis.h"

#include <oneapi/tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cmath>

#include <oneapi/tbb/enumerable_thread_specific.h>
#include <array>
#include "core/error.h"
#include "raytrace/parallel/parallel.h"
#include "sonar/synthesis/sound_synthesis.h"
#include "sonar/synthesis/spectrum_product.h"
#include "sonar/synthesis/synthesis_bytes.h"

#include "raytrace/parallel/parallel.h"

namespace asdic::detail {

namespace {

using Scratch = FftBuffer<std::complex<float>>;

/// What transforming a grid of that length costs, counted in returns gridded for one node.
double cost_of_grid(std::size_t length) {
  const auto n = static_cast<double>(length);
  return 0.25 * n * std::log2(n);
}

/// Bands cut as is cheapest for so many returns. Errors of very many add up as energies do: their
/// impulses may be moved along the pulse's ridge, to an error that is meant so.
/// \param pulses  [responses]   \param length  of a grid
std::vector<DopplerBand> cut_for(const DopplerExpansion& expansion,
                                 std::span<const BandLimitedPulse> pulses, std::size_t length,
                                 std::vector<DopplerBand> bands, double returns) {
  constexpr double many = 20'000.0;
  const double grid_cost = cost_of_grid(length);
  if (returns < many || pulses.size() > 1)
    return expansion.cut(std::move(bands), returns, grid_cost);
  const DopplerRidge ridge(pulses.front());
  return expansion.cut(std::move(bands), returns, grid_cost, &ridge);
}

/// Room on either side of a grid for impulses that are moved by so much: whole cache lines, so that
/// the period begins on one. \param most  [samples]
std::size_t samples_beside(double most) {
  constexpr std::size_t line = 8;
  if (most == 0.0) return 0;
  return (static_cast<std::size_t>(most) + 1 + DelayKernel::taps) / line * line + line;
}

}  // namespace

SynthesisBytes synthesis_bytes(const Synthesizer& synthesizer, std::size_t phones) {
  const auto& plan = BlockSynthesis::plan_of(synthesizer);
  const double row = sizeof(std::complex<float>) * static_cast<double>(plan.length);
  const double rows = static_cast<double>(phones);
  std::size_t nodes = 0, widest = 1;
  for (const DopplerBand& band :
       plan.expansion.bands_over({{1.0 - plan.max_doppler, 1.0 + plan.max_doppler}})) {
    nodes += band.nodes.size();
    widest = std::max(widest, std::min(ImpulseGrid::most_nodes, band.nodes.size()));
  }
  // A thread's grids of a phone, or its row and the passband's bins and samples.
  const double passband =
      plan.recording.is_complex() ? 0.0 : 8.0 * static_cast<double>(plan.passband_length);
  const double of_thread = std::max(static_cast<double>(widest) * row, row + passband);
  const double threads = static_cast<double>(std::min(phones, most_workers()));
  const double spectra = sizeof(std::complex<float>) *
                         static_cast<double>(plan.pulses.size() * nodes) *
                         (2.0 * static_cast<double>(plan.highest_bin) + 1.0);
  // Grids that are kept, or the returns of a batch.
  const double grids = std::min(static_cast<double>(BlockSynthesis::most_kept),
                                rows * static_cast<double>(nodes) * row);
  return {.row = row, .all = rows * row + threads * of_thread + spectra + grids};
}

Baseband BlockSynthesis::of_list(const Synthesizer::Plan& plan, std::span<const Return> returns,
                                 std::span<const Vec3> phones) {
  std::vector<double> dopplers;
  dopplers.reserve(returns.size());
  for (const Return& r : returns) {
    assert(r.channel >= Return::all_channels && r.channel < std::ssize(phones));
    if (!(std::abs(r.doppler - 1.0) <= plan.max_doppler + 1e-12))
      throw InputError({.where = "returns.doppler",
                        .got = std::to_string(r.doppler),
                        .expected = "within the max_doppler that the synthesizer was built for"});
    dopplers.push_back(r.doppler);
  }
  auto bands =
      cut_for(plan.expansion, plan.pulses, plan.length, plan.expansion.bands(std::move(dopplers)),
              static_cast<double>(returns.size()));
  return BlockSynthesis(plan, std::move(bands), ReturnList(returns), phones).run();
}

Baseband Synthesizer::baseband(const ReturnSource& source, std::span<const Vec3> phones) const {
  const Plan& plan = *plan_;
  std::vector<DopplerSpan> spans = source.dopplers();
  for (DopplerSpan& span : spans) {
    span.lowest = std::max(span.lowest, 1.0 - plan.max_doppler);
    span.highest = std::min(span.highest, 1.0 + plan.max_doppler);
  }
  double returns = 0.0;
  for (std::size_t b = 0; b < source.blocks(); ++b)
    returns += static_cast<double>(source.expected(b));
  auto bands = cut_for(plan.expansion, plan.pulses, plan.length,
                       plan.expansion.bands_over(std::move(spans)), returns);
  return BlockSynthesis(plan, std::move(bands), source, phones).run();
}

Baseband Synthesizer::baseband(std::span<const Return> returns,
                               std::span<const Vec3> phones) const {
  return BlockSynthesis::of_list(*plan_, returns, phones);
}

Baseband BlockSynthesis::of_sound(const BandLimitedPulse& sound, const Recording& recording,
                                  double max_doppler, std::span<const Return> returns,
                                  std::span<const Vec3> phones) {
  return of_list(Synthesizer::Plan(sound, recording, max_doppler), returns, phones);
}

Baseband baseband_of(const BandLimitedPulse& sound, const Recording& recording, double max_doppler,
                     std::span<const Return> returns, std::span<const Vec3> phones) {
  return BlockSynthesis::of_sound(sound, recording, max_doppler, returns, phones);
}

const BandLimitedPulse& filtered_pulse(const Synthesizer& synthesizer) {
  return BlockSynthesis::plan_of(synthesizer).pulses.front();
}

/// From one node's grid to the next: a multiple of a cache line (8 samples) and, modulo the 64
/// lines that share a place in the first-level cache, five lines on, so that one impulse's taps in
/// sixteen grids do not evict each other.
std::size_t BlockSynthesis::grid_stride(std::size_t length) {
  std::size_t lines = FftBuffer<std::complex<float>>::row_stride(length) / 8;
  while (lines % 64 != 5) ++lines;
  return 8 * lines;
}

BlockSynthesis::BlockSynthesis(const Synthesizer::Plan& plan, std::vector<DopplerBand> bands,
                               const ReturnSource& source, std::span<const Vec3> phones)
    : plan_(plan),
      source_(source),
      phones_(phones),
      responses_(plan.pulses.size()),
      bins_(2 * static_cast<std::size_t>(plan.highest_bin) + 1),
      returns_(std::move(bands),
               {.first = plan.recording.start - static_cast<double>(plan.lead) / plan.rate,
                .rate = plan.rate,
                .carrier = plan.carrier,
                .samples = plan.length},
               plan.pulse_duration, phones.size(), responses_),
      beside_(samples_beside(returns_.latest() * plan.rate)),
      stride_(grid_stride(plan.length + 2 * beside_)),
      grid_{.kernel = plan.kernel,
            .rate = plan.rate,
            .first = plan.recording.start - static_cast<double>(plan.lead + beside_) / plan.rate,
            .carrier = plan.carrier,
            .last_position = plan.last_position + static_cast<double>(beside_),
            .stride = stride_,
            .length = plan.length + 2 * beside_,
            .first_position = static_cast<double>(DelayKernel::taps + beside_)} {}

std::vector<BlockSynthesis::Batch> BlockSynthesis::batches(bool kept) const {
  // Grids that are kept are transformed once, and batches may be small: what stays in cache is
  // ordered faster. Others are transformed after every batch: as much memory as the grids may
  // take, or as the phones' baseband takes if that is more.
  constexpr std::size_t cached = std::size_t{8} << 20;
  const std::size_t bytes =
      kept ? cached
           : std::max(most_kept, phones_.size() * plan_.length * sizeof(std::complex<float>));
  const std::size_t most = bytes / returns_.bytes_each();
  std::vector<Batch> found;
  std::size_t held = 0;
  for (std::size_t b = 0; b < source_.blocks(); ++b) {
    const std::size_t more = source_.expected(b);
    if (found.empty() || held + more > most) {
      found.push_back({b, b});
      held = 0;
    }
    held += more;
    found.back().end = b + 1;
  }
  return found;
}

std::vector<std::complex<float>> BlockSynthesis::spectra(
    const Synthesizer::Plan::Period& on) const {
  const std::size_t nodes = returns_.nodes.size();
  const std::size_t bins = 2 * static_cast<std::size_t>(on.highest_bin) + 1;
  std::vector<std::complex<float>> found(responses_ * nodes * bins);
  tbb::enumerable_thread_specific<Scratch> workspaces;
  in_parallel(responses_ * nodes, [&](std::size_t i) {
    Scratch& scratch = workspaces.local();
    scratch.reserve(grid_stride(on.length));
    plan_.stretched_spectrum(plan_.pulses[i / nodes], returns_.nodes[i % nodes], on, scratch.data(),
                             std::span(found).subspan(i * bins, bins));
  });
  return found;
}

void BlockSynthesis::add_product(const std::complex<float>* grid, std::size_t response,
                                 std::size_t node, std::complex<float>* sum) const {
  multiply_add(grid, spectra_.data() + (response * returns_.nodes.size() + node) * bins_,
               plan_.length, static_cast<std::size_t>(plan_.highest_bin), sum);
}

Baseband BlockSynthesis::run() {
  Baseband result{.carrier = plan_.carrier,
                  .sample_rate = plan_.rate,
                  .start = plan_.recording.start,
                  .channels = phones_.size(),
                  .samples = plan_.length,
                  .recorded = 0,
                  .values = {}};
  result.recorded =
      std::min(plan_.length, static_cast<std::size_t>(static_cast<double>(plan_.recording.samples) /
                                                      plan_.recording.sample_rate * plan_.rate) +
                                 1);
  result.values.resize(phones_.size() * plan_.length);
  if (returns_.nodes.empty()) return result;
  const std::size_t grids = phones_.size() * responses_ * returns_.nodes.size();
  // One batch for many phones: grids that stay in a thread's cache are faster.
  constexpr std::size_t many = 8;
  const bool keep = grids * stride_ * sizeof(std::complex<float>) <= most_kept &&
                    (phones_.size() < many || batches(false).size() > 1);
  const std::vector<Batch> all = batches(keep);
  if (all.empty()) return result;
  bool in_windows = !keep && all.size() > 1;  // one batch has returns all over the grid
  if (!in_windows) spectra_ = spectra(plan_.whole());
  if (keep) kept_ = FftBuffer<std::complex<float>>(grids * stride_);
  for (const Batch& batch : all) {
    blocks_.resize(std::max(blocks_.size(), batch.end - batch.begin));
    in_parallel(batch.end - batch.begin, [&](std::size_t i) {
      blocks_[i].clear();
      source_.make(batch.begin + i, blocks_[i]);
    });
    returns_.take(std::span(blocks_).first(batch.end - batch.begin));
    if (in_windows && !(in_windows = find_windows())) spectra_ = spectra(plan_.whole());
    if (keep)
      grid_into_kept();
    else if (in_windows)
      grid_in_windows(result);
    else
      grid_and_transform(result);
  }
  if (!in_windows) transform(keep, result);
  return result;
}

double BlockSynthesis::array_reach() const {
  double furthest = 0.0;
  for (const Vec3& phone : phones_) furthest = std::max(furthest, phone.norm());
  return furthest * returns_.largest_slowness * plan_.rate;
}

/// Where the returns that all receive may be cut into segments for tasks of their own: a segment
/// reaches into the grid of its neighbours, but not across them.
std::vector<std::size_t> BlockSynthesis::cuts(const OrderedReturns::Band& band) const {
  constexpr std::size_t most = 16, fewest = 2048;  // segments; returns in one
  const std::size_t begin = band.ends[0], end = band.ends[1];
  const double reach = 2.0 * array_reach() + 2.0 * DelayKernel::taps + 2.0;  // [samples]
  const std::size_t each = std::max(fewest, (end - begin) / most + 1);
  std::vector<std::size_t> found = {begin};
  for (std::size_t i = begin + each; i + each <= end; i += each)
    if ((returns_.impulse[i] - returns_.impulse[found.back()]) * plan_.rate > reach)
      found.push_back(i);
  // The last one has a neighbour on one side only.
  found.push_back(end);
  return found;
}

void BlockSynthesis::grid_into_kept() {
  // Segments in turn: no two of the same turn touch the same samples.
  std::array<std::vector<Task>, 3> rounds;
  for (std::size_t b = 0; b < returns_.bands.size(); ++b) {
    const OrderedReturns::Band& band = returns_.bands[b];
    const std::vector<std::size_t> cut = cuts(band);
    for (std::size_t channel = 0; channel < phones_.size(); ++channel)
      for (std::size_t response = 0; response < responses_; ++response) {
        for (std::size_t i = 0; i + 1 < cut.size(); ++i)
          rounds[i % 2].push_back({b, channel, response, cut[i], cut[i + 1]});
        rounds[2].push_back({b, channel, response, band.ends[channel + 1], band.ends[channel + 2]});
      }
  }
  for (const std::vector<Task>& rotation : rounds)
    in_parallel(rotation.size(), [&](std::size_t i) {
      const Task& t = rotation[i];
      const OrderedReturns::Band& band = returns_.bands[t.band];
      grid_.add(returns_, band,
                {.begin = t.begin, .end = t.end, .response = t.response, .nodes = band.nodes},
                phones_[t.channel], kept(t.channel, t.response, band.first_node));
    });
}

std::complex<float>* BlockSynthesis::transformed(const ComplexFft<float>& fft, std::size_t beside,
                                                 std::complex<float>* grid) {
  const std::size_t length = fft.length();
  for (std::size_t i = 0; i < beside; ++i) {
    grid[length + i] += grid[i];
    grid[beside + i] += grid[beside + length + i];
  }
  fft.forward(grid + beside);
  return grid + beside;
}

void BlockSynthesis::grid_and_transform(Baseband& result) {
  const ComplexFft<float> fft(plan_.length);
  tbb::enumerable_thread_specific<Scratch> workspaces;
  in_parallel(phones_.size(), [&](std::size_t channel) {
    Scratch& grids = workspaces.local();
    std::complex<float>* sum = result.values.data() + channel * plan_.length;
    for (const OrderedReturns::Band& band : returns_.bands) {
      const bool received =
          band.ends[1] > band.ends[0] || band.ends[channel + 2] > band.ends[channel + 1];
      for (std::size_t m = 0; received && m < band.nodes; m += ImpulseGrid::most_nodes) {
        const std::size_t count = std::min(ImpulseGrid::most_nodes, band.nodes - m);
        grids.reserve(count * stride_);
        for (std::size_t response = 0; response < responses_; ++response) {
          std::fill_n(grids.data(), count * stride_, 0.0F);
          for (const std::size_t listener : {std::size_t{0}, channel + 1})
            grid_.add(returns_, band,
                      {.begin = band.ends[listener],
                       .end = band.ends[listener + 1],
                       .response = response,
                       .first_node = m,
                       .nodes = count},
                      phones_[channel], grids.data());
          for (std::size_t i = 0; i < count; ++i) {
            const std::complex<float>* const bins =
                transformed(fft, beside_, grids.data() + i * stride_);
            add_product(bins, response, band.first_node + m + i, sum);
          }
        }
      }
    }
  });
}

/// Whatever has been gridded or summed up, to time.
void BlockSynthesis::transform(bool keep, Baseband& result) {
  const ComplexFft<float> fft(plan_.length);
  const std::size_t nodes = returns_.nodes.size();
  if (keep)
    in_parallel(phones_.size() * responses_ * nodes,
                [&](std::size_t i) { transformed(fft, beside_, kept_.data() + i * stride_); });
  tbb::enumerable_thread_specific<Scratch> workspaces;
  in_parallel(phones_.size(), [&](std::size_t channel) {
    Scratch& row = workspaces.local();
    row.reserve(stride_);
    std::complex<float>* values = result.values.data() + channel * plan_.length;
    std::copy_n(values, plan_.length, row.data());
    for (std::size_t response = 0; keep && response < responses_; ++response)
      for (std::size_t node = 0; node < nodes; ++node)
        add_product(kept(channel, response, node) + beside_, response, node, row.data());
    fft.inverse(row.data());
    std::copy_n(row.data(), plan_.length, values);
  });
}

bool BlockSynthesis::find_windows() {
  std::vector<bool> taken(plan_.length + 1, false);
  for (const double impulse : returns_.impulse) taken[returns_.sample_at(impulse)] = true;
  std::vector<std::size_t> samples;
  for (std::size_t i = 0; i < taken.size(); ++i)
    if (taken[i]) samples.push_back(i);

  // The lead is a pulse and its taps.
  const std::size_t margin =
      plan_.lead + beside_ + static_cast<std::size_t>(std::ceil(array_reach())) + 2;
  const std::size_t before = windows_.length;
  if (!windows_.fit(samples, margin, plan_.length)) return false;
  if (windows_.length == before) return true;
  const auto share = static_cast<double>(windows_.length) / static_cast<double>(plan_.length);
  highest_of_window_ =
      static_cast<std::ptrdiff_t>(std::ceil(static_cast<double>(plan_.highest_bin) * share));
  const auto deconvolution = plan_.deconvolution_of(windows_.length, highest_of_window_);
  spectra_ = spectra({.length = windows_.length,
                      .lead = 0,
                      .highest_bin = highest_of_window_,
                      .deconvolution = deconvolution});
  return true;
}

void BlockSynthesis::grid_in_windows(Baseband& result) {
  const std::size_t length = windows_.length, stride = grid_stride(length);
  const std::size_t width = windows_.width();
  const auto highest = static_cast<std::size_t>(highest_of_window_), bins = 2 * highest + 1;
  const auto first_of = [&](std::size_t begin, std::size_t end, std::size_t sample) {
    while (begin < end) {  // of the returns, in order of their samples, the first at or after it
      const std::size_t middle = begin + (end - begin) / 2;
      if (returns_.sample_at(returns_.impulse[middle]) < sample)
        begin = middle + 1;
      else
        end = middle;
    }
    return begin;
  };
  struct Workspace {
    Scratch grids, sum;
  };
  const ComplexFft<float> fft(length);
  tbb::enumerable_thread_specific<Workspace> workspaces;
  in_parallel(phones_.size(), [&](std::size_t channel) {
    auto& [grids, sum] = workspaces.local();
    sum.reserve(stride);
    std::complex<float>* row = result.values.data() + channel * plan_.length;
    for (const std::size_t begin : windows_.begins) {
      // Sample 0 of the window is this one of the whole grid.
      const double origin = static_cast<double>(begin) - 0.5 * static_cast<double>(windows_.beside);
      const double from_grids = origin + static_cast<double>(beside_);
      ImpulseGrid here = grid_;
      here.stride = stride;
      here.length = length;
      here.first += from_grids / plan_.rate;
      here.first_position -= from_grids;
      here.last_position -= from_grids;
      std::fill_n(sum.data(), length, 0.0F);
      for (const OrderedReturns::Band& band : returns_.bands) {
        std::array<ImpulseGrid::Part, 2> parts;  // of all phones, of this one
        for (std::size_t i = 0; i < 2; ++i) {
          const std::size_t listener = i == 0 ? 0 : channel + 1;
          const std::size_t from = first_of(band.ends[listener], band.ends[listener + 1], begin);
          parts[i] = {.begin = from, .end = first_of(from, band.ends[listener + 1], begin + width)};
        }
        const bool received = parts[0].begin < parts[0].end || parts[1].begin < parts[1].end;
        for (std::size_t m = 0; received && m < band.nodes; m += ImpulseGrid::most_nodes) {
          const std::size_t count = std::min(ImpulseGrid::most_nodes, band.nodes - m);
          grids.reserve(count * stride);
          for (std::size_t response = 0; response < responses_; ++response) {
            std::fill_n(grids.data(), count * stride, 0.0F);
            for (ImpulseGrid::Part part : parts) {
              part.response = response;
              part.first_node = m;
              part.nodes = count;
              here.add(returns_, band, part, phones_[channel], grids.data());
            }
            for (std::size_t i = 0; i < count; ++i) {
              const std::size_t node = response * returns_.nodes.size() + band.first_node + m + i;
              fft.forward(grids.data() + i * stride);
              multiply_add(grids.data() + i * stride, spectra_.data() + node * bins, length,
                           highest, sum.data());
            }
          }
        }
      }
      fft.inverse(sum.data());
      // An impulse on sample i of the whole grid is received at sample i − lead.
      const auto n = static_cast<std::ptrdiff_t>(plan_.length);
      std::ptrdiff_t to =
          (static_cast<std::ptrdiff_t>(origin) - static_cast<std::ptrdiff_t>(plan_.lead)) % n;
      if (to < 0) to += n;
      for (std::size_t i = 0; i < length; ++i) {
        row[to] += sum[i];
        if (++to == n) to = 0;
      }
    }
  });
}

}  // namespace asdic::detail
