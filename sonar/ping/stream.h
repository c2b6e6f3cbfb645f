#pragma once
#include <vector>

#include "sonar/ping/ping_record.h"
#include "sonar/scenario/scenario.h"

namespace asdic::detail {

/// Joins the sound of single pings to one stream per phone without gaps: ping by ping, the part
/// from its start to the start of the next one (of any transmitter), with all that is still
/// received of those before it. The last part is as long as its ping is received. Memory: the
/// longest record.
class Stream {
 public:
  explicit Stream(const Scenario& scenario);

  /// Puts the next part of the stream where the ping's own sound was. Pings have to come in order.
  void take(PingRecord& record);

  /// Samples of the longest part.
  [[nodiscard]] static std::size_t longest_part(const Scenario& scenario);

 private:
  std::vector<std::size_t> parts_;  // samples of every ping's part
  std::size_t next_ = 0;
  std::vector<float> waiting_;  // [channels × waiting samples × components] received later
  std::size_t waiting_samples_ = 0;
};

}  // namespace asdic::detail
