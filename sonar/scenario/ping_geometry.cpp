#include "sonar/scenario/ping_geometry.h"

namespace asdic::detail {
namespace {

bool rests(const Track& track) {
  return track.waypoints.empty() && track.start.velocity.isZero(0.0);
}

}  // namespace

PingGeometry::PingGeometry(const Scenario& scenario, const Transmission& sent, int ping)
    : scenario_(&scenario),
      sent_(sent),
      ping_(ping),
      transmitter_(&scenario.transmitters[static_cast<std::size_t>(sent.transmitter)]),
      sender_(sender_of(scenario, sent.transmitter)),
      source_(sender_.at(sent.time)),
      source_heading_(platform_heading(scenario, transmitter_->platform, sent.time)) {
  for (ArrayMotion& motion : array_motions(scenario)) {
    const Kinematics place = motion.at(sent.time);
    std::vector<Vec3> phones = motion.phones(ping, sent.time);
    listeners_.push_back({std::move(motion), place, std::move(phones)});
  }
}

const PingGeometry::Listener& PingGeometry::listener(int array) const noexcept {
  return listeners_[static_cast<std::size_t>(array)];
}

const ReceiverArray& PingGeometry::array(int index) const noexcept {
  return scenario_->arrays[static_cast<std::size_t>(index)];
}

bool PingGeometry::is_own(int array) const noexcept {
  return transmitter_->platform == this->array(array).platform;
}

const ArrayMotion& PingGeometry::motion(int array) const noexcept { return listener(array).motion; }

const Carried& PingGeometry::reference(int array) const noexcept {
  return motion(array).reference();
}

const Kinematics& PingGeometry::reference_place(int array) const noexcept {
  return listener(array).place;
}

const std::vector<Vec3>& PingGeometry::phones(int array) const noexcept {
  return listener(array).phones;
}

std::vector<Vec3> PingGeometry::phones_from(const Carried& point, int array) const {
  return motion(array).phones_from(point, ping_, time());
}

Carried PingGeometry::middle_of(int array, PhoneRange phones) const {
  return motion(array).middle_of(ping_, phones);
}

Carried PingGeometry::receiver(int array, int phone) const {
  return phone < 0 ? reference(array) : motion(array).phone(ping_, phone);
}

Carried PingGeometry::reverberation_point(int array, double frequency) const {
  constexpr double in_phase = 0.25, sea = 1500.0;  // [wavelengths], [m/s]
  const bool stays = is_own(array) || (rests(sender_.track) && rests(motion(array).carrier()));
  if (!stays || motion(array).deforms()) return reference(array);
  const double away = (source_.position - reference_place(array).position).norm();
  return away * frequency <= in_phase * sea ? sender_ : reference(array);
}

Kinematics PingGeometry::target_at(int target, double since) const {
  return scenario_->targets[static_cast<std::size_t>(target)].track.at(time() + since);
}

}  // namespace asdic::detail
