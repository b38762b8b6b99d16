# The flags of all our targets. CGAL's interval arithmetic and our own error bounds are only valid with -frounding-math
# and -ffp-contract=off.
add_library(exactff_flags INTERFACE)
target_compile_options(exactff_flags INTERFACE -frounding-math -ffp-contract=off -Wall -Wextra -Wpedantic -Wshadow
                                               -Wconversion -Wno-sign-conversion)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  target_compile_options(exactff_flags INTERFACE -Wno-restrict)  # GCC 12 warns about every "text" + std::string
endif()
# The same objects serve the program and shared objects, such as the package for Python. Without the option, functions
# could not be inlined that another library might replace, and the program would be slower.
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
target_compile_options(exactff_flags INTERFACE -fno-semantic-interposition)
# How vectors of doubles are passed between functions: all that take or return one are inlined (src/foundation/kernel/lanes.h).
target_compile_options(exactff_flags INTERFACE -Wno-psabi)
if(EXACTFF_TESTS)
  target_compile_definitions(exactff_flags INTERFACE EXACTFF_CHECKS_REQUIREMENTS)  # kernel/expect.h
endif()
# Only for the compilers that were tried: others have other warnings.
set(exactff_compiler "${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION}")
if(EXACTFF_WERROR AND exactff_compiler MATCHES "^(GNU (12|14)|Clang 14)\\.")
  target_compile_options(exactff_flags INTERFACE -Werror)
endif()
if(EXACTFF_SANITIZE)
  target_compile_options(exactff_flags INTERFACE -fsanitize=address,undefined -fno-sanitize=vptr -fno-sanitize-recover=all
                                                 -fno-omit-frame-pointer)
  target_link_options(exactff_flags INTERFACE -fsanitize=address,undefined)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_compile_options(exactff_flags INTERFACE -Wno-maybe-uninitialized)  # instrumentation hides initialisations
  endif()
endif()
if(EXACTFF_SANITIZE_THREADS)
  target_compile_options(exactff_flags INTERFACE -fsanitize=thread -fno-omit-frame-pointer)
  target_link_options(exactff_flags INTERFACE -fsanitize=thread)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_compile_options(exactff_flags INTERFACE -Wno-tsan -Wno-maybe-uninitialized)  # CGAL's and Boost's fences
  endif()
endif()
if(EXACTFF_FUZZ)
  target_compile_options(exactff_flags INTERFACE -fsanitize=fuzzer-no-link)  # coverage; libFuzzer comes with its targets
endif()
