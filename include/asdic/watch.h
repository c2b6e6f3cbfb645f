#pragma once

/// \file
/// Long work: how far it is, and how it is called off.
///
/// ```cpp
/// const asdic::Scenario scenario = asdic::Scenario::read("deep_ocean.toml");
/// std::stop_source button;  // whose request_stop() may come from any thread
/// const asdic::Watch watch{.stop = button.get_token(),
///                          .progress = [](int done, int total) {
///                            std::cout << done << " of " << total << '\n';
///                          }};
/// try {
///   scenario.validate(watch);
/// } catch (const asdic::Stopped&) {
///   std::cout << "called off\n";
/// }
/// ```

#include <functional>
#include <stop_token>

#include "asdic/export.h"

namespace asdic {

/// How work is watched. Work that is called off ends within moments and throws Stopped; what was
/// found until then is kept, and the same call may be made again.
struct Watch {
  std::stop_token stop = {};
  /// Told how many steps are done, and of how many: pings of a run; of a scenario that is prepared,
  /// three: it is read, the paths to scatterers are found, those to targets are judged.
  std::function<void(int done, int total)> progress = {};
};

}  // namespace asdic
