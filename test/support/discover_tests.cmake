# gps_add_test runs this script after it has linked a GoogleTest program. The script writes FILE, which ctest reads. FILE adds
# one CTest test per suite, because each new process loads robots and compiles shaders again. If the environment variable
# GPS_EACH_CASE is set, FILE adds one CTest test per case.
# PROGRAM: path of the program; RESULTS: folder for the XML reports of the tests; PROPERTIES: properties of all these tests.
execute_process(COMMAND ${CMAKE_COMMAND} -E env ASAN_OPTIONS=detect_leaks=0 ${PROGRAM} --gtest_list_tests
  RESULT_VARIABLE status OUTPUT_VARIABLE listing ERROR_VARIABLE error TIMEOUT 60)
if(NOT status EQUAL 0)
  message(FATAL_ERROR "${PROGRAM} does not list its tests: ${status}\n${error}")
endif()

set(suites "")
set(cases "")
string(REGEX REPLACE "[;[]" "_" listing "${listing}")
string(REPLACE "\n" ";" listing "${listing}")
# add(VARIABLE NAME ARGUMENTS...): appends the commands that add a test of the program.
function(add variable name)
  list(JOIN ARGN "]==] [==[" arguments)
  set(${variable} "${${variable}}add_test([==[${name}]==] [==[${PROGRAM}]==] [==[${arguments}]==])\n\
set_tests_properties([==[${name}]==] PROPERTIES ${PROPERTIES})\n" PARENT_SCOPE)
endfunction()
foreach(line IN LISTS listing)
  string(REGEX REPLACE " *#.*" "" line "${line}")
  if(line MATCHES "^  (.+)$")
    set(name "${suite}.${CMAKE_MATCH_1}")
    string(REPLACE "/" "." report "${name}")
    add(cases "${name}" "--gtest_filter=${name}" "--gtest_output=xml:${RESULTS}/${report}.xml")
  elseif(line MATCHES "^(.+)[.]$")
    set(suite "${CMAKE_MATCH_1}")
    string(REPLACE "/" "." report "${suite}")
    add(suites "${suite}" "--gtest_filter=${suite}.*" "--gtest_output=xml:${RESULTS}/${report}.xml")
  endif()
endforeach()
file(WRITE ${FILE} "if(DEFINED ENV{GPS_EACH_CASE})\n${cases}else()\n${suites}endif()\n")
