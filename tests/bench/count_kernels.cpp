#include <oneapi/tbb/global_control.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/units.h"
#include "raytrace/paths/eigenrays.h"
#include "raytrace/paths/ray_fan.h"
#include "raytrace/runs/field_run.h"
#include "raytrace/tracing/marching_eigenrays.h"
#include "sonar/noise/block_noise.h"
#include "sonar/noise/noise_spectrum.h"
#include "sonar/scenario/array.h"
#include "sonar/synthesis/synthesis.h"
#include "support/deep_ocean.h"
#include "support/oceans.h"
#include "support/random_returns.h"
#include "support/thesis.h"

// One kernel, run once to warm up and then so often as told inside a function that callgrind can
// count the instructions of (tests/bench/check_counts.py): one thread, fixed input.
//   count_kernels                 names, one a line
//   count_kernels NAME [TIMES]
//   count_kernels scatterers:N:PHONES     how the synthesis grows; not among the names, printed by
//                                         scripts/bench.sh --linear
extern "C" [[gnu::noinline]] void asdic_counted(const std::function<void()>& kernel, int times) {
  for (int i = 0; i < times; ++i) kernel();
  asm volatile("" ::: "memory");
}

namespace asdic::detail {
namespace {

/// Keeps the compiler from leaving out what nobody reads.
template <class T>
void keep(const T& value) {
  asm volatile("" : : "g"(&value) : "memory");
}

using Kernel = std::function<void()>;

/// Munk's law in 31 samples under a rule of interpolation, or itself; a source at 4500 m.
EigenraySolver deep_ocean(const char* law) { return EigenraySolver(support::deep_ocean(law)); }

constexpr PathLimits limits{
    .max_surface_bounces = 3, .max_bottom_bounces = 3, .max_launch_angle = 1.4};

Kernel one_receiver(const char* law) {
  return [solver = deep_ocean(law)] { keep(solver.find(4500.0, 125.0, 30e3, 4000.0, limits)); };
}

Kernel many_receivers(const char* law) {
  std::vector<double> ranges;
  for (int i = 0; i < 1000; ++i) ranges.push_back(1000.0 + 50.0 * i);
  return [solver = deep_ocean(law), ranges] {
    keep(solver.find(4500.0, 125.0, ranges, 4000.0, limits));
  };
}

/// A fan of 1000 dynamic rays within ±15° to 100 km through 110 layers.
Kernel fan() {
  const auto ocean = std::make_shared<const Environment>(support::munk_in_layers(110));
  const auto rays = std::make_shared<const RayFan>(*ocean, 1000.0, 1000.0);
  std::vector<double> elevations;
  for (int i = 0; i < 1000; ++i) elevations.push_back(radians(-15.0 + 0.03 * (i + 0.5)));
  return [ocean, rays, elevations, out = std::vector<RayAtRange>(1000)]() mutable {
    rays->trace(elevations, 100e3, out);
    keep(out);
  };
}

support::CurvedOcean curved_ocean(const char* name) {
  for (const support::CurvedOcean& ocean : support::curved_oceans())
    if (ocean.name == name) return ocean;
  std::abort();
}

/// 100 rays within ±1 rad to 12 km over slopes, ridges and through fronts, step by step.
Kernel marched_rays(const char* name) {
  const support::CurvedOcean ocean = curved_ocean(name);
  const auto tracer = std::make_shared<const RayTracer>(ocean.environment, 500.0);
  return [tracer, depth = ocean.source_depth, ray = RayTrajectory{}]() mutable {
    for (int i = 0; i < 100; ++i)
      tracer->trace(0.0, depth, -1.0 + 0.02 * (i + 0.3), {.min_range = -1e3, .max_range = 12e3},
                    ray);
    keep(ray);
  };
}

/// Eigenrays to receivers in so many columns and rows.
Kernel marching_eigenrays_to(const char* name, int columns, int rows) {
  const support::CurvedOcean ocean = curved_ocean(name);
  const auto tracer = std::make_shared<const RayTracer>(ocean.environment, 500.0);
  std::vector<ReceiverPoint> receivers;
  for (int i = 1; i <= columns; ++i)
    for (int k = 1; k <= rows; ++k)
      receivers.push_back({ocean.range * i / columns, 400.0 * k / (rows + 1)});
  return [tracer, depth = ocean.source_depth, receivers] {
    keep(marching_eigenrays(
        *tracer, 0.0, depth, receivers,
        {.lowest = -1.2, .highest = 1.2, .max_surface_bounces = 6, .max_bottom_bounces = 6}));
  };
}

/// The coherent field of 1001 beams on 501 × 201 receivers to 100 km.
Kernel field(BeamKind kind) {
  PropagationCase sea;
  sea.environment = support::deep_ocean("c-linear");
  sea.frequency = 50.0;
  sea.source_depths = {1000.0};
  sea.beams.kind = kind;
  for (int i = 0; i < 201; ++i) sea.receivers.depths.push_back(25.0 * i);
  for (int i = 1; i <= 501; ++i) sea.receivers.ranges.push_back(200.0 * i);
  return [sea, tracer = std::make_shared<const RayTracer>(sea.environment, sea.frequency)] {
    keep(field_of_fan(sea, *tracer, 1000.0, even_fan(-radians(20.0), radians(20.0), 1001)));
  };
}

/// Scatterers at phones in 10 s of baseband. \param spread  of Doppler factors
Kernel scatterers(double spread, std::size_t count = 10'000, int phones = 4) {
  constexpr double rate = 16000.0, seconds = 10.0;
  const Recording recording{
      .sample_rate = rate, .start = 0.0, .samples = static_cast<std::size_t>(rate * seconds)};
  const Returns returns =
      support::RandomReturns{.count = count, .last = seconds, .spread = spread}.make();
  const auto synthesizer = std::make_shared<const Synthesizer>(
      Pulse({.waveform = Cw{}, .duration = 1.0}), recording, spread);
  return [returns, synthesizer, array = line_array(phones, 0.1875, 0.0, 0.0)] {
    keep(synthesizer->baseband(returns, array.phones));
  };
}

/// 10 s of Wenz's noise, 4 phones at 16 kHz.
Kernel noise(NoiseCoherence coherence) {
  const NoiseSettings wenz{.law = WenzNoise{}, .thermal = true};
  const auto block = std::make_shared<const BlockNoise>(
      [wenz](double f) { return noise_density(wenz, f); }, 16000.0, 0.0,
      line_array(4, 0.1875, 0.0, 0.3).phones, coherence, NoiseDirections{}, 1500.0, NoiseKey{});
  return [block, rows = std::vector<float>(4 * 10 * 16000)]() mutable {
    block->add(rows, 0, 1);
    keep(rows);
  };
}

/// 60 s of 16 phones in complex baseband: a moving target, reverberation.
Scenario one_minute() {
  Scenario s = support::thesis(support::deep_ocean("pchip").water);
  s.environment.absorption = Thorp{};
  std::get<LineBeam>(s.transmitters[0].beam).taper = Taper::hann;
  s.targets = {support::target({23e3, 9e3, 125.0}, 30.0, {-4.0, 0.0, 0.0})};
  s.reverberation.enabled = true;
  s.propagation.max_surface_bounces = s.propagation.max_bottom_bounces = 1;
  s.pings.samples = Samples::baseband;
  s.pings.carrier = 4000.0;
  s.pings.baseband_rate = 400.0;
  return s;
}

/// Reverberation by its covariance. Nothing is known before.
Kernel new_ping() {
  return [s = one_minute()] { keep(PingSimulator(s).simulate(1)); };
}

/// At 1.7 m/s: reverberation as streams, which are known.
Kernel ping_under_way() {
  Scenario s = one_minute();
  s.pings.count = 2;
  s.platforms[0].track.start.velocity = {1.7, 0.0, 0.0};
  return [simulator = std::make_shared<const PingSimulator>(s)] { keep(simulator->simulate(2)); };
}

struct Named {
  const char* name;
  std::function<Kernel()> make;
};

const std::vector<Named> kernels = {
    {"fan", fan},
    {"one-receiver-c-linear", [] { return one_receiver("c-linear"); }},
    {"one-receiver-n2-linear", [] { return one_receiver("n2-linear"); }},
    {"one-receiver-pchip", [] { return one_receiver("pchip"); }},
    {"one-receiver-munk", [] { return one_receiver("munk"); }},
    {"1000-receivers-c-linear", [] { return many_receivers("c-linear"); }},
    {"1000-receivers-pchip", [] { return many_receivers("pchip"); }},
    {"field-hat", [] { return field(BeamKind::hat); }},
    {"field-gaussian", [] { return field(BeamKind::gaussian); }},
    {"marched-rays-wedge", [] { return marched_rays("wedge"); }},
    {"marched-rays-front", [] { return marched_rays("front"); }},
    {"marched-rays-pchip", [] { return marched_rays("ridge under pchip"); }},
    {"marching-one-receiver", [] { return marching_eigenrays_to("faceted ridge", 1, 1); }},
    {"marching-grid", [] { return marching_eigenrays_to("wedge", 20, 40); }},
    {"scatterers-at-rest", [] { return scatterers(0.0); }},
    {"scatterers-doppler", [] { return scatterers(5e-4); }},
    {"new-ping", new_ping},
    {"ping-under-way", ping_under_way},
    {"noise-independent", [] { return noise(NoiseCoherence::independent); }},
    {"noise-isotropic", [] { return noise(NoiseCoherence::isotropic); }},
};

}  // namespace
}  // namespace asdic::detail

int main(int count, char** argument) {
  if (count < 2) {
    for (const auto& kernel : asdic::detail::kernels) std::puts(kernel.name);
    return 0;
  }
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  std::size_t scatterers = 0;
  int phones = 0;
  if (std::sscanf(argument[1], "scatterers:%zu:%d", &scatterers, &phones) == 2) {
    const asdic::detail::Kernel run = asdic::detail::scatterers(5e-4, scatterers, phones);
    run();
    asdic_counted(run, 1);
    return 0;
  }
  for (const auto& kernel : asdic::detail::kernels) {
    if (std::strcmp(kernel.name, argument[1]) != 0) continue;
    const asdic::detail::Kernel run = kernel.make();
    run();
    asdic_counted(run, count > 2 ? std::atoi(argument[2]) : 1);
    return 0;
  }
  std::fprintf(stderr, "count_kernels: no kernel %s\n", argument[1]);
  return 2;
}
