#pragma once
#include "fuzz/fuzz_target.h"
#include "io/bellhop/case_writer.h"

namespace asdic::detail::fuzz {

/// Reads a case; one that is read can be written, and what is written can be read.
inline void read_and_write(const bellhop::Texts& texts) {
  bellhop::Input input;
  if (refuses([&] { input = bellhop::read_case(texts, "case"); })) return;
  const ReceiverGrid& grid = input.run_case.receivers;
  constexpr std::size_t many = 10'000;  // more only take time to write
  if (grid.depths.size() + grid.ranges.size() + input.run_case.source_depths.size() > many) return;
  bellhop::Written written;
  if (input.map) {
    std::size_t n = input.map->source_x.size() + input.map->planes();
    for (const auto* map : {&input.map->bathymetry, &input.map->altimetry, &input.map->water})
      if (*map) n += (*map)->values.size();
    if (n > many) return;
  }
  if (refuses([&] {
        written = input.map ? bellhop::write_map_case(input)
                            : bellhop::write_case(input.run_case, input.binary_arrivals);
      }))
    return;
  insist(!refuses([&] { (void)bellhop::read_case(written.texts, "again"); }),
         "a case that was written can be read");
}

/// A small case whose companions are what is tested.
inline bellhop::Texts small_case(const char* top, const char* bottom, const char* run) {
  return {.env = std::string("'x'\n100\n1\n'") + top +
                 "'\n0 0 100\n0 1500 /\n50 1490 /\n100 1510 /\n'" + bottom +
                 "' 0\n100 1700 0 1.8 0.5 /\n1\n30 /\n2\n10 90 /\n3\n0 1 /\n'" + run +
                 "'\n21\n-40 40 /\n0 120 1.1\n",
          .companions = {}};
}

/// The same over a map.
inline bellhop::Texts small_map(const char* top, const char* bottom) {
  return {.env = std::string("'x'\n100\n1\n'") + top +
                 "'\n0 0 400\n0 1500 /\n50 1490 /\n400 1510 /\n'" + bottom +
                 "' 0\n400 1700 0 1.8 0.5 /\n1\n0 /\n1\n0 /\n1\n30 /\n2\n10 90 /\n3\n0 1 /\n4\n"
                 "0 270 /\n'CG   2'\n21\n-40 40 /\n9\n0 360 /\n0 2 2 500\n",
          .companions = {}};
}

}  // namespace asdic::detail::fuzz
