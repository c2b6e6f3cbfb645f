#pragma once

/// \file
/// BELLHOP's files: its cases as scenarios, and fields, arrivals and rays of either program.
/// docs/formats/bellhop.md
///
/// ```cpp
/// const asdic::BellhopCase munk = asdic::read_bellhop("bellhop/munk.env");
/// for (const std::string& note : munk.notes) std::cout << note << '\n';
/// asdic::write_run("munk.h5", munk.scenario);
/// asdic::convert_result("munk.h5", "munk.shd");
/// ```

#include <filesystem>
#include <string>
#include <vector>

#include "asdic/export.h"
#include "asdic/scenario.h"
#include "asdic/watch.h"

namespace asdic {

/// A case of BELLHOP's as asdic understands it.
struct BellhopCase {
  Scenario scenario{};               ///< with a [run]
  std::vector<std::string> notes{};  ///< what the reader did that one should know
};

/// Reads ROOT.env and the files beside it. A case of BELLHOP3D becomes the scenario of its first
/// plane, in an area whose maps are in a file (docs/formats/bellhop3d.md).
/// \param root  with or without .env
/// \param maps  where that file goes; only a case over a map needs one. A file that asdic did not
/// write is not written over
/// \throws InputError "case.env:12: …", RunError
[[nodiscard]] ASDIC_API BellhopCase read_bellhop(const std::filesystem::path& root,
                                                 const std::filesystem::path& maps = {});

/// Does what [run] of a scenario asks for, a field, arrivals or rays, and writes it: HDF5
/// (docs/formats/field.md, arrivals.md, rays.md) or, by the name's ending, .shd, .arr or .ray. A
/// file that asdic did not write is not written over. \return what to know before trusting it
/// \throws InputError, RunError, Stopped
ASDIC_API std::vector<std::string> write_run(const std::filesystem::path& path,
                                             const Scenario& scenario, const Watch& watch = {});

/// A field, arrivals or rays from one kind of file to another: HDF5, .shd, .arr, .ray.
/// \throws InputError, RunError
ASDIC_API void convert_result(const std::filesystem::path& from, const std::filesystem::path& to);

}  // namespace asdic
