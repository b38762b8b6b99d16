# Every dependency is a Debian 12 package; validation/setup.sh installs them.
set(CMAKE_THREAD_PREFER_PTHREAD ON)
set(CMAKE_FIND_PACKAGE_TARGETS_GLOBAL ON)  # a project that adds this one as a folder links what the library links
find_package(Threads REQUIRED)
find_package(CGAL 5.5 REQUIRED)
find_package(embree 3.13 REQUIRED)
# Debian's package of Imath, which OpenEXR uses, tells at length that its library for Python is not installed.
set(exactff_log_level ${CMAKE_MESSAGE_LOG_LEVEL})
set(CMAKE_MESSAGE_LOG_LEVEL NOTICE)
find_package(OpenEXR REQUIRED)
set(CMAKE_MESSAGE_LOG_LEVEL ${exactff_log_level})
find_package(PNG REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(CLI11 REQUIRED)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
include(ImportLibrary)

# The Booleans allocate and free millions of small numbers, and jemalloc is faster at that (src/README.md has the
# figure). Only the program is linked with it, because a library must not choose its user's allocator. Sanitizers have
# their own.
if(EXACTFF_PROGRAM AND EXACTFF_JEMALLOC AND NOT EXACTFF_SANITIZE)
  exactff_import_library(jemalloc jemalloc/jemalloc.h jemalloc)
endif()

if(exactff_missing)
  list(JOIN exactff_missing ", " exactff_missing)
  message(FATAL_ERROR "Not found: ${exactff_missing}. validation/setup.sh installs the Debian packages.")
endif()
