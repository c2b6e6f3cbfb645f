#!/usr/bin/env bash
# A project of somebody else's finds the installed asdic with find_package, compiles every header with flags of its own, calls a
# function of each library, runs. No installed type lies in memory differently for other instruction sets.
set -euo pipefail
root=$PWD
prefix=$(mktemp -d)
trap 'rm -rf "$prefix"' EXIT
cmake --install "${ASDIC_BUILD:?}" --prefix "$prefix/asdic" >/dev/null
include=$prefix/asdic/include/asdic
mkdir "$prefix/mine"
cat >"$prefix/mine/CMakeLists.txt" <<'CMAKE'
cmake_minimum_required(VERSION 3.25)
project(mine LANGUAGES CXX)
find_package(asdic REQUIRED)
add_executable(mine main.cpp every_header.cpp every_header_backwards.cpp)
target_link_libraries(mine PRIVATE asdic::study asdic::serve)
foreach(level v2 v3 v4)  # compiled, never run
  add_library(sizes_${level} OBJECT type_sizes.cpp)
  target_link_libraries(sizes_${level} PRIVATE asdic::study asdic::serve)
  target_compile_options(sizes_${level} PRIVATE -march=x86-64-${level} -w)
endforeach()
file(GENERATE OUTPUT sizes CONTENT "$<TARGET_OBJECTS:sizes_v2>\n$<TARGET_OBJECTS:sizes_v3>\n$<TARGET_OBJECTS:sizes_v4>\n")
CMAKE
(cd "$include" && find . -name '*.h' -printf '#include "%P"\n' | sort) >"$prefix/mine/every_header.cpp"
sort -r "$prefix/mine/every_header.cpp" >"$prefix/mine/every_header_backwards.cpp"
/usr/bin/python3 "$root/tests/support/type_sizes.py" "$include" >"$prefix/mine/type_sizes.cpp"
cat >"$prefix/mine/main.cpp" <<'CPP'
#include <cstdio>

#include "core/random.h"
#include "io/scenario_reader.h"
#include "raytrace/paths/eigenrays.h"
#include "reverb/scattering/lambert.h"
#include "serve/token.h"
#include "sonar/ping/ping.h"
#include "processing/tracker.h"
#include "study/sampling/law.h"

// A function of each library; one of them keeps matrices.
int main(int, char** arguments) {
  using namespace asdic;
  std::printf("core: %.3f\n", RandomStream(1, Draw::ambient_noise, 0, 0).normal());
  const EigenraySolver ocean({.water = SoundSpeedProfile::munk()});
  std::printf("raytrace: %zu paths\n", ocean.find(4500.0, 125.0, 25e3, 4000.0).size());
  std::printf("reverb: %.1f\n", Lambert{}.mu_db);
  TrackState state;
  state.covariance = 4.0 * state.covariance.Identity();
  state.predict(2.0, 0.0);
  std::printf("sonar: %.1f m²\n", state.covariance(0, 0));  // 4 + 2²·4
  std::printf("study: %.1f\n", study::CutLaw(study::Uniform{2.0, 5.0}).ends().high);
  std::printf("serve: %zu characters\n", serve::new_token().size());
  const PingSimulator simulator(read_scenario(arguments[1]));
  std::printf("io: %zu phones\n", simulator.scenario().arrays[0].phones.size());
  try {
    read_scenario("no such file");
  } catch (const std::exception& e) {
    std::puts(e.what());
  }
}
CPP
cmake -S "$prefix/mine" -B "$prefix/build" -G Ninja -DCMAKE_BUILD_TYPE=Debug -DCMAKE_PREFIX_PATH="$prefix/asdic" >/dev/null
cmake --build "$prefix/build" >"$prefix/log" 2>&1 || { cat "$prefix/log"; exit 1; }
"$prefix/build/mine" "$prefix"/asdic/share/asdic/scenarios/deep_ocean.toml | tee "$prefix/said"
grep -q '^raytrace: [1-9][0-9]* paths$' "$prefix/said"
grep -q '^sonar: 20.0 m²$' "$prefix/said"
grep -q '^study: 5.0$' "$prefix/said"
grep -q '^serve: 64 characters$' "$prefix/said"
grep -q '^io: 16 phones$' "$prefix/said"
grep -q 'no such file' "$prefix/said"
"$prefix/asdic/bin/asdic" --version

# Sizes and alignments, out of the objects of the three levels.
count=$(/usr/bin/python3 "$root/tests/support/type_sizes.py" "$include" --names | wc -l)
[ "$count" -gt 200 ] || { echo "only $count types found"; exit 1; }
while read -r object; do
  objcopy -O binary --only-section='.rodata*' "$object" "$object.sizes"
  [ "$(stat -c %s "$object.sizes")" -ge $((16 * count)) ] || { echo "no sizes in $object"; exit 1; }
  cmp "$object.sizes" "$(head -n 1 "$prefix/build/sizes").sizes" || { echo "sizes of types depend on the instruction set"; exit 1; }
done <"$prefix/build/sizes"
echo "$count types, alike for x86-64-v2, -v3 and -v4"
