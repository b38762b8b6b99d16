# The storeys of src/, from the lowest to the highest. Each is a target that is compiled with the headers of itself and of
# the storeys below it, so that the compiler refuses an include upward.
set(exactff_storeys foundation scenes solver rivals products reports outside)

# exactff_see(TARGET STOREY [SCOPE]): lets the target include the private headers of this storey and of those below it.
function(exactff_see target storey)
  set(scope PRIVATE ${ARGN})
  list(GET scope -1 scope)
  foreach(name ${exactff_storeys})
    target_include_directories(${target} ${scope} ${PROJECT_SOURCE_DIR}/src/${name})
    if(name STREQUAL storey)
      break()
    endif()
  endforeach()
endfunction()

# exactff_storey(NAME): begins the storey of the folder. Its objects become a part of the library.
function(exactff_storey name)
  set(target exactff_${name})
  add_library(${target} OBJECT)
  exactff_see(${target} ${name})
  target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR}/include ${PROJECT_BINARY_DIR}/include)
  target_link_libraries(${target} PRIVATE exactff_flags exactff_libraries)
  target_sources(exactff PRIVATE $<TARGET_OBJECTS:${target}>)
  set(exactff_storey_target ${target} PARENT_SCOPE)
endfunction()

# exactff_room(NAME SOURCE...): the sources of a room, a folder of the storey. A quick build compiles them together.
function(exactff_room name)
  list(TRANSFORM ARGN PREPEND ${name}/)
  target_sources(${exactff_storey_target} PRIVATE ${ARGN})
  exactff_compile_group(${exactff_storey_target} ${name} ${ARGN})
endfunction()
