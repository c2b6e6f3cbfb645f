#include "core/settings_key.h"
#include "reverb/pairs/scattering_sheet.h"

namespace asdic::detail {
namespace {

void add(ExactKey& key, const Kinematics& end) {
  const auto& [position, velocity] = end;
  key.add_all(position, velocity);
}

}  // namespace

bool ScatteringSheet::add_to(ExactKey& key) const {
  key.add_all(out_->identity, back_->identity, law_.index());
  std::visit([&](const auto& law) { add_settings(key, law); }, law_);
  const auto& [source, receiver, legs, source_speed, receiver_speed, frequency, latest, band] =
      ends_;
  for (const auto& groups : {groups_.out, groups_.back}) {
    const auto& [delay, level, level_of_range, depth, thickness] = groups->resolution;
    key.add_all(delay, level, level_of_range, depth, thickness);
  }
  add(key, source);
  add(key, receiver);
  key.add_all(source_speed, receiver_speed, frequency, latest, band.size(), legs.size());
  for (const auto& [until, line] : legs) {
    key.add(until);
    add(key, line);
  }
  bool all = pattern_.add_to(key);
  for (const auto& [at, pattern, more_nepers] : band) {
    key.add_all(at, more_nepers);
    all = pattern->add_to(key) && all;
  }
  return all;
}

}  // namespace asdic::detail
