#pragma once
#include "io/hdf5/hdf5_file.h"
#include "io/ping/growing_table.h"
#include "raytrace/area/earth_places.h"
#include "sonar/ping/ping_record.h"

namespace asdic::detail {

/// The groups /arrivals and /bounces of ping and arrivals files (docs/formats/ping.md): every
/// eigenray of every leg, and where it bounces.
class ArrivalTable {
 public:
  /// \param earth  where the map is; known: each leg's end has its latitude and longitude
  ArrivalTable(Hdf5File& file, const EarthPlaces& earth);

  void add(int ping, const Leg& leg);
  void write();  ///< what was added since the last time

 private:
  EarthPlaces earth_;
  GrowingTable arrivals_, bounces_;
};

}  // namespace asdic::detail
