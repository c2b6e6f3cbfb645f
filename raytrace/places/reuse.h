#pragma once

namespace asdic::detail {

/// What of a ping's propagation was known before. It tells of the run, not of the result: two
/// threads that ask for the same at once may both search.
struct Reuse {
  bool ocean = false;           ///< another simulator had used an equal one
  int legs_searched = 0;        ///< sets of eigenrays, of echoes and direct blasts
  int legs_reused = 0;          ///< the same, out of what is kept
  int planes_searched = 0;      ///< vertical planes of paths to scattering boundaries and layers
  int planes_reused = 0;        ///< the same, out of what is kept
  bool reverberation = false;   ///< all paths to the scattering boundaries and layers were known
  bool expected_level = false;  ///< so were the reverberation's expected level and what is audible

  void count_legs(bool known) noexcept { ++(known ? legs_reused : legs_searched); }
  void count_planes(int planes, bool known) noexcept {
    (known ? planes_reused : planes_searched) += planes;
  }
};

}  // namespace asdic::detail
