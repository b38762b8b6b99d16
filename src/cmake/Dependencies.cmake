# Every dependency is a Debian 12 package; validation/setup.sh installs them.
set(CMAKE_THREAD_PREFER_PTHREAD ON)
find_package(Threads REQUIRED)
find_package(CGAL 5.5 REQUIRED)
find_package(embree 3.13 REQUIRED)
find_package(CLI11 REQUIRED)
find_package(nlohmann_json REQUIRED)

# Arb and GMP bring no package configuration in Debian 12.
function(exactff_import_library target header library)
  find_path(${target}_INCLUDE_DIR ${header} REQUIRED)
  find_library(${target}_LIBRARY ${library} REQUIRED)
  add_library(exactff_dep::${target} INTERFACE IMPORTED)
  target_include_directories(exactff_dep::${target} INTERFACE ${${target}_INCLUDE_DIR})
  target_link_libraries(exactff_dep::${target} INTERFACE ${${target}_LIBRARY} ${ARGN})
endfunction()
exactff_import_library(gmp gmp.h gmp)
exactff_import_library(gmpxx gmpxx.h gmpxx exactff_dep::gmp)
exactff_import_library(mpfr mpfr.h mpfr exactff_dep::gmp)
exactff_import_library(flint flint/fmpz.h flint exactff_dep::mpfr)
exactff_import_library(arb arb.h flint-arb exactff_dep::flint)

# The Booleans allocate and free millions of small numbers, and jemalloc is faster at that (README has the figure). A
# library must not choose its user's allocator, so only the program is linked with it; sanitizers bring their own.
if(EXACTFF_JEMALLOC AND NOT EXACTFF_SANITIZE)
  exactff_import_library(jemalloc jemalloc/jemalloc.h jemalloc)
endif()
