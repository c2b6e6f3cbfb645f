#pragma once

namespace asdic::detail {

/// What of a ping's propagation was known before. It tells of the run, not of the result: two
/// threads that ask for the same at once may both search.
struct Reuse {
  bool ocean = false;           ///< another simulator had used an equal one
  int legs_searched = 0;        ///< sets of eigenrays, of echoes and direct blasts
  int legs_reused = 0;          ///< the same, out of what is kept
  bool reverberation = false;   ///< all paths to the scattering boundaries and layers were known
  bool expected_level = false;  ///< so were the reverberation's expected level and what is audible

  void count_legs(bool known) noexcept { ++(known ? legs_reused : legs_searched); }
};

}  // namespace asdic::detail
