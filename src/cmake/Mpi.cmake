# MPI, for `exactff truth` on several machines. EXACTFF_MPI requires it or excludes it; by default it is used if it is
# found.
set(EXACTFF_MPI AUTO CACHE STRING "Let `exactff truth` run under mpirun: AUTO (if Boost.MPI is found), ON or OFF")
set_property(CACHE EXACTFF_MPI PROPERTY STRINGS AUTO ON OFF)

set(EXACTFF_HAS_MPI OFF)
if(EXACTFF_MPI)
  set(MPI_CXX_SKIP_MPICXX ON)  # not the bindings that MPI-3 removed
  find_package(MPI COMPONENTS CXX QUIET)
  set(Boost_USE_STATIC_LIBS OFF)  # the static one cannot be linked into a module
  find_package(Boost QUIET CONFIG OPTIONAL_COMPONENTS mpi)
  if(MPI_CXX_FOUND AND TARGET Boost::mpi)
    set(EXACTFF_HAS_MPI ON)
  elseif(NOT EXACTFF_MPI STREQUAL "AUTO")
    message(FATAL_ERROR "EXACTFF_MPI is ON, and Boost.MPI was not found. Install libboost-mpi-dev, libopenmpi-dev and "
                        "openmpi-bin, or leave EXACTFF_MPI at AUTO.")
  endif()
endif()
message(STATUS "MPI: ${EXACTFF_HAS_MPI}")
