#include "library/physics.h"

#include "io/scenario/propagation.h"
#include "io/scenario/scenario_reader.h"
#include "raytrace/parallel/stop.h"
#include "raytrace/warnings/warnings.h"
#include "sonar/paths/enough_bounces.h"

namespace asdic {
namespace {

detail::Scenario physical(const Scenario::Data& data, const std::string& text) {
  detail::Scenario scenario = detail::scenario_of(data.document, data.path);
  scenario.text = text;
  return scenario;
}

}  // namespace

Physics::Physics(const Scenario::Data& data)
    : simulator_(physical(data, document_text(data)), nullptr, detail::budget_of(data.document)) {}

const detail::PingSimulator& Physics::ready_to_ping(const Watch& watch) {
  const std::scoped_lock lock(mutex_);
  int step = 0;
  const auto tell = [&] {
    ++step;
    if (watch.progress) watch.progress(step, 3);
  };
  tell();
  if (!judged_) detail::until_stopped(watch.stop, [&] { static_cast<void>(simulator_.memory()); });
  tell();
  if (!judged_) detail::until_stopped(watch.stop, [&] { simulator_.judge_paths(); });
  judged_ = true;
  tell();
  return simulator_;
}

std::vector<std::string> Physics::warnings() {
  const std::scoped_lock lock(mutex_);
  std::vector<std::string> all = simulator_.scenario().notes;
  detail::add_warnings({detail::ended_early(simulator_.paths().memory().ended_searches())}, all);
  return all;
}

Physics& Access::physics(const Scenario& scenario) {
  const Scenario::Data& data = *scenario.data_;
  const std::scoped_lock lock(data.mutex);
  if (!data.physics) data.physics = std::make_shared<Physics>(data);
  return *data.physics;
}

}  // namespace asdic
