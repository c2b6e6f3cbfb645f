#pragma once

/// \file
/// All of asdic: active sonar in a real ocean. docs/guide/cpp.md
///
/// ```cpp
/// asdic::Scenario scenario = asdic::Scenario::read("deep_ocean.toml");
/// scenario.set("target.0.strength_db", 20.0).set("pings.recording_duration", 36.0);
/// for (const std::string& warning : scenario.validate()) std::cerr << warning << '\n';
/// const asdic::Ping ping = asdic::ping(scenario);
/// std::cout << ping.echoes().size() << " echoes at " << ping.channels() << " phones\n";
/// asdic::write_ping("ping.h5", scenario, ping);
/// ```

#include "asdic/array.h"
#include "asdic/arrivals.h"
#include "asdic/bellhop.h"
#include "asdic/channel.h"
#include "asdic/environment.h"
#include "asdic/error.h"
#include "asdic/field.h"
#include "asdic/file.h"
#include "asdic/ocean.h"
#include "asdic/ping.h"
#include "asdic/platform.h"
#include "asdic/process.h"
#include "asdic/pulse.h"
#include "asdic/rays.h"
#include "asdic/reverberation.h"
#include "asdic/scenario.h"
#include "asdic/settings.h"
#include "asdic/study.h"
#include "asdic/target.h"
#include "asdic/units.h"
#include "asdic/value.h"
#include "asdic/watch.h"
