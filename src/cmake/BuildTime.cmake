# What makes a build from scratch take less time. It changes nothing of what is built or tested.
#
# EXACTFF_QUICK_BUILD is for builds that nobody edits in: sources that instantiate the same templates are compiled
# together, and the standard headers of the unit tests are parsed once. That every source includes what it uses, and what
# is seen of it alone, a build without the option checks: test.sh without flags makes one.

# exactff_compile_together(TARGET): the sources of every folder as one; those with options of their own by themselves.
# What a folder's sources define for themselves therefore needs different names.
function(exactff_compile_together target)
  if(NOT EXACTFF_QUICK_BUILD)
    return()
  endif()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  get_target_property(sources ${target} SOURCES)
  foreach(source ${sources})
    cmake_path(ABSOLUTE_PATH source OUTPUT_VARIABLE path)
    cmake_path(GET path PARENT_PATH folder)
    cmake_path(GET folder FILENAME module)
    set_source_files_properties(${source} TARGET_DIRECTORY ${target} PROPERTIES UNITY_GROUP "${module}")
  endforeach()
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_compile_options(${target} PRIVATE -Wno-subobject-linkage)  # takes every source but the first for a header
  endif()
endfunction()

# exactff_precompile(TARGET HEADER...). Optimising, GCC 12 warns of what it inlines from precompiled standard headers:
# for targets of exactff_save_compile_time.
function(exactff_precompile target)
  if(EXACTFF_QUICK_BUILD AND EXACTFF_SANITIZE)
    target_precompile_headers(${target} PRIVATE ${ARGN})
  endif()
endfunction()

# exactff_save_compile_time(TARGET): under sanitizers, optimising the program and the tests takes minutes and saves their
# runs seconds, which are spent in the library: that is compiled as the build says.
function(exactff_save_compile_time target)
  if(EXACTFF_SANITIZE)
    target_compile_options(${target} PRIVATE -O0)
  endif()
endfunction()
