#pragma once
#include <filesystem>

// What counts as written by asdic, for OutputRules::own. Each looks at the first bytes of a file,
// or at what it says of itself, and never throws for what it finds there.
namespace asdic::detail::own {

/// HDF5 whose root attribute `filetype` begins with "asdic ".
[[nodiscard]] bool hdf5(const std::filesystem::path& path);
/// An unfinished HDF5 file with whole pings in it, of which `asdic recover` makes a ping file.
[[nodiscard]] bool pings(const std::filesystem::path& path);
/// A sound file whose software is asdic, or, of before it said so, with our scale beside it.
[[nodiscard]] bool sound(const std::filesystem::path& path);
/// The scale of a sound file (NAME.wav.json): it names pascal_per_unit.
[[nodiscard]] bool sound_scale(const std::filesystem::path& path);
/// A MAT-file whose first words say so.
[[nodiscard]] bool mat(const std::filesystem::path& path);
/// TOML that says in its first comment that asdic has written it.
[[nodiscard]] bool scenario(const std::filesystem::path& path);
/// A table of `asdic process`: its first line names the columns of detections or tracks.
[[nodiscard]] bool table(const std::filesystem::path& path);
/// PNG that says so (tEXt, Software).
[[nodiscard]] bool picture(const std::filesystem::path& path);

// BELLHOP's kinds have no room to say who wrote them: what looks like the kind counts as ours, but
// for .env, which people write by hand and which ours therefore ends with a remark.
[[nodiscard]] bool shade_file(const std::filesystem::path& path);     ///< .shd
[[nodiscard]] bool arrivals_file(const std::filesystem::path& path);  ///< .arr
[[nodiscard]] bool ray_file(const std::filesystem::path& path);       ///< .ray
[[nodiscard]] bool print_file(const std::filesystem::path& path);     ///< .prt
[[nodiscard]] bool case_file(const std::filesystem::path& path);      ///< .env
/// A companion of a case: ours where ROOT.env beside it is.
[[nodiscard]] bool case_companion(const std::filesystem::path& path);

/// The remark in TOML ("# …") and .env ("! …").
inline constexpr const char* remark = "Written by asdic";

}  // namespace asdic::detail::own
