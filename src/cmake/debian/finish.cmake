# What Debian wants otherwise than `cmake --install` does it, done to the tree of each package before it is packed.
string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC)  # of SOURCE_DATE_EPOCH if that is set

foreach(component IN LISTS CPACK_COMPONENTS_ALL)
  set(root ${CPACK_TEMPORARY_INSTALL_DIRECTORY}/${component}/usr)
  string(TOUPPER ${component} upper)
  set(package ${CPACK_DEBIAN_${upper}_PACKAGE_NAME})
  set(documents ${root}/share/doc/${package})

  file(REMOVE ${root}/share/doc/exactff/LICENSE)  # the copyright file refers to Debian's copy
  configure_file(${CPACK_EXACTFF_COPYRIGHT} ${documents}/copyright COPYONLY)
  file(WRITE ${documents}/changelog
       "${CPACK_PACKAGE_NAME} (${CPACK_PACKAGE_VERSION}) unstable; urgency=medium\n\n"
       "  * Packaged from the sources of ${CPACK_PACKAGE_VERSION}.\n\n -- ${CPACK_PACKAGE_CONTACT}  ${date}\n")

  file(GLOB pages ${root}/share/man/man1/*.1)
  execute_process(COMMAND gzip -9nf ${documents}/changelog ${pages} COMMAND_ERROR_IS_FATAL ANY)

  # The Python of Debian looks for packages elsewhere than that of other prefixes.
  file(GLOB python_package ${root}/lib/python3.*/site-packages/exactff)
  if(python_package)
    file(MAKE_DIRECTORY ${root}/lib/python3/dist-packages)
    file(RENAME ${python_package} ${root}/lib/python3/dist-packages/exactff)
    cmake_path(GET python_package PARENT_PATH site_packages)
    cmake_path(GET site_packages PARENT_PATH of_version)
    file(REMOVE_RECURSE ${of_version})
  endif()
  file(GLOB linked ${root}/bin/exactff ${root}/lib/python3/dist-packages/exactff/*.so)
  foreach(file IN LISTS linked)
    file(RPATH_REMOVE FILE ${file})  # the library is where the system looks anyway
  endforeach()
endforeach()
