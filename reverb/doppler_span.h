#pragma once

namespace asdic {

/// A stretch of Doppler factors.
struct DopplerSpan {
  double lowest = 1.0, highest = 1.0;
};

}  // namespace asdic
