#pragma once
#include "io/text/toml_table.h"
#include "sonar/scenario/scenario.h"

/// What a scenario's parts are held against one another for. All throw InputError.
namespace asdic::detail::scenario {

/// That noise is coherent between no more phones than there is memory for.
void check_coherence(const TomlTable& noise, const Scenario& scenario);

/// Platform, phones and targets are in the water throughout, sampling is fast enough for the band,
/// a transmitter sends no pulse before its last one has ended, a ping fits in memory.
/// \param root  the document, for the places of faults
void check_scenario(TomlTable& root, const Scenario& scenario);

}  // namespace asdic::detail::scenario
