#pragma once
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "io/hdf5/environment_group.h"
#include "io/ping/ping_file.h"
#include "study/measures/realisation.h"
#include "study/summary/summary.h"

namespace asdic::detail::study {

/// What every journal and every file of a study says of the study that it belongs to.
struct Fingerprint {
  std::string identity{};  ///< identity(study): rows of one belong together
  std::string title{};
  std::uint64_t seed = 1;
  std::uint64_t realisations = 0;  ///< of the whole study
  std::string design{};            ///< "random", …
  std::string text{}, scenario_text{};
  std::optional<OriginAttributes> origin{};  ///< where on the Earth its map is
  std::vector<std::string> overrides{};
  std::vector<std::string> warnings{};  ///< what is to be known before the numbers are trusted
  /// Of the levels, by paths of more bounces, estimated [dB]; not a number: not known.
  double left_out_db = std::numeric_limits<double>::quiet_NaN();
  std::vector<Column> columns{};  ///< with those that tell what was reused
  CellShape cells{};              ///< of those that are counted
};

[[nodiscard]] Fingerprint fingerprint_of(const Study& study);

/// One run of a command that made rows: they may depend on its build and its kind of processor;
/// on nothing else of it.
struct Session {
  Provenance made{};
  std::string study_path{};  ///< of the study file, absolute
  std::uint64_t rows = 0;
  double seconds = 0.0;  ///< wall time

  /// Whether rows of both are the same to the last bit.
  [[nodiscard]] bool same_bits(const Session& other) const noexcept {
    return made.program_version == other.made.program_version && made.build == other.made.build &&
           made.cpu == other.made.cpu;
  }
};

// As JSON, the form in which journals and files hold them.
[[nodiscard]] std::string to_json(const std::vector<Column>& columns);
[[nodiscard]] std::string to_json(const Session& session);
[[nodiscard]] std::vector<Column> columns_from_json(const std::string& text);
[[nodiscard]] Session session_from_json(const std::string& text);

/// Takes the columns that tell how a row was made, not what came out, out of a table.
[[nodiscard]] Table take_reuse(Table& table);

/// ", or of this one before it changed (line 12 of the study file)": where two texts of study files
/// part, for messages.
[[nodiscard]] std::string how_changed(const std::string& before, const std::string& now);

/// What is wrong with mixing rows of these: "" where nothing is, else a sentence that names builds
/// and processors.
[[nodiscard]] std::string mixed_builds(const std::vector<Session>& sessions);

}  // namespace asdic::detail::study
