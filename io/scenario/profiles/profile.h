#pragma once
#include <concepts>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/fields.h"
#include "io/scenario/ocean.h"
#include "io/text/toml_table.h"
#include "raytrace/ocean/environment.h"

namespace asdic::detail::scenario {

/// Where a profile was read, and the water that it makes. The boundaries are in their places.
struct WaterToMake {
  TomlTable& table;
  const OceanReading& reading;
  Environment& ocean;
};

/// A way to say how fast sound is, a kind of [environment.sound_speed].
template <class P>
concept ProfileForm = Described<P> && std::copyable<P> &&
    requires(const P& form, const WaterToMake& to) {
  { P::name } -> std::convertible_to<std::string_view>;  // in scenario files
  /// Makes the water of what it says. \throws InputError at a key of the table
  form.make(to);
};
/// One that finds itself in water: files are written so.
template <class P>
concept WrittenProfile = ProfileForm<P> && requires(const Environment& ocean) {
  /// What makes this water again, bit for bit; none: it cannot.
  { P::of(ocean) } -> std::same_as<std::optional<P>>;
};

template <ProfileForm... P>
using OneOfProfiles = std::variant<P...>;

/// The form that has the water's bits: the last of the list that finds itself in it.
template <ProfileForm... P>
void find_form(const Environment& ocean, std::variant<P...>& form) {
  const auto look_for = [&](const auto& one) {
    using One = std::decay_t<decltype(one)>;
    if constexpr (WrittenProfile<One>)
      if (std::optional<One> found = One::of(ocean)) form = *std::move(found);
  };
  (look_for(P{}), ...);
}

/// A fault of the samples together (a spline that swings too far) is told at the table's key.
[[nodiscard]] SoundSpeedProfile profile_of(const TomlTable& table, const std::vector<double>& depth,
                                           const std::vector<double>& speed,
                                           Interpolation interpolation);

/// A short table goes on by the law of its first or last interval, as far as that makes sense: its
/// speed at both boundaries must be near what the samples hold. \param key  told if it is not
void check_reach(const TomlTable& table, const std::string& key, std::span<const double> depth,
                 std::span<const double> speed, const Environment& ocean);

[[nodiscard]] std::vector<double> copied(std::span<const double> values);

}  // namespace asdic::detail::scenario
