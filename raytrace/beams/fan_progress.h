#pragma once
#include <algorithm>
#include <cstddef>
#include <utility>

#include "raytrace/parallel/progress.h"

namespace asdic::detail {

/// The progress of a field that is summed again and again, from fans of more and more beams.
///
/// How many fans it takes is not known before the last. Of each is asked how many beams may be
/// enough: if the fans double until then, (beams done)/(beams of them all) is the share done. It
/// never falls; where fewer beams are enough the end comes early.
class FanProgress {
 public:
  explicit FanProgress(Progress whole) : whole_(std::move(whole)) {}

  /// A fan begins. \param enough  beams that may be enough, no fewer than `beams`
  void begin(std::size_t beams, std::size_t enough) {
    const double n = static_cast<double>(beams);
    const double later = 2.0 * (std::max(static_cast<double>(enough), n) - n);
    first_ = last_;
    last_ = std::max(first_, (earlier_ + n) / (earlier_ + n + later));
    earlier_ += n;
  }
  /// Of the fan that has begun: its own share becomes that of the whole.
  [[nodiscard]] Progress of_fan() const {
    if (!whole_) return {};
    return [this, first = first_, last = last_](double share) {
      return whole_(first + share * (last - first));
    };
  }

 private:
  Progress whole_;
  double first_ = 0.0, last_ = 0.0, earlier_ = 0.0;
};

}  // namespace asdic::detail
