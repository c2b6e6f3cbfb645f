#pragma once
#include <concepts>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

#include "reverb/scattering/chapman_harris.h"
#include "reverb/scattering/ellis_crowe.h"
#include "reverb/scattering/lambert.h"
#include "reverb/scattering/nrl_surface.h"
#include "reverb/scattering/ogden_erskine.h"
#include "reverb/scattering/table.h"
#include "reverb/scattering/volume.h"

namespace asdic::detail {

/// Every law of surface scattering. A new one is one file and one name here.
using AnySurfaceScattering = std::variant<NrlSurface, ChapmanHarris, OgdenErskine, ScatteringTable>;
/// Every law of bottom scattering.
using AnyBottomScattering = std::variant<Lambert, EllisCrowe, ScatteringTable>;

namespace scattering_list {

/// A list with one law more, where it is not there yet.
template <class List, class Law>
struct With;
template <class... Laws, class Law>
struct With<std::variant<Laws...>, Law> {
  using Type = std::conditional_t<(std::same_as<Laws, Law> || ...), std::variant<Laws...>,
                                  std::variant<Laws..., Law>>;
};
/// Every law of two lists, once.
template <class List, class More>
struct Joined;
template <class List>
struct Joined<List, std::variant<>> {
  using Type = List;
};
template <class List, class Law, class... Laws>
struct Joined<List, std::variant<Law, Laws...>> {
  using Type = typename Joined<typename With<List, Law>::Type, std::variant<Laws...>>::Type;
};

}  // namespace scattering_list

/// Every law there is: of the surface, of the bottom and of a sheet of water between them.
using AnyScattering =
    scattering_list::With<scattering_list::Joined<AnySurfaceScattering, AnyBottomScattering>::Type,
                          VolumeSheet>::Type;

/// Where a law's source vouches for it. A law that says nothing of it holds anywhere.
template <class... Model>
[[nodiscard]] Validity scattering_validity(const std::variant<Model...>& scattering) {
  return std::visit(
      []<class Law>(const Law& /*any*/) {
        if constexpr (requires { Law::validity(); })
          return Law::validity();
        else
          return Validity{};
      },
      scattering);
}

/// σ [1/sr] of either at a frequency [Hz].
template <class... Model>
[[nodiscard]] double scattering_cross_section(const std::variant<Model...>& scattering,
                                              const ScatterGeometry& geometry,
                                              double frequency) noexcept {
  return std::visit([&](const auto& model) { return model.cross_section(geometry, frequency); },
                    scattering);
}

/// A law at several frequencies, to be asked for many directions: which law it is, is asked once
/// for all of them.
template <class Any>
struct AtFrequenciesOf;
template <class... Model>
struct AtFrequenciesOf<std::variant<Model...>> {
  using Type = std::variant<std::vector<decltype(std::declval<const Model&>().at(0.0))>...>;
};
template <class Any>
using AtFrequencies = typename AtFrequenciesOf<Any>::Type;

/// Puts a model under a sea (a table knows none). \param wind_speed  at 10 m [m/s]
/// \param surface_sound_speed  of the water at the surface [m/s]
inline void set_sea(AnySurfaceScattering& scattering, double wind_speed,
                    double surface_sound_speed) {
  std::visit(
      [&]<class Model>(Model& model) {
        if constexpr (SurfaceScatteringModel<Model>) {
          model.wind_speed = wind_speed;
          model.sound_speed = surface_sound_speed;
        }
      },
      scattering);
}

}  // namespace asdic::detail
