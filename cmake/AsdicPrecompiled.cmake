# Precompiled headers: a third to a half of the compile time of most files. On in the presets release and portable, which
# run.sh and test.sh build; off in ci and the others, where a file that misses one of its includes is found.
option(ASDIC_PRECOMPILED_HEADERS "Precompile what most files include" OFF)

# Beside that these presets compile sources eight at a time (CMAKE_UNITY_BUILD), which saves as much again. For it names in the
# anonymous namespaces of one folder must differ: the compiler says where they do not.

# asdic_precompile(<header> <targets>...): the first target compiles cmake/<header>, the others, which have its options, use it.
# Files with options of their own do without: GCC would take the options that the header was compiled with.
function(asdic_precompile header first)
  if(NOT ASDIC_PRECOMPILED_HEADERS)
    return()
  endif()
  target_precompile_headers(${first} PRIVATE "${PROJECT_SOURCE_DIR}/cmake/${header}")
  foreach(target IN LISTS ARGN)
    target_precompile_headers(${target} REUSE_FROM ${first})
  endforeach()
  foreach(target IN LISTS first ARGN)
    # GCC 12 sees overruns of std::string that are not there (GCC PR 105329), and tells of them once the header is precompiled.
    target_compile_options(${target} PRIVATE -Wno-array-bounds)
    get_target_property(sources ${target} SOURCES)
    foreach(source IN LISTS sources)
      get_source_file_property(options "${source}" COMPILE_OPTIONS)
      if(options)
        set_source_files_properties("${source}" PROPERTIES SKIP_PRECOMPILE_HEADERS ON)
      endif()
    endforeach()
  endforeach()
endfunction()
