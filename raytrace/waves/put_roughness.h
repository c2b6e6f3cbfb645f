#pragma once
#include "raytrace/ocean/arrivals.h"
#include "raytrace/ocean/environment.h"

namespace asdic::detail {

/// Whether a boundary is anything but a mirror.
[[nodiscard]] bool is_rough(const Environment& ocean) noexcept;
/// The same ocean between mirrors: neither roughness nor bubbles.
[[nodiscard]] Environment without_roughness(Environment ocean);

/// Gives paths found between mirrors what rough boundaries leave of each: of its amplitude the
/// coherent part at every bounce, and beside it what is scattered about the path. Waves' amplitudes
/// (caustics.h, cycles.h) are made between mirrors and get it here, once, so nothing is divided by
/// what a rough boundary has left. docs/theory/waves.md, "Rough boundaries"
/// \param ocean  is_layered(), the rough one   \param faintest  pressure, of a path's own without
/// reflections, below which it is dropped   \param paths  changed
void put_roughness(const Environment& ocean, double frequency, double faintest, Arrivals& paths);

}  // namespace asdic::detail
