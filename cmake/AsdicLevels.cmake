# One binary for every processor: hot sources are compiled for x86-64-v2, v3 and v4, and the program chooses when it starts.
# docs/develop/instruction-levels.md
#
# A folder's hot sources make one object a level. In it every symbol is local but for its functions, which are renamed
# (name.v2, name.v3, name.v4), so that no inline function compiled for one level stands in for another's. What the rest of the
# program calls is a table of jumps under the plain names; core/instruction_level.cpp fills it before main.
option(ASDIC_NATIVE "Build for this machine alone, with every instruction it has" OFF)

set(ASDIC_ONLY_LEVEL "" CACHE STRING "For developers: build hot sources for this level alone (v2, v3 or v4)")
set(ASDIC_LEVELS "")
if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64)$" AND NOT ASDIC_NATIVE AND NOT ASDIC_SANITIZE AND NOT ASDIC_COVERAGE
   AND NOT CMAKE_BUILD_TYPE STREQUAL "Debug" AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  set(ASDIC_LEVELS v2 v3 v4)
  if(ASDIC_ONLY_LEVEL)
    set(ASDIC_LEVELS ${ASDIC_ONLY_LEVEL})
  endif()
  enable_language(ASM)
endif()
if(ASDIC_NATIVE)
  set(baseline -march=native)
  set(ASDIC_ONE_LEVEL native)
elseif(CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64)$")
  set(baseline -march=x86-64-v2)
  set(ASDIC_ONE_LEVEL x86-64-v2)
else()
  set(baseline "")
  set(ASDIC_ONE_LEVEL portable)
endif()

# Where AVX-512 is on, the headers of GCC 12 and before warn of variables that they leave undefined on purpose (GCC PR 105593).
set(avx512_options -Wno-uninitialized -Wno-maybe-uninitialized)
add_library(asdic_baseline INTERFACE)
if(NOT ASDIC_LEVELS)
  set_source_files_properties(core/instruction_level.cpp PROPERTIES COMPILE_DEFINITIONS ASDIC_ONE_LEVEL="${ASDIC_ONE_LEVEL}")
endif()
target_compile_options(asdic_baseline INTERFACE ${baseline} $<$<BOOL:${ASDIC_NATIVE}>:${avx512_options}>)

# asdic_levels(<folder> LIBRARIES ... SOURCES ...): these sources of asdic::<folder>, once a level.
function(asdic_levels folder)
  cmake_parse_arguments(ARG "" "" "LIBRARIES;SOURCES" ${ARGN})
  if(NOT ASDIC_LEVELS)
    target_sources(asdic_${folder} PRIVATE ${ARG_SOURCES})
    return()
  endif()
  set(made ${PROJECT_BINARY_DIR}/levels/${folder})
  foreach(level IN LISTS ASDIC_LEVELS)
    set(target asdic_${folder}_${level})
    add_library(${target} OBJECT ${ARG_SOURCES})
    set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE ON)
    target_compile_features(${target} PRIVATE cxx_std_20)
    target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR})
    target_link_libraries(${target} PRIVATE ${ARG_LIBRARIES} asdic_warnings asdic_any_level_options)
    target_compile_options(${target} PRIVATE -march=x86-64-${level} $<$<STREQUAL:${level},v4>:${avx512_options}>)
    file(GENERATE OUTPUT ${made}/${level}.objects CONTENT "$<JOIN:$<FILTER:$<TARGET_OBJECTS:${target}>,EXCLUDE,[.]gch$>,\n>\n")  # no precompiled header
    list(APPEND compiled $<TARGET_OBJECTS:${target}>)
    list(APPEND objects ${made}/${folder}_${level}.o)
    list(APPEND open ${made}/${folder}_${level}_open.o)
  endforeach()
  list(JOIN ASDIC_LEVELS "," names)
  add_custom_command(OUTPUT ${objects} ${open} ${made}/jumps.S
    COMMAND ${CMAKE_COMMAND} -D MADE=${made} -D FOLDER=${folder} -D LEVELS=${names} -D LD=${CMAKE_LINKER} -D OBJCOPY=${CMAKE_OBJCOPY} -D NM=${CMAKE_NM}
            -P ${PROJECT_SOURCE_DIR}/cmake/level_objects.cmake
    DEPENDS ${compiled} ${PROJECT_SOURCE_DIR}/cmake/level_objects.cmake
    COMMENT "Joining the instruction levels of ${folder}" VERBATIM COMMAND_EXPAND_LISTS)
  target_sources(asdic_${folder} PRIVATE ${made}/jumps.S ${objects})
  set_source_files_properties(${objects} PROPERTIES EXTERNAL_OBJECT ON GENERATED ON)
  add_custom_target(asdic_${folder}_open DEPENDS ${open})
endfunction()

# asdic_use_level(<target> <folder> <level>): a target that sees what the hot sources of a folder keep to themselves, and is itself
# compiled for that level: tests of them.
function(asdic_use_level target folder level)
  target_compile_options(${target} PRIVATE -march=x86-64-${level} $<$<STREQUAL:${level},v4>:${avx512_options}>)
  add_dependencies(${target} asdic_${folder}_open)
  set(open ${PROJECT_BINARY_DIR}/levels/${folder}/${folder}_${level}_open.o)
  set_source_files_properties(${open} PROPERTIES EXTERNAL_OBJECT ON GENERATED ON)
  target_sources(${target} PRIVATE ${open})  # before the libraries: the table of jumps is then not asked for
endfunction()
