#pragma once
#include <string>

#include "io/hdf5/hdf5_file.h"
#include "io/ping/ping_file.h"
#include "sonar/scenario/scenario.h"

// The parts of a ping file that are written once (docs/formats/ping.md).
namespace asdic::detail::ping_file {

void write_root(Hdf5File& file, const Scenario& scenario, const Provenance& provenance);
/// replica, replica_1, …: one per transmitter.
void write_replicas(Hdf5File& file, const Scenario& scenario, SampleTimes times);
void write_environment(Hdf5File& file, const Scenario& scenario);
/// Depths of an area on a grid of its own, over all that is heard, into group environment.
void write_area(Hdf5File& file, const Scenario& scenario);
void write_rays(Hdf5File& file, const RayPaths& rays);

}  // namespace asdic::detail::ping_file
