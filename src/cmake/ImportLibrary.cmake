# Libraries without a package configuration in Debian 12. The build and the installed package share this file.

# exactff_import_library(NAME HEADER LIBRARY [LINKED...]): defines exactff_dep::NAME. A library that is not found is
# added to exactff_missing.
function(exactff_import_library name header library)
  if(TARGET exactff_dep::${name})
    return()
  endif()
  string(TOUPPER EXACTFF_${name} prefix)
  find_path(${prefix}_INCLUDE_DIR ${header})
  find_library(${prefix}_LIBRARY ${library})
  mark_as_advanced(${prefix}_INCLUDE_DIR ${prefix}_LIBRARY)
  if(NOT ${prefix}_INCLUDE_DIR OR NOT ${prefix}_LIBRARY)
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
exactff_import_library(arb arb.h flint-arb exactff_dep::flint)
