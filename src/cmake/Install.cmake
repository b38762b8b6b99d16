# cmake --install. All installed paths are relative, so that an installed tree may be moved. Components: program, mpi
# (what the program loads under mpirun), python, library (what a program linked with the shared library needs to run),
# development.
include(CMakePackageConfigHelpers)

set(exactff_cmake_dir ${CMAKE_INSTALL_LIBDIR}/cmake/exactff)
set(exactff_doc_dir ${CMAKE_INSTALL_DATADIR}/doc/exactff)
set(exactff_examples_dir ${CMAKE_INSTALL_DATADIR}/exactff/examples)
set(exactff_generated ${PROJECT_BINARY_DIR}/installed)

# --- library ---
get_target_property(library_type exactff TYPE)
install(TARGETS exactff EXPORT exactff-targets
  ARCHIVE COMPONENT development
  LIBRARY COMPONENT library NAMELINK_COMPONENT development)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/exactff ${PROJECT_BINARY_DIR}/include/exactff
  DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development FILES_MATCHING PATTERN *.h)

install(EXPORT exactff-targets NAMESPACE exactff:: DESTINATION ${exactff_cmake_dir} COMPONENT development)
configure_package_config_file(src/cmake/exactff-config.cmake.in ${exactff_generated}/exactff-config.cmake
  INSTALL_DESTINATION ${exactff_cmake_dir})
write_basic_package_version_file(${exactff_generated}/exactff-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${exactff_generated}/exactff-config.cmake ${exactff_generated}/exactff-config-version.cmake
              ${PROJECT_SOURCE_DIR}/src/cmake/ImportLibrary.cmake
  DESTINATION ${exactff_cmake_dir} COMPONENT development)

# A project that uses the library.
install(DIRECTORY ${PROJECT_SOURCE_DIR}/validation/consumer/app/ DESTINATION ${exactff_examples_dir}/project
  COMPONENT development)

# --- pkg-config ---
# If there is only a static library, plain `pkg-config --libs` has to name its dependencies. FLINT, Arb, Embree and
# tinygltf have no .pc file everywhere, so they are named as they were found.
if(library_type STREQUAL "STATIC_LIBRARY")
  set(pc_requires "OpenEXR libpng mpfr gmpxx gmp")
  set(pc_libraries "")
  set(linked ${EXACTFF_FLINT_LIBRARY} ${EMBREE_LIBRARY} ${EXACTFF_TINYGLTF_LIBRARY})
  if(NOT exactff_arb_is_in_flint)
    list(PREPEND linked ${EXACTFF_ARB_LIBRARY})
  endif()
  foreach(file IN LISTS linked)
    cmake_path(ABSOLUTE_PATH file NORMALIZE)
    cmake_path(GET file PARENT_PATH folder)
    cmake_path(GET file STEM name)
    if(NOT folder IN_LIST CMAKE_CXX_IMPLICIT_LINK_DIRECTORIES)
      string(APPEND pc_libraries " -L${folder}")
    endif()
    string(REGEX REPLACE "^lib" " -l" name ${name})
    string(APPEND pc_libraries ${name})
  endforeach()
  string(APPEND pc_libraries " -pthread")
endif()
set(pc_prefix ${CMAKE_INSTALL_PREFIX})
foreach(kind LIB INCLUDE)
  string(TOLOWER pc_${kind}dir variable)
  set(${variable} ${CMAKE_INSTALL_${kind}DIR})
  if(NOT IS_ABSOLUTE "${${variable}}")
    set(${variable} "\${prefix}/${${variable}}")
  endif()
endforeach()
if(NOT IS_ABSOLUTE "${CMAKE_INSTALL_LIBDIR}")
  file(RELATIVE_PATH up /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
  string(REGEX REPLACE "/$" "" pc_prefix "\${pcfiledir}/${up}")
endif()
configure_file(src/cmake/exactff.pc.in ${exactff_generated}/exactff.pc @ONLY)
install(FILES ${exactff_generated}/exactff.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT development)

# --- program ---
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${exactff_doc_dir} COMPONENT program)
if(NOT EXACTFF_PROGRAM)
  return()
endif()
if(library_type STREQUAL "SHARED_LIBRARY")
  file(RELATIVE_PATH to_library /${CMAKE_INSTALL_BINDIR} /${CMAKE_INSTALL_LIBDIR})
  set_target_properties(exactff_program PROPERTIES INSTALL_RPATH "\$ORIGIN/${to_library}")
endif()
install(TARGETS exactff_program RUNTIME COMPONENT program)
if(TARGET exactff_mpi)
  install(TARGETS exactff_mpi LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/exactff COMPONENT mpi)
endif()
install(DIRECTORY ${PROJECT_SOURCE_DIR}/data/scenes DESTINATION ${exactff_examples_dir} COMPONENT program
  FILES_MATCHING PATTERN *.obj PATTERN *.mtl)

# The manual page and the completion are made of what the program says about itself:
# exactff_install_written(FILE FOLDER COMMAND...)
function(exactff_install_written file folder)
  set(written ${exactff_generated}/${file})
  get_filename_component(folder_of_written ${written} DIRECTORY)
  file(MAKE_DIRECTORY ${folder_of_written})
  add_custom_command(OUTPUT ${written} COMMAND ${ARGN} ${written} DEPENDS exactff_program VERBATIM)
  set_property(GLOBAL APPEND PROPERTY exactff_written ${written})
  install(FILES ${written} DESTINATION ${folder} COMPONENT program)
endfunction()
exactff_install_written(man/exactff.1 ${CMAKE_INSTALL_MANDIR}/man1
  ${PROJECT_SOURCE_DIR}/src/cmake/manual_page.sh $<TARGET_FILE:exactff_program>)
exactff_install_written(bash/exactff ${CMAKE_INSTALL_DATADIR}/bash-completion/completions
  exactff_program completion bash -o)
get_property(exactff_written GLOBAL PROPERTY exactff_written)
add_custom_target(exactff_written ALL DEPENDS ${exactff_written})
