#pragma once
#include "raytrace/ocean/arrivals.h"
#include "raytrace/ocean/environment.h"

namespace asdic::detail {

/// Whether a boundary is anything but a mirror.
[[nodiscard]] bool is_rough(const Environment& ocean) noexcept;
/// The same ocean between mirrors: neither roughness nor bubbles.
[[nodiscard]] Environment without_roughness(Environment ocean);

/// Applies rough boundaries to paths found between mirrors: multiplies each amplitude by the
/// coherent part at every bounce, and adds the sound scattered about the path. Amplitudes of waves
/// (caustics.h, cycles.h) are computed between mirrors and get it here, once, so that nothing is
/// divided by the coherent loss. docs/theory/waves.md, "Rough boundaries"
/// \param ocean  is_layered(), the rough one   \param faintest  pressure below which a path is
/// dropped, relative to its own without reflections   \param paths  changed
void put_roughness(const Environment& ocean, double frequency, double faintest, Arrivals& paths);

}  // namespace asdic::detail
