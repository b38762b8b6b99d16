# validation/setup.sh installs the packages of these libraries; CMAKE_PREFIX_PATH names other folders to look in.
set(CMAKE_THREAD_PREFER_PTHREAD ON)
set(CMAKE_FIND_PACKAGE_TARGETS_GLOBAL ON)  # a project that adds this one as a folder links what the library links
set(CMAKE_INSTALL_RPATH_USE_LINK_PATH ON)  # what is installed finds the libraries outside the system's folders, too
find_package(Threads REQUIRED)
find_package(CGAL 5.5 REQUIRED)
# Without a version: Embree's configuration refuses to be a newer major version than what is asked for.
find_package(embree REQUIRED)
if(EMBREE_VERSION VERSION_LESS 3.13 OR EMBREE_VERSION VERSION_GREATER_EQUAL 5)
  message(FATAL_ERROR "Embree ${EMBREE_VERSION} was found in ${embree_DIR}, and exactff needs Embree 3.13 or 4. Let "
                      "CMAKE_PREFIX_PATH name the folder of such a version first.")
endif()
# Debian's package of Imath, which OpenEXR uses, tells at length that its library for Python is not installed.
set(exactff_log_level ${CMAKE_MESSAGE_LOG_LEVEL})
set(CMAKE_MESSAGE_LOG_LEVEL NOTICE)
find_package(OpenEXR REQUIRED)
set(CMAKE_MESSAGE_LOG_LEVEL ${exactff_log_level})
find_package(PNG REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(CLI11 REQUIRED)
find_package(fmt 9 REQUIRED)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
include(ImportLibrary)

# The Booleans allocate and free millions of small numbers, and jemalloc is faster at that. Without it
# (-DEXACTFF_JEMALLOC=OFF), 10,000 random triangles with `--engine boolean` take 58 % more processor time (2.69 s, not
# 1.66 s), `matrix gunter2.vs3 --accuracy 1e-2` 7 % more; `truth` and `view` the same to within 4 % (medians of pairs).
# Only the program is linked with it, because a library must not choose its user's allocator. Sanitizers have their own.
if(EXACTFF_PROGRAM AND EXACTFF_JEMALLOC AND NOT EXACTFF_SANITIZE)
  exactff_import_library(jemalloc jemalloc/jemalloc.h jemalloc)
endif()

if(exactff_missing)
  list(JOIN exactff_missing ", " exactff_missing)
  message(FATAL_ERROR "Not found: ${exactff_missing}. validation/setup.sh installs the packages, or says what is needed.")
endif()

file(STRINGS ${EXACTFF_FLINT_INCLUDE_DIR}/flint/flint.h flint_version REGEX "define FLINT_VERSION \"")
string(REGEX REPLACE ".*\"([0-9.]+).*" "\\1" flint_version "${flint_version}")
set(arb "in it")
if(NOT exactff_arb_is_in_flint)
  set(arb "beside it")
endif()
message(STATUS "Libraries: CGAL ${CGAL_VERSION}, FLINT ${flint_version} with Arb ${arb}, Embree ${EMBREE_VERSION}")

# For src/rivals/adaptive/embree.h
add_library(exactff_embree INTERFACE)
target_compile_definitions(exactff_embree INTERFACE EXACTFF_EMBREE_MAJOR=${EMBREE_VERSION_MAJOR})
target_link_libraries(exactff_embree INTERFACE embree)
