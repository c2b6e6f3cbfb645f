#include "io/hdf5/scale.h"

namespace asdic {

void describe(Hdf5File& file, const std::string& dataset, const std::string& long_name,
              const std::string& units) {
  file.set_attribute(dataset, "long_name", long_name);
  if (!units.empty()) file.set_attribute(dataset, "units", units);
}

}  // namespace asdic
