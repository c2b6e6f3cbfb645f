#pragma once
#include "io/hdf5/hdf5_output.h"
#include "io/result/result_root.h"
#include "processing/coverage/coverage.h"
#include "sonar/scenario/scenario.h"

namespace asdic::detail {

/// Writes the datasets and attributes of docs/formats/area.md, but for the root's (filetype,
/// provenance), into an open file. \param scenario  that it is of: its tracks
void write_coverage(Hdf5File& file, const Coverage& found, const Scenario& scenario);

/// The whole file. \param scenario  as it was read; what was found warns on
void write_area(OutputFile&& to, const Coverage& found, const Scenario& scenario);

/// Depth, levels and shares of an area file, for people.
struct CoverageSummary {
  std::string title, transmitter, array;
  double frequency = 0.0, reach = 0.0;
  std::size_t bearings = 0, ranges = 0;
  struct Layer {
    double depth = 0.0;
    double detected_share =
        0.0;                ///< of the area of water at that depth, with P_d of a half and more
    double farthest = 0.0;  ///< range up to which half of the bearings have that [m]
    bool in_water = false;  ///< whether any cell is
    double no_path_share = 0.0;  ///< of the area of water, that no ray reaches
  };
  std::vector<Layer> layers;
};
/// \throws InputError if it is no area file or a part is missing or of the wrong shape
[[nodiscard]] CoverageSummary read_coverage_summary(const std::filesystem::path& path);
/// The same of what was just computed.
[[nodiscard]] CoverageSummary summary_of(const Coverage& found, const std::string& title);

}  // namespace asdic::detail
