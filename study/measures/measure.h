#pragma once
#include <concepts>
#include <string>
#include <string_view>
#include <vector>

#include "sonar/ping/ping.h"
#include "study/measures/echo_filter.h"
#include "study/measures/ping_run.h"
#include "study/measures/realisation.h"
#include "study/measures/receiver_measure.h"
#include "study/plan/measure_plan.h"
#include "study/plan/no_value.h"

// What a measure of a study is: a struct in a file of its own, and its name in measures.h.
namespace asdic::detail::study {

inline constexpr const char* level_unit = "dB re 1 µPa";

/// Collects the columns, or the values, of one pass over the measures: both in one order.
class Collector {
 public:
  explicit Collector(std::vector<Column>& columns) : columns_(&columns) {}
  explicit Collector(std::vector<double>& values) : values_(&values) {}

  /// \param name  of the column, in [a-z0-9_]   \param unit  "m/s", "1"
  void add(std::string_view name, std::string_view unit, std::string_view meaning, double value,
           Column::Role role = Column::Role::measure);
  /// What columns are called from here on after their names: "_rock"; "" nothing.
  void of(std::string suffix) { suffix_ = std::move(suffix); }
  /// Gives a reason why a value is not known; the first reason is kept.
  void explain(const std::string& why) {
    if (unknown_.empty()) unknown_ = why;
  }
  /// Reason why the first unknown value is not known; "": none was given.
  [[nodiscard]] const std::string& unknown() const noexcept { return unknown_; }

 private:
  std::vector<Column>* columns_ = nullptr;
  std::vector<double>* values_ = nullptr;
  std::string suffix_, unknown_;
};

/// One realisation's ping, or none, where its columns alone are wanted.
struct MeasuredPing {
  const MeasurePlan& plan;
  const Scenario& scenario;
  const PingSimulator* simulator = nullptr;
  const PingRecord* record = nullptr;         ///< null: columns alone are wanted
  ReceiverAnswers receiver = {};              ///< [targets], if the plan uses it
  std::vector<ExpectedAnswer> expected = {};  ///< [targets], if the plan's background is expected
  PingRun run = {};                           ///< if the plan has one

  [[nodiscard]] explicit operator bool() const noexcept { return record != nullptr; }
  /// Of one target. There is a record.
  [[nodiscard]] const TargetSummary& summary(std::size_t target) const {
    return record->summary[target];
  }
};

/// A level out of the ping's summary of a target, which needs no samples: `name` is its key in
/// [measure], `column`, `unit` and `meaning` are its column's.
template <class M>
concept LevelMeasure = requires(const TargetSummary& target) {
  { M::name } -> std::convertible_to<std::string_view>;
  { M::column } -> std::convertible_to<std::string_view>;
  { M::unit } -> std::convertible_to<std::string_view>;
  { M::meaning } -> std::convertible_to<std::string_view>;
  { M::of(target) } -> std::convertible_to<double>;
};
/// Adds its columns of one target, always the same ones; `name` is its key in [measure], `needs`
/// what else it takes.
template <class M>
concept TargetMeasure = requires(const MeasuredPing& ping, std::size_t target, Collector& to) {
  { M::name } -> std::convertible_to<std::string_view>;
  { M::needs } -> std::convertible_to<Needs>;
  M::of_target(ping, target, to);
};
/// The same of the ping as a whole.
template <class M>
concept PingMeasure = requires(const MeasuredPing& ping, Collector& to) {
  { M::name } -> std::convertible_to<std::string_view>;
  { M::needs } -> std::convertible_to<Needs>;
  M::of_ping(ping, to);
};
/// Has columns where its key is set, or where others' keys ask for it: then it says when.
template <class M>
concept WantedByItself = requires(const MeasurePlan& plan) {
  { M::wanted(plan) } -> std::same_as<bool>;
};
template <class M>
concept Measure = LevelMeasure<M> || TargetMeasure<M> || PingMeasure<M>;

/// A measure whose type is forgotten.
struct AnyMeasure {
  std::string_view name;  ///< key of [measure], true or false; "": it has none
  Needs needs;
  bool (*wanted)(const MeasurePlan& plan, std::string_view name);
  void (*of_target)(const MeasuredPing& ping, std::size_t target, Collector& to);
  void (*of_ping)(const MeasuredPing& ping, Collector& to);
};

template <Measure M>
constexpr AnyMeasure any_measure() {
  AnyMeasure made{
      .name = M::name,
      .needs = {.targets = true},
      .wanted = [](const MeasurePlan& plan, std::string_view name) { return plan.wants(name); },
      .of_target = [](const MeasuredPing&, std::size_t, Collector&) {},
      .of_ping = [](const MeasuredPing&, Collector&) {}};
  if constexpr (WantedByItself<M>)
    made.wanted = [](const MeasurePlan& plan, std::string_view) { return M::wanted(plan); };
  if constexpr (LevelMeasure<M>) {
    made.of_target = [](const MeasuredPing& ping, std::size_t target, Collector& to) {
      to.add(M::column, M::unit, M::meaning, ping ? M::of(ping.summary(target)) : no_value);
    };
  } else {
    made.needs = M::needs;
    if constexpr (TargetMeasure<M>) made.of_target = &M::of_target;
    if constexpr (PingMeasure<M>) made.of_ping = &M::of_ping;
  }
  return made;
}

}  // namespace asdic::detail::study
