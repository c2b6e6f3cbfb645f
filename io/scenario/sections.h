#pragma once
#include <filesystem>

#include "io/text/toml_table.h"
#include "sonar/scenario/scenario.h"

/// The parts of a scenario file, one function per table (docs/formats/scenario.md). Each checks
/// types and ranges of its own keys; check_scenario() holds the parts against one another. All
/// throw InputError.
namespace asdic::scenario {

/// \param frequency  at which attenuations per metre are meant [Hz]
void read_environment(TomlTable table, const std::filesystem::path& folder, double frequency,
                      Scenario& scenario);
[[nodiscard]] PulseSettings read_pulse(TomlTable table, const std::filesystem::path& folder);
void read_platforms(std::vector<TomlTable> tables, Scenario& scenario);
/// After the platforms, which they name.
void read_transmitters(std::vector<TomlTable> tables, const std::filesystem::path& folder,
                       Scenario& scenario);
void read_arrays(std::vector<TomlTable> tables, Scenario& scenario);
void read_interferers(std::vector<TomlTable> tables, const std::filesystem::path& folder,
                      Scenario& scenario);
void read_targets(std::vector<TomlTable> tables, Scenario& scenario);
void read_noise(TomlTable table, const std::filesystem::path& folder, Scenario& scenario);
void read_reverberation(TomlTable table, Scenario& scenario);
void read_propagation(TomlTable table, Scenario& scenario);
void read_pings(TomlTable table, bool transmitter_has_elevation, Scenario& scenario);

/// \throws InputError where a transmitter would send a pulse before its last one has ended
void check_intervals(TomlTable& root, const Scenario& scenario);

/// Platform, phones and targets are in the water throughout, sampling is fast enough for the band,
/// a ping fits in memory. \param root  the document, for the places of faults
void check_scenario(TomlTable& root, const Scenario& scenario);

}  // namespace asdic::scenario
