#pragma once
#include <string>
#include <vector>

#include "io/hdf5_file.h"

// How every file of ours names its datasets and axes.
namespace asdic {

/// Attributes long_name and, where there is one, units.
void describe(Hdf5File& file, const std::string& dataset, const std::string& long_name,
              const std::string& units = "");

/// Writes a vector that is the scale of a dimension.
template <class T>
void write_scale(Hdf5File& file, const std::string& dataset, const std::string& dimension,
                 const std::vector<T>& values, const std::string& long_name,
                 const std::string& units = "") {
  file.write<T>(dataset, values, {values.size()});
  describe(file, dataset, long_name, units);
  file.make_scale(dataset, dimension);
}

}  // namespace asdic
