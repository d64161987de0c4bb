# Threads and order of the tests of this folder.
# Each test has one thread of OpenBLAS: threads of two tests at a time on two cores wait for each other actively, which takes up
# to twenty times longer. physics_modes_kernels_two sets one and two threads itself.
# Order, where several run at a time: ctest begins with the highest COST. First come all that
# long_tests.txt does not list, which take less than a second or two, then the others, the longest first, so that none of
# them is left to end alone. The COST of a listed test is its seconds.
set(long_tests ${CMAKE_CURRENT_LIST_DIR}/long_tests.txt)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${long_tests})
get_property(tests DIRECTORY PROPERTY TESTS)
foreach(name ${tests})
  set_tests_properties(${name} PROPERTIES COST 10000)
  set_property(TEST ${name} APPEND PROPERTY ENVIRONMENT OPENBLAS_NUM_THREADS=1)
endforeach()
file(STRINGS ${long_tests} entries REGEX "^[a-z]")
foreach(entry ${entries})
  if(entry MATCHES "^([a-z0-9_]+) +([0-9.]+) ")
    set(name ${CMAKE_MATCH_1})
    set(seconds ${CMAKE_MATCH_2})
    if(name IN_LIST tests)
      set_tests_properties(${name} PROPERTIES COST ${seconds})
    endif()
  else()
    message(FATAL_ERROR "tests/long_tests.txt: \"${entry}\" is not NAME SECONDS WORDS: REASON")
  endif()
endforeach()
