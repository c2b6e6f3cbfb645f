#pragma once

namespace asdic::detail {

/// A segment of Doppler factors.
struct DopplerSpan {
  double lowest = 1.0, highest = 1.0;
};

}  // namespace asdic::detail
