#pragma once
#include <memory>
#include <vector>

#include "asdic/ping.h"
#include "library/access.h"
#include "processing/scoring.h"
#include "sonar/ping/ping.h"

namespace asdic {

struct Ping::Data {
  Scenario scenario{};
  detail::PingRecord record{};  ///< of a ping out of a file: what a receiver needs of it
  bool from_file = false;
  std::vector<std::vector<detail::TrueEcho>> truth{};  ///< [arrays]
  std::vector<Vector> phones{};                        ///< [channels] [m]
  std::vector<Echo> echoes{};
};

struct PingAccess {
  /// \param truth  [arrays] what each of them receives
  [[nodiscard]] static Ping made(const Scenario& scenario, detail::PingRecord record,
                                 std::vector<std::vector<detail::TrueEcho>> truth, bool from_file);
  /// With the truth that is in the record.
  [[nodiscard]] static Ping made(const Scenario& scenario, const detail::PingSimulator& simulator,
                                 detail::PingRecord record);
  [[nodiscard]] static const Ping::Data& data(const Ping& ping) { return *ping.data_; }
};

}  // namespace asdic
