# cmake -DPROGRAM=FILE -DOUTPUT=FILE -DLABELS=LIST -P list_families.cmake: writes a file for ctest with one test for each
# parameterised test of a GoogleTest program. One process runs it for all parameters: starting a process takes longer than
# most of these.
execute_process(COMMAND ${PROGRAM} --gtest_list_tests --gtest_filter=*/* OUTPUT_VARIABLE listed COMMAND_ERROR_IS_FATAL ANY)
string(REPLACE "\n" ";" listed "${listed}")
set(tests "")
foreach(line ${listed})
  if(line MATCHES "^([^ ]+)\\.")
    set(suite ${CMAKE_MATCH_1})
  elseif(line MATCHES "^  ([^ /]+)/")
    list(APPEND tests ${suite}.${CMAKE_MATCH_1})
  endif()
endforeach()
list(REMOVE_DUPLICATES tests)
set(text "")
foreach(test ${tests})
  # They are the longest tests, so they start first.
  string(APPEND text "add_test([=[${test}]=] [=[${PROGRAM}]=] [=[--gtest_filter=${test}/*]=])\n"
                     "set_tests_properties([=[${test}]=] PROPERTIES LABELS \"${LABELS}\" COST 10)\n")
endforeach()
file(WRITE ${OUTPUT} "${text}")
