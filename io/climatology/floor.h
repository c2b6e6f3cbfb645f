#pragma once
#include <string>
#include <vector>

#include "io/climatology/tiles.h"

namespace asdic::detail::climatology {

/// A place on the sphere, and those along great circles from it.
struct Place {
  double latitude, longitude;  // [°]

  [[nodiscard]] Place at(double distance, double bearing_deg) const;
};

/// What makes depths of a grid's values: +1 of depths, −1 of heights, by names, standard_name and
/// long_name. \param notes  grows where nothing tells
[[nodiscard]] double depth_sign(const DataGrid& grid, std::vector<std::string>& notes);

/// Depth of the sea out of heights or depths, in tiles.
class Floor {
 public:
  Floor(const std::vector<DataFile>& files, const OceanTime& when);

  /// Of the nearest grid point [m]: below 0 on land, NaN where unknown.
  [[nodiscard]] double depth(const Place& place) const {
    return checked(sign_ * tiles_.nearest(place.latitude, place.longitude), place);
  }
  /// Between grid points, for a floor without steps.
  [[nodiscard]] double between(const Place& place) const {
    return checked(sign_ * tiles_.bilinear(place.latitude, place.longitude), place);
  }
  /// That depth. \throws InputError for one that is none: of a missing value that the file does not
  /// tell, or of another unit
  [[nodiscard]] double checked(double depth, const Place& place) const;
  /// \return the depth [m] \throws InputError for land, a hole, or a place out of the files
  [[nodiscard]] double require(const Place& place) const;
  [[nodiscard]] double sign() const { return sign_; }  ///< of values that become depths
  [[nodiscard]] const Tiles& tiles() const { return tiles_; }
  [[nodiscard]] const std::vector<std::string>& notes() const { return notes_; }

 private:
  Tiles tiles_;
  double sign_ = -1.0;
  std::vector<std::string> notes_;
};

/// Depths along a great circle, to the first land, hole or edge of the files.
struct Track {
  std::vector<double> range{}, depth{};  ///< [points] [m]
  std::vector<std::string> notes{};
};

/// \param step  [m]; none: from grid line to grid line, and where the track crosses others if the
/// floor there leaves the straight line by more than 1 m and 0.2 % of the depth, so that no summit
/// of the grid is cut off. With a step it is sampled there alone, and a note says what that leaves
/// out. \throws InputError for a start on land, and more than 200 000 samples
[[nodiscard]] Track sample_track(const Floor& floor, const Place& start, double bearing_deg,
                                 double range, std::optional<double> step);

}  // namespace asdic::detail::climatology
