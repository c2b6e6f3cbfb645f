#include "io/hdf5/scale.h"

#include <array>
#include <utility>

namespace asdic::detail {

void write_filetype(Hdf5File& file, const std::string& filetype, const std::string& version) {
  file.set_attribute("", "Conventions", cf::version);
  file.set_attribute("", "filetype", filetype);
  file.set_attribute("", "version", version);
}

void describe(Hdf5File& file, const std::string& dataset, const std::string& long_name,
              const std::string& units, const Meaning& meaning) {
  const std::array<std::pair<const char*, std::string_view>, 6> attributes{
      {{"long_name", long_name},
       {"units", units},
       {"standard_name", meaning.standard_name},
       {"positive", meaning.positive},
       {"axis", meaning.axis},
       {"reference", meaning.reference}}};
  for (const auto& [key, value] : attributes)
    if (!value.empty()) file.set_attribute(dataset, key, value);
}

std::string write_time_axis(Hdf5File& file, const TimeAxis& axis, bool written_out) {
  if (written_out) {
    std::vector<double> times(axis.size);
    for (std::size_t k = 0; k < axis.size; ++k)
      times[k] = axis.start + static_cast<double>(k) * axis.step;
    const std::string dimension = axis.dimension.substr(axis.dimension.rfind('/') + 1);
    write_scale(file, axis.coordinate, dimension, times, axis.long_name, "s");
    return axis.coordinate;
  }
  file.make_dimension(axis.dimension, axis.size);
  describe(file, axis.dimension,
           "no values: number k is at time_start + k time_step, in s, " + axis.long_name);
  write_times(file, axis.dimension, axis);
  return axis.dimension;
}

void write_times(Hdf5File& file, const std::string& dataset, const TimeAxis& axis) {
  file.set_attribute(dataset, "time_start", axis.start);
  file.set_attribute(dataset, "time_step", axis.step);
}

double time_of_first(const Hdf5File& file, const std::string& dataset,
                     const std::string& coordinate) {
  return file.has_attribute(dataset, "time_start")
             ? file.attribute_number(dataset, "time_start")
             : file.read<double>(coordinate, {0}, {1}).front();
}

}  // namespace asdic::detail
