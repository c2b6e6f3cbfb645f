#pragma once
#include <filesystem>

#include "io/text/toml_table.h"
#include "sonar/scenario/scenario.h"

/// The parts of a scenario file that do not describe themselves (docs/develop/settings.md), one
/// function per table. Each checks types and ranges of its own keys; check_scenario() (checks.h)
/// holds the parts against one another. All throw InputError.
namespace asdic::detail::scenario {

// The tables of a sonar, in the order in which they are read. Between them: [pulse] and
// [environment]; and after describe_bodies() what checks the noise.
void describe_head(Fields& field, Scenario& scenario);    ///< title and seed
void describe_bodies(Fields& field, Scenario& scenario);  ///< from platforms to noise
void describe_sound(Fields& field, Scenario& scenario);   ///< from reverberation to pings
/// [environment], for a walker that does not read.
void describe_environment(Fields& field, const Scenario& scenario);

/// \param frequency  at which attenuations per metre are meant [Hz]
void read_environment(TomlTable table, const std::filesystem::path& folder, double frequency,
                      Scenario& scenario);

}  // namespace asdic::detail::scenario
