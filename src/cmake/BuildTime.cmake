# Shortens builds from scratch. Does not change what is built or tested.
#
# EXACTFF_QUICK_BUILD is for builds in which nobody edits sources. Sources that instantiate the same templates are
# compiled together, and the standard headers of the unit tests are parsed once. Such a build does not check that every
# source includes what it uses, and misses warnings that appear only when a source is compiled by itself. A build
# without the option checks both: build.sh build/alone -DEXACTFF_TESTS=ON -DEXACTFF_WERROR=ON. With TESTS, only sources of
# tests are compiled together, and a change in the library costs as little as without the option.

# exactff_compile_group(TARGET NAME SOURCE...): compiles these sources of the target as one. Sources with their own compile
# options stay separate. What the sources define in the same unnamed namespace must differ by name.
function(exactff_compile_group target name)
  if(NOT EXACTFF_QUICK_BUILD)
    return()
  endif()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  set_source_files_properties(${ARGN} TARGET_DIRECTORY ${target} PROPERTIES UNITY_GROUP ${name})
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_compile_options(${target} PRIVATE -Wno-subobject-linkage)  # GCC treats all sources but the first as headers
  endif()
endfunction()

# exactff_compile_together(TARGET): compiles all sources of the target as one.
function(exactff_compile_together target)
  get_target_property(sources ${target} SOURCES)
  exactff_compile_group(${target} ${target} ${sources})
endfunction()

# exactff_precompile(TARGET HEADER...). When optimising, GCC 12 gives warnings about code that it inlines from
# precompiled standard headers. So use it for targets of exactff_save_compile_time only.
function(exactff_precompile target)
  if(EXACTFF_QUICK_BUILD)
    target_precompile_headers(${target} PRIVATE ${ARGN})
  endif()
endfunction()

# exactff_share_precompiled(TARGET OTHER): uses the headers that are precompiled for the other target, which must have
# the same compile options and definitions. Does nothing as long as there is none of that name.
function(exactff_share_precompiled target other)
  if(EXACTFF_QUICK_BUILD AND TARGET ${other} AND NOT target STREQUAL other)
    target_precompile_headers(${target} REUSE_FROM ${other})
  endif()
endfunction()

# exactff_save_compile_time(TARGET [LEVEL]): compiles the target with -O0, or with LEVEL where no sanitizer slows it down.
# Optimising the tests and the commands of the program would take minutes and save seconds of their runs. The runs spend
# their time in the library, which is compiled with the options of the build.
function(exactff_save_compile_time target)
  if(ARGC GREATER 1 AND NOT EXACTFF_SANITIZE)
    target_compile_options(${target} PRIVATE ${ARGV1})
  else()
    target_compile_options(${target} PRIVATE -O0)
  endif()
endfunction()

# exactff_save_compile_time_of_rooms(NAME...): compiles these rooms of the present storey with -O1 (-O0 under sanitizers).
# For rooms that present results.
function(exactff_save_compile_time_of_rooms)
  set(level -O1)
  if(EXACTFF_SANITIZE)
    set(level -O0)
  endif()
  get_target_property(sources ${exactff_storey_target} SOURCES)
  foreach(room ${ARGN})
    set(files ${sources})
    list(FILTER files INCLUDE REGEX "^${room}/")
    if(EXACTFF_QUICK_BUILD)
      # With an option of its own, a source would leave its group. So the source that CMake makes of the group gets it.
      set(files ${CMAKE_CURRENT_BINARY_DIR}/CMakeFiles/${exactff_storey_target}.dir/Unity/unity_${room}_cxx.cxx)
    endif()
    set_property(SOURCE ${files} APPEND PROPERTY COMPILE_OPTIONS ${level})
  endforeach()
endfunction()
