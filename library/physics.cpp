#include "library/physics.h"

#include "io/scenario/propagation.h"
#include "io/scenario/scenario_reader.h"
#include "raytrace/parallel/stop.h"

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
  return simulator_.scenario().notes;
}

Physics& Access::physics(const Scenario& scenario) {
  const Scenario::Data& data = *scenario.data_;
  const std::scoped_lock lock(data.mutex);
  if (!data.physics) data.physics = std::make_shared<Physics>(data);
  return *data.physics;
}

}  // namespace asdic
