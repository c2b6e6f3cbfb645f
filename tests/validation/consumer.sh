#!/usr/bin/env bash
# A project of somebody else's finds the installed asdic with find_package, compiles against its headers, links, runs.
set -euo pipefail
prefix=$(mktemp -d)
trap 'rm -rf "$prefix"' EXIT
cmake --install "${ASDIC_BUILD:?}" --prefix "$prefix/asdic" >/dev/null
mkdir "$prefix/mine"
cat >"$prefix/mine/CMakeLists.txt" <<'CMAKE'
cmake_minimum_required(VERSION 3.25)
project(mine LANGUAGES CXX)
find_package(asdic REQUIRED)
add_executable(mine main.cpp)
target_link_libraries(mine PRIVATE asdic::io)
CMAKE
cat >"$prefix/mine/main.cpp" <<'CPP'
#include <cstdio>

#include "io/scenario_reader.h"
#include "raytrace/eigenrays.h"
#include "sonar/ping.h"

int main() {
  const asdic::EigenraySolver ocean({.water = asdic::SoundSpeedProfile::munk()});
  std::printf("%zu paths\n", ocean.find(4500.0, 125.0, 25e3, 4000.0).size());
  try {
    asdic::read_scenario("no such file");
  } catch (const std::exception& e) {
    std::puts(e.what());
  }
}
CPP
cmake -S "$prefix/mine" -B "$prefix/build" -G Ninja -DCMAKE_BUILD_TYPE=Debug -DCMAKE_PREFIX_PATH="$prefix/asdic" >/dev/null
cmake --build "$prefix/build" >/dev/null
"$prefix/build/mine" | tee "$prefix/said"
grep -q '^[1-9][0-9]* paths$' "$prefix/said"
grep -q 'no such file' "$prefix/said"
"$prefix/asdic/bin/asdic" --version
