#include "sonar/propagation_memory.h"
#include "sonar/scattering_sheet.h"

namespace asdic {
namespace {

// Every member of a law by name: one more does not compile until it is part of the key.

void add(ExactKey& key, const NrlSurface& law) {
  const auto& [strength, exponent, length, wind, speed] = law;
  key.add_all(strength, exponent, length, wind, speed);
}

void add(ExactKey& key, const ChapmanHarris& law) {
  const auto& [wind, speed] = law;
  key.add_all(wind, speed);
}

void add(ExactKey& key, const OgdenErskine& law) {
  const auto& [wind, speed] = law;
  key.add_all(wind, speed);
}

void add(ExactKey& key, const ScatteringTable& law) {
  const auto& [grazing, strength] = law;
  key.add_all(grazing, strength);
}

void add(ExactKey& key, const Lambert& law) {
  const auto& [mu] = law;
  key.add(mu);
}

void add(ExactKey& key, const EllisCrowe& law) {
  const auto& [mu, nu, slope] = law;
  key.add_all(mu, nu, slope);
}

void add(ExactKey& key, const VolumeSheet& law) {
  const auto& [strength, thickness] = law;
  key.add_all(strength, thickness);
}

void add(ExactKey& key, const Kinematics& end) {
  const auto& [position, velocity] = end;
  key.add_all(position, velocity);
}

}  // namespace

bool ScatteringSheet::add_to(ExactKey& key) const {
  key.add_all(out_->identity, back_->identity, law_.index());
  std::visit([&](const auto& law) { add(key, law); }, law_);
  const auto& [source, receiver, legs, source_speed, receiver_speed, frequency, latest, band] =
      ends_;
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

}  // namespace asdic
