# How a folder becomes a target.

find_package(Threads REQUIRED)

# Warnings live here, and every target of ours links it. -Wrestrict is off: GCC 12 sees overlaps in std::string that are not
# there (GCC PR 105651). -Wpsabi is off: vectors wider than the instruction set's registers never leave the file they are in.
# Where sources are compiled together (CMAKE_UNITY_BUILD), a local may shadow what another file keeps to itself, and a class may
# hold it; GCC 12 then sees more overruns of std::string that are not there.
add_library(asdic_warnings INTERFACE)
add_library(asdic::warnings ALIAS asdic_warnings)
set(together $<AND:$<BOOL:${CMAKE_UNITY_BUILD}>,$<CXX_COMPILER_ID:GNU>>)
target_compile_options(asdic_warnings INTERFACE -Wall -Wextra -Wpedantic -Wshadow$<${together}:=local> -Wnon-virtual-dtor -Woverloaded-virtual
  -Wnull-dereference -Wdouble-promotion -Wformat=2 -Wimplicit-fallthrough -Wno-missing-field-initializers $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict> -Wno-psabi
  $<${together}:-Wno-subobject-linkage> $<${together}:-Wno-stringop-overflow> $<$<BOOL:${ASDIC_WERROR}>:-Werror>)

# Optimisation, sanitizers, coverage. No -ffast-math: the same bits for any number of threads.
add_library(asdic_any_level_options INTERFACE)
target_compile_options(asdic_any_level_options INTERFACE $<$<CONFIG:Release>:-O3>)
if(ASDIC_SANITIZE)
  target_compile_options(asdic_any_level_options INTERFACE -fsanitize=${ASDIC_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=undefined)
  target_link_options(asdic_any_level_options INTERFACE -fsanitize=${ASDIC_SANITIZE})
endif()
if(ASDIC_COVERAGE)
  target_compile_options(asdic_any_level_options INTERFACE --coverage)
  target_link_options(asdic_any_level_options INTERFACE --coverage)
endif()

# The above for the instructions that every machine has; what is hot is compiled for more of them.
include(AsdicLevels)
add_library(asdic_build_options INTERFACE)
target_link_libraries(asdic_build_options INTERFACE asdic_any_level_options asdic_baseline)

# asdic_library(<folder> PUBLIC ... PRIVATE ... LEVELS ...): every .cpp below <folder> makes asdic::<folder>, but for those in a
# folder mpi. LEVELS: how the paths of hot sources begin: a folder, or a file with what its name begins.
function(asdic_library folder)
  cmake_parse_arguments(ARG "" "" "PUBLIC;PRIVATE;LEVELS" ${ARGN})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/${folder}/*.cpp")
  set(hot "")
  foreach(place IN LISTS ARG_LEVELS)
    set(there ${sources})
    list(FILTER there INCLUDE REGEX "^${PROJECT_SOURCE_DIR}/${place}")
    list(APPEND hot ${there})
  endforeach()
  list(REMOVE_ITEM sources ${hot})
  list(FILTER sources EXCLUDE REGEX "/mpi/[^/]*$")  # AsdicMpi.cmake
  if(NOT sources)  # a folder of headers only
    file(CONFIGURE OUTPUT "${PROJECT_BINARY_DIR}/${folder}_empty.cpp" CONTENT "")
    set(sources "${PROJECT_BINARY_DIR}/${folder}_empty.cpp")
  endif()
  add_library(asdic_${folder} STATIC ${sources})
  add_library(asdic::${folder} ALIAS asdic_${folder})
  set_target_properties(asdic_${folder} PROPERTIES EXPORT_NAME ${folder} POSITION_INDEPENDENT_CODE ON LINKER_LANGUAGE CXX)
  target_compile_features(asdic_${folder} PUBLIC cxx_std_20)
  target_include_directories(asdic_${folder} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
                             $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/asdic>)
  target_link_libraries(asdic_${folder} PUBLIC ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE} Threads::Threads
                        $<BUILD_INTERFACE:asdic_warnings> $<BUILD_INTERFACE:asdic_build_options>)
  if(hot)
    asdic_levels(${folder} LIBRARIES ${ARG_PUBLIC} ${ARG_PRIVATE} SOURCES ${hot})
  endif()
  set_property(GLOBAL APPEND PROPERTY ASDIC_LIBRARIES ${folder})
endfunction()

# asdic_allocator(<program>): oneTBB's allocator stands for malloc and new. What is kept of one realisation of a study lies between
# the large arrays of the next ones, which malloc's heap then has no holes for: it grew by 70 kB a realisation. Faster, too.
function(asdic_allocator program)
  if(NOT ASDIC_SANITIZE)
    target_link_libraries(${program} PRIVATE -Wl,--push-state,--no-as-needed $<TARGET_LINKER_FILE:TBB::tbbmalloc_proxy> -Wl,--pop-state)
  endif()
endfunction()

# asdic_program(<folder> <libraries>...): the .cpp of <folder> make bin/asdic. All but main.cpp are a library of their own, asdic_commands,
# from which asdic-mpi takes what it needs.
function(asdic_program folder)
  file(GLOB sources CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/${folder}/*.cpp")
  list(REMOVE_ITEM sources "${PROJECT_SOURCE_DIR}/${folder}/main.cpp")
  add_library(asdic_commands STATIC ${sources})
  set_target_properties(asdic_commands PROPERTIES POSITION_INDEPENDENT_CODE ON)  # as the folders: they share a precompiled header
  target_link_libraries(asdic_commands PUBLIC ${ARGN} Threads::Threads PRIVATE asdic_warnings asdic_build_options)
  add_executable(asdic_${folder} "${PROJECT_SOURCE_DIR}/${folder}/main.cpp")
  set_target_properties(asdic_${folder} PROPERTIES OUTPUT_NAME asdic RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin)
  target_link_libraries(asdic_${folder} PRIVATE asdic_commands asdic_warnings asdic_build_options)
  asdic_allocator(asdic_${folder})
endfunction()
