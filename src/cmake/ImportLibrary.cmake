# Libraries without a package configuration in Debian. The build and the installed package share this file.

# exactff_import_library(NAME HEADER LIBRARY [LINKED...]): defines exactff_dep::NAME. LIBRARY may be a list of names that
# the library has on different systems. A library that is not found is added to exactff_missing.
function(exactff_import_library name header library)
  if(TARGET exactff_dep::${name})
    return()
  endif()
  string(TOUPPER EXACTFF_${name} prefix)
  find_path(${prefix}_INCLUDE_DIR ${header})
  find_library(${prefix}_LIBRARY NAMES ${library})
  mark_as_advanced(${prefix}_INCLUDE_DIR ${prefix}_LIBRARY)
  if(NOT ${prefix}_INCLUDE_DIR OR NOT ${prefix}_LIBRARY)
    list(GET library 0 library)
    set(exactff_missing ${exactff_missing} "${library} (${header})" PARENT_SCOPE)
    return()
  endif()
  add_library(exactff_dep::${name} INTERFACE IMPORTED GLOBAL)
  target_include_directories(exactff_dep::${name} INTERFACE ${${prefix}_INCLUDE_DIR})
  target_link_libraries(exactff_dep::${name} INTERFACE ${${prefix}_LIBRARY} ${ARGN})
endfunction()

set(exactff_missing "")
exactff_import_library(gmp gmp.h gmp)
exactff_import_library(gmpxx gmpxx.h gmpxx exactff_dep::gmp)
exactff_import_library(mpfr mpfr.h mpfr exactff_dep::gmp)
exactff_import_library(flint flint/fmpz.h flint exactff_dep::mpfr)
exactff_import_library(tinygltf tiny_gltf.h tinygltf)

# FLINT 3 contains Arb, with its headers in FLINT's folder; beside FLINT 2 it is a library of its own, with its headers
# directly in `include`. The sources include <arb.h> either way. An installed package says which it was built with.
if(NOT DEFINED exactff_arb_is_in_flint)
  set(exactff_arb_is_in_flint OFF)
  if(EXISTS "${EXACTFF_FLINT_INCLUDE_DIR}/flint/arb.h")
    set(exactff_arb_is_in_flint ON)
  endif()
endif()
if(NOT exactff_arb_is_in_flint)
  exactff_import_library(arb arb.h "flint-arb;arb" exactff_dep::flint)  # Debian's name, its own name
elseif(NOT TARGET exactff_dep::arb AND EXISTS "${EXACTFF_FLINT_INCLUDE_DIR}/flint/arb.h")
  add_library(exactff_dep::arb INTERFACE IMPORTED GLOBAL)
  target_include_directories(exactff_dep::arb INTERFACE ${EXACTFF_FLINT_INCLUDE_DIR}/flint)
  target_link_libraries(exactff_dep::arb INTERFACE exactff_dep::flint)
elseif(NOT TARGET exactff_dep::arb)
  list(APPEND exactff_missing "FLINT 3 (flint/arb.h)")
endif()
