#pragma once
#include <filesystem>

#include "io/text/toml_table.h"
#include "sonar/scenario/scenario.h"

/// The parts of a scenario file that do not describe themselves (docs/develop/settings.md), one
/// function per table. Each checks types and ranges of its own keys; check_scenario() holds the
/// parts against one another. All throw InputError.
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

/// \throws InputError where noise is coherent between more phones than there is memory for
void check_coherence(const TomlTable& noise, const Scenario& scenario);
/// \throws InputError where a transmitter would send a pulse before its last one has ended
void check_intervals(TomlTable& root, const Scenario& scenario);

/// Platform, phones and targets are in the water throughout, sampling is fast enough for the band,
/// a ping fits in memory. \param root  the document, for the places of faults
void check_scenario(TomlTable& root, const Scenario& scenario);

}  // namespace asdic::detail::scenario
