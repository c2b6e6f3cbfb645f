#pragma once
#include "io/hdf5/hdf5_file.h"
#include "io/ping/growing_table.h"
#include "sonar/ping/ping_record.h"

namespace asdic::detail {

/// The groups /arrivals and /bounces of ping and arrivals files (docs/formats/ping.md): every
/// eigenray of every leg, and where it bounces.
class ArrivalTable {
 public:
  explicit ArrivalTable(Hdf5File& file);

  void add(int ping, const Leg& leg);
  void write();  ///< what was added since the last time

 private:
  GrowingTable arrivals_, bounces_;
};

}  // namespace asdic::detail
