#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "io/files/output_file.h"
#include "processing/ping_processor.h"
#include "processing/scoring.h"
#include "processing/tracker.h"
#include "raytrace/area/earth_places.h"

namespace asdic::detail {

/// One array's part of one ping, done.
struct ProcessedPing {
  int transmitter = 0;
  double ping_time = 0.0;  ///< [s]
  ProcessedArray array;
  PingScore score;
  std::vector<TrueTarget> truth;
  MapRanges map_range;  ///< of the maps' columns, for the first ping of an array; else empty
};

/// A track with what it was made of.
struct ProcessedTrack {
  int array = 0;
  int side = 0;             ///< 0: the first of a detection's places, 1: the second
  bool ambiguous = false;   ///< there is one like it on the other side
  bool has_bearing = true;  ///< false: x is nothing, y the range seen from the array
  ContactTrack track;
  std::vector<int> rows;      ///< [points] of the detections table, −1: coasted
  std::vector<double> error;  ///< [points] from its target, horizontal (or in range); NaN [m]
  int target = -1;            ///< that most of its detections are of
};

/// Everything that `asdic process` found out about a file.
struct ProcessedRun {
  std::vector<ProcessedPing> pings;  ///< [pings × arrays], in order
  std::vector<ProcessedTrack> tracks;
  std::vector<std::string> options;   ///< "name=value" of what was asked for
  std::vector<std::string> warnings;  ///< what is to be known before it is trusted
  std::vector<std::string> notes;     ///< what the receiver did to the records, and what that costs
  std::string program_version;
  EarthPlaces earth{};  ///< of the scenario's map
  bool maps = true;
};

/// A row of the detections table for every detection, in the order of `pings`.
[[nodiscard]] int first_row(const ProcessedRun& run, std::size_t ping);

/// Puts /processed into a ping file, in place of an earlier one: the file is copied to a part,
/// changed there and, once all is on disk, given its name, so that what is called by it is at every
/// moment either the old or the new file, whole. \param output  may be of `input` \throws RunError
void write_processed(const std::filesystem::path& input, OutputFile&& output,
                     const ProcessedRun& run, const Replica& replica);

/// The tables as text, one line a row, NaN as nothing.
[[nodiscard]] std::string detections_csv(const ProcessedRun& run);
[[nodiscard]] std::string tracks_csv(const ProcessedRun& run);

}  // namespace asdic::detail
