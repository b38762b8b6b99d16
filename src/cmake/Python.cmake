# The Python module. EXACTFF_PYTHON requires it or excludes it; by default it is built if pybind11, NumPy and Python's
# headers are found.
set(EXACTFF_PYTHON AUTO CACHE STRING "Build the Python module: AUTO (if pybind11 and NumPy are found), ON or OFF")
set_property(CACHE EXACTFF_PYTHON PROPERTY STRINGS AUTO ON OFF)

# The first python3 of PATH may be one that its user has built, without NumPy. Then that of the system is taken.
function(exactff_prefer_python_with_numpy)
  if(Python_EXECUTABLE OR Python_ROOT_DIR)
    return()
  endif()
  foreach(candidate python3 /usr/bin/python3)
    execute_process(COMMAND ${candidate} -c "import sys, numpy; print(sys.executable)" OUTPUT_VARIABLE executable
                    RESULT_VARIABLE failed ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE)
    if(failed EQUAL 0)
      set(Python_EXECUTABLE ${executable} PARENT_SCOPE)
      return()
    endif()
  endforeach()
endfunction()

set(EXACTFF_HAS_PYTHON OFF)
if(EXACTFF_SANITIZE OR EXACTFF_SANITIZE_THREADS)
  # The interpreter would have to be started with the sanitizer's library.
  if(EXACTFF_PYTHON AND NOT EXACTFF_PYTHON STREQUAL "AUTO")
    message(FATAL_ERROR "EXACTFF_PYTHON is ON, and sanitizers exclude it. Leave EXACTFF_PYTHON at AUTO, or leave out the sanitizers.")
  endif()
elseif(EXACTFF_PYTHON AND (PROJECT_IS_TOP_LEVEL OR NOT EXACTFF_PYTHON STREQUAL "AUTO"))
  exactff_prefer_python_with_numpy()
  find_package(Python 3.9 QUIET COMPONENTS Interpreter Development.Module NumPy)
  if(Python_FOUND)
    find_package(pybind11 2.10 QUIET)
  endif()
  if(pybind11_FOUND)
    set(EXACTFF_HAS_PYTHON ON)
  elseif(NOT EXACTFF_PYTHON STREQUAL "AUTO")
    message(FATAL_ERROR "EXACTFF_PYTHON is ON, and pybind11, NumPy or Python's headers were not found. Install pybind11-dev, "
                        "python3-numpy and python3-dev, or leave EXACTFF_PYTHON at AUTO.")
  endif()
endif()
if(EXACTFF_HAS_PYTHON)
  message(STATUS "Python: ON, for ${Python_EXECUTABLE}")
else()
  message(STATUS "Python: OFF")
endif()

# Debian's packages use another folder than pip and `python3 -m site`.
if(EXACTFF_HAS_PYTHON)
  set(python_dir lib/python${Python_VERSION_MAJOR}.${Python_VERSION_MINOR}/site-packages)
  if(CMAKE_INSTALL_PREFIX STREQUAL "/usr")
    set(python_dir lib/python3/dist-packages)
  endif()
  set(EXACTFF_PYTHON_DIR ${python_dir} CACHE STRING "Where the Python module is installed, below the prefix")
endif()
