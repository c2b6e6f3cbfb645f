#!/usr/bin/env bash
# A project of somebody else's finds the installed asdic with find_package and builds the README's example with flags of its own.
# include/asdic is all that is installed of the sources, each header stands alone and needs nothing but the standard library, types
# lie in memory alike for all instruction sets, and the library shows its public names and no others.
set -euo pipefail
root=$PWD
prefix=$(mktemp -d)
trap 'rm -rf "$prefix"' EXIT
cmake --install "${ASDIC_BUILD:?}" --prefix "$prefix/asdic" >/dev/null
include=$prefix/asdic/include
if find "$prefix/asdic/include" -type f ! -path '*/include/asdic/*.h' | grep .; then echo "installed beside include/asdic"; exit 1; fi
if find "$prefix/asdic" -name '*.a' | grep .; then echo "installed: libraries of folders"; exit 1; fi

# The README's blocks after "As a library": what a CMakeLists.txt says, and a program.
mkdir "$prefix/mine"
/usr/bin/python3 - "$root/README.md" "$prefix/mine" <<'PYTHON'
import pathlib, re, sys
text = pathlib.Path(sys.argv[1]).read_text().split("## As a library")[1]
cmake, program = (re.search(rf"```{kind}\n(.*?)```", text, re.S)[1] for kind in ("cmake", "cpp"))
mine = pathlib.Path(sys.argv[2])
(mine / "readme.cmake").write_text(cmake)
(mine / "mine.cpp").write_text(program)
PYTHON
cat >"$prefix/mine/CMakeLists.txt" <<'CMAKE'
cmake_minimum_required(VERSION 3.25)
project(mine LANGUAGES CXX)
add_executable(mine mine.cpp)
include(readme.cmake)
file(GLOB headers "${ASDIC_INCLUDE}/asdic/*.h")
foreach(header IN LISTS headers)  # each alone
  get_filename_component(name "${header}" NAME_WE)
  file(WRITE "${PROJECT_BINARY_DIR}/alone_${name}.cpp" "#include <asdic/${name}.h>\n#include <asdic/${name}.h>\n")
  list(APPEND alone "${PROJECT_BINARY_DIR}/alone_${name}.cpp")
endforeach()
add_library(alone OBJECT ${alone})
target_link_libraries(alone PRIVATE asdic::asdic)
target_compile_options(alone PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Werror)
foreach(level v2 v3 v4)  # compiled, never run
  add_library(sizes_${level} OBJECT type_sizes.cpp)
  target_link_libraries(sizes_${level} PRIVATE asdic::asdic)
  target_compile_options(sizes_${level} PRIVATE -march=x86-64-${level})
endforeach()
file(GENERATE OUTPUT sizes CONTENT "$<TARGET_OBJECTS:sizes_v2>\n$<TARGET_OBJECTS:sizes_v3>\n$<TARGET_OBJECTS:sizes_v4>\n")
CMAKE
/usr/bin/python3 "$root/tests/support/type_sizes.py" "$include" >"$prefix/mine/type_sizes.cpp"
cmake -S "$prefix/mine" -B "$prefix/build" -G Ninja -DCMAKE_BUILD_TYPE=Debug -DCMAKE_PREFIX_PATH="$prefix/asdic" \
  -DASDIC_INCLUDE="$include" >/dev/null
cmake --build "$prefix/build" >"$prefix/log" 2>&1 || { cat "$prefix/log"; exit 1; }
cd "$prefix"
cp -r asdic/share/asdic/scenarios/. .
build/mine | tee said
grep -q '^16 phones, 960000 samples each$' said
grep -q ' dB re 1 µPa$' said
asdic/bin/asdic info ping.h5 >/dev/null
asdic/bin/asdic --version

# Sizes and alignments, out of the objects of the three levels.
count=$(/usr/bin/python3 "$root/tests/support/type_sizes.py" "$include" --names | wc -l)
[ "$count" -gt 35 ] || { echo "only $count types found"; exit 1; }
while read -r object; do
  objcopy -O binary --only-section='.rodata*' "$object" "$object.sizes"
  [ "$(stat -c %s "$object.sizes")" -ge $((16 * count)) ] || { echo "no sizes in $object"; exit 1; }
  cmp "$object.sizes" "$(head -n 1 build/sizes).sizes" || { echo "sizes of types depend on the instruction set"; exit 1; }
done <build/sizes
echo "$count types, alike for x86-64-v2, -v3 and -v4"

# What the library shows: asdic's own names, and what C++ makes of the standard library's templates.
nm --dynamic --defined-only --demangle asdic/lib*/libasdic.so asdic/lib*/*/libasdic.so 2>/dev/null >shown || true
grep -q 'asdic::Scenario::validate' shown || { echo "asdic::Scenario is not shown"; exit 1; }
if grep -E 'asdic::detail|asdic_|H5|Eigen|fftw|toml::' shown; then echo "shown, and not public"; exit 1; fi
