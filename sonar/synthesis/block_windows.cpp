#include <oneapi/tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "raytrace/parallel/parallel.h"
#include "sonar/synthesis/block_synthesis.h"
#include "sonar/synthesis/spectrum_product.h"

namespace asdic {
namespace {

using Scratch = FftBuffer<std::complex<float>>;

}  // namespace

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

void BlockSynthesis::lay_in_windows(Baseband& result) {
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
        const bool heard = parts[0].begin < parts[0].end || parts[1].begin < parts[1].end;
        for (std::size_t m = 0; heard && m < band.nodes; m += ImpulseGrid::most_nodes) {
          const std::size_t count = std::min(ImpulseGrid::most_nodes, band.nodes - m);
          grids.reserve(count * stride);
          for (std::size_t colour = 0; colour < colours_; ++colour) {
            std::fill_n(grids.data(), count * stride, 0.0F);
            for (ImpulseGrid::Part part : parts) {
              part.colour = colour;
              part.first_node = m;
              part.nodes = count;
              here.lay(returns_, band, part, phones_[channel], grids.data());
            }
            for (std::size_t i = 0; i < count; ++i) {
              const std::size_t node = colour * returns_.nodes.size() + band.first_node + m + i;
              fft.forward(grids.data() + i * stride);
              multiply_add(grids.data() + i * stride, spectra_.data() + node * bins, length,
                           highest, sum.data());
            }
          }
        }
      }
      fft.inverse(sum.data());
      // An impulse on sample i of the whole grid is heard at sample i − lead.
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

}  // namespace asdic
