# Debian packages: `cpack -G DEB` in a build folder. There is one package for the program and one for compiling other
# programs. If they were built, there are also one for Python, one for running under mpirun, and with BUILD_SHARED_LIBS
# one for the library. Tests and benchmarks are not installed, so no package has them.
set(EXACTFF_PACKAGE_CONTACT "exactff developers <exactff@example.org>" CACHE STRING
    "Whom the Debian packages name as their maintainer: NAME <ADDRESS>")

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME exactff)
set(CPACK_PACKAGE_VENDOR "exactff developers")
set(CPACK_PACKAGE_CONTACT ${EXACTFF_PACKAGE_CONTACT})
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_COMPONENTS_ALL development)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)  # dpkg-shlibdeps finds the dependencies of the program
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_PRE_BUILD_SCRIPTS ${PROJECT_SOURCE_DIR}/src/cmake/debian/finish.cmake)
set(CPACK_EXACTFF_COPYRIGHT ${PROJECT_SOURCE_DIR}/src/cmake/debian/copyright)

set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "exact form factors from a point to a polygonal source")
set(about "A form factor, or view factor, tells which share of what leaves a point\nreaches a patch. exactff computes it with any "
          "number of occluders in\nbetween, correctly rounded and with proof, and measures how far\nray-sampled algorithms "
          "are from that.")
string(CONCAT about ${about})

if(EXACTFF_PROGRAM)
  list(APPEND CPACK_COMPONENTS_ALL program)
  set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME exactff)
  set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION science)
  set(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS gnuplot-nox)  # draws the figures of the reports
  set(CPACK_DEBIAN_PROGRAM_DESCRIPTION ${about})
endif()
if(EXACTFF_HAS_PYTHON)
  list(APPEND CPACK_COMPONENTS_ALL python)
  math(EXPR next_minor "${Python_VERSION_MINOR} + 1")  # the module is for one version of Python
  set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-exactff)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
      "python3 (>= ${Python_VERSION_MAJOR}.${Python_VERSION_MINOR}), python3 (<< ${Python_VERSION_MAJOR}.${next_minor}), python3-numpy")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS "python3-meshio, python3-tqdm, python3-matplotlib")
  set(CPACK_DEBIAN_PYTHON_DESCRIPTION "${about}\n.\nThis package holds the module for Python.")
endif()
if(TARGET exactff_mpi)
  list(APPEND CPACK_COMPONENTS_ALL mpi)
  set(CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS exactff-mpi)
  set(CPACK_DEBIAN_MPI_PACKAGE_NAME exactff-mpi)
  set(CPACK_DEBIAN_MPI_PACKAGE_SECTION science)
  set(CPACK_DEBIAN_MPI_PACKAGE_DEPENDS "exactff (= ${PROJECT_VERSION})")
  set(CPACK_DEBIAN_MPI_PACKAGE_RECOMMENDS openmpi-bin)  # mpirun
  set(CPACK_DEBIAN_MPI_DESCRIPTION "${about}\n.\nThis package lets `exactff truth` run on several machines under mpirun.")
endif()

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libexactff-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SUGGESTS libgtest-dev)  # for exactff/testing.h
set(CPACK_DEBIAN_DEVELOPMENT_DESCRIPTION "${about}\n.\nThis package holds the library and its headers.")
if(library_type STREQUAL "SHARED_LIBRARY")
  list(APPEND CPACK_COMPONENTS_ALL library)
  get_target_property(soversion exactff SOVERSION)
  set(CPACK_DEBIAN_LIBRARY_PACKAGE_NAME libexactff${soversion})
  set(CPACK_DEBIAN_LIBRARY_PACKAGE_SECTION libs)
  set(CPACK_DEBIAN_LIBRARY_DESCRIPTION "${about}\n.\nThis package holds the shared library.")
  set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
  get_target_property(library_dir exactff BINARY_DIR)
  set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${library_dir})
  set(CPACK_DEBIAN_PROGRAM_PACKAGE_DEPENDS "libexactff${soversion} (= ${PROJECT_VERSION})")
  set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "libexactff${soversion} (= ${PROJECT_VERSION})")
  if(EXACTFF_HAS_PYTHON)
    string(APPEND CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS ", libexactff${soversion} (= ${PROJECT_VERSION})")
  endif()
else()
  # Dependencies of a static library, in the major versions that it was built with.
  math(EXPR next_embree "${EMBREE_VERSION_MAJOR} + 1")
  set(flint "libflint-dev (>= 3)")
  if(NOT exactff_arb_is_in_flint)
    set(flint "libflint-dev (<< 3), libflint-arb-dev")
  endif()
  set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
      "libgmp-dev, libmpfr-dev, ${flint}, libembree-dev (>= ${EMBREE_VERSION_MAJOR}), libembree-dev (<< ${next_embree}), \
libopenexr-dev, libpng-dev, libtinygltf-dev")
endif()
include(CPack)
