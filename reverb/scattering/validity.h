#pragma once
#include "core/validity.h"
#include "reverb/scattering/models.h"

/// Where the laws of this folder hold, by the sources that their headers name. A law that is not
/// here (a table) is passed over.
namespace asdic::detail {

template <class Law>
inline constexpr Validity scattering_validity{};

inline constexpr ValidRange nrl_surface_ranges[] = {{"frequency", "Hz", 0.0, 5000.0}};  // bubbles
template <>
inline constexpr Validity scattering_validity<NrlSurface>{
    "the NRL law", "NRL/FR/7100--02-10,042, 2002", nrl_surface_ranges};

inline constexpr ValidRange chapman_harris_ranges[] = {
    {"frequency", "Hz", 400.0, 6400.0}, {"wind speed", "m/s", 0.0, 15.5}};  // 30 knots
template <>
inline constexpr Validity scattering_validity<ChapmanHarris>{
    "Chapman and Harris' law", "JASA 34, 1592, 1962", chapman_harris_ranges};

inline constexpr ValidRange ogden_erskine_ranges[] = {{"frequency", "Hz", 50.0, 1000.0},
                                                      {"wind speed", "m/s", 0.0, 20.0}};
template <>
inline constexpr Validity scattering_validity<OgdenErskine>{
    "Ogden and Erskine's law", "JASA 95, 746, 1994", ogden_erskine_ranges};

}  // namespace asdic::detail
