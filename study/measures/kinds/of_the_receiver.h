#pragma once
#include "study/measures/measure.h"

namespace asdic::detail::study {

/// A detection of each target by the whole receiver: [measure.detection] asks for it.
struct DetectionByReceiver {
  static constexpr std::string_view name = "";
  static constexpr Needs needs{};
  static bool wanted(const MeasurePlan& plan) {
    return plan.detection && plan.detection->by == DetectionPlan::By::receiver;
  }
  static void of_target(const MeasuredPing& ping, std::size_t target, Collector& to);
};

/// How far off the receiver's place of a target is.
struct LocalisationError {
  static constexpr std::string_view name = "localisation_error";
  static constexpr Needs needs{.targets = true, .receiver = true};
  static void of_target(const MeasuredPing& ping, std::size_t target, Collector& to);
};

/// The same in its parts, of which ellipses are made.
struct LocalisationEllipse {
  static constexpr std::string_view name = "localisation_ellipse";
  static constexpr Needs needs{.targets = true, .receiver = true};
  static void of_target(const MeasuredPing& ping, std::size_t target, Collector& to);
};

/// Detections that are no target's, of any receiver.
struct FalseAlarms {
  static constexpr std::string_view name = "";
  static constexpr Needs needs{};
  static bool wanted(const MeasurePlan& plan) { return plan.uses_receiver(); }
  static void of_ping(const MeasuredPing& ping, Collector& to);
};

}  // namespace asdic::detail::study
