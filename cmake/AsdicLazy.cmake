# asdic_load_lazily(<program> <targets>...): the program loads the shared libraries behind these imported targets when it first calls
# one of their functions (app/lazy_library.h), not when it starts. Sanitizers and other processors: they are linked as usual.
function(asdic_load_lazily program)
  if(ASDIC_SANITIZE OR NOT CMAKE_SYSTEM_PROCESSOR STREQUAL "x86_64")
    return()
  endif()
  set(libraries "")
  foreach(target IN LISTS ARGN)
    get_target_property(aliased ${target} ALIASED_TARGET)
    if(aliased)
      set(target ${aliased})
    endif()
    foreach(property INTERFACE_LINK_LIBRARIES IMPORTED_LOCATION)
      get_target_property(found ${target} ${property})
      list(FILTER found INCLUDE REGEX "/lib[^/]*\\.so")
      list(APPEND libraries ${found})
    endforeach()
  endforeach()
  list(REMOVE_DUPLICATES libraries)
  get_property(folders GLOBAL PROPERTY ASDIC_LIBRARIES)
  set(archives asdic_commands)
  foreach(folder IN LISTS folders)
    list(APPEND archives asdic_${folder})
  endforeach()
  set(files ${archives})
  list(TRANSFORM files REPLACE "(.+)" "$<TARGET_FILE:\\1>")
  set(stubs "${PROJECT_BINARY_DIR}/${program}_lazy.cpp")
  add_custom_command(OUTPUT "${stubs}.stamp" BYPRODUCTS "${stubs}" VERBATIM
    COMMAND ${CMAKE_COMMAND} "-DNM=${CMAKE_NM}" "-DREADELF=${CMAKE_READELF}" "-DARCHIVES=${files}" "-DLIBRARIES=${libraries}"
            "-DOUTPUT=${stubs}" -P ${PROJECT_SOURCE_DIR}/cmake/LazyStubs.cmake
    COMMAND ${CMAKE_COMMAND} -E touch "${stubs}.stamp"
    DEPENDS ${archives} ${PROJECT_SOURCE_DIR}/cmake/LazyStubs.cmake
    COMMENT "Finding what ${program} calls of ${ARGN}")
  target_sources(${program} PRIVATE "${stubs}")
  set_source_files_properties("${stubs}" PROPERTIES OBJECT_DEPENDS "${stubs}.stamp" GENERATED TRUE)
  target_include_directories(${program} PRIVATE ${PROJECT_SOURCE_DIR})
  target_link_libraries(${program} PRIVATE ${CMAKE_DL_LIBS})
  target_link_options(${program} PRIVATE LINKER:--as-needed)
endfunction()
