# Runs concurrency.has_no_data_races. SOURCE: the repository; FOLDER: build folder; GENERATOR and LAUNCHER: CMake generator
# and compiler launcher (ccache, or empty) of the build.

# run(WHAT COMMAND...): runs the command. If it fails, the error shows WHAT and the command's output.
function(run what)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "${what}: ${status}\n${output}")
  endif()
endfunction()

run("no build with the thread sanitizer" ${CMAKE_COMMAND} -S ${SOURCE} -B ${FOLDER} -G ${GENERATOR}
  -DGPU_PLANNING_SCENE_ROS=OFF -DGPU_PLANNING_SCENE_BENCH=OFF -DCMAKE_BUILD_TYPE=Debug
  -DCMAKE_UNITY_BUILD=ON -DCMAKE_UNITY_BUILD_BATCH_SIZE=20 -DCMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER}
  "-DCMAKE_CXX_FLAGS_DEBUG=-fsanitize=thread -O1 -finline-small-functions -g1")
cmake_host_system_information(RESULT processors QUERY NUMBER_OF_LOGICAL_CORES)
run("it does not build" ${CMAKE_COMMAND} --build ${FOLDER} --parallel ${processors} --target concurrency_test)
run("data races" ${CMAKE_COMMAND} -E env
  "TSAN_OPTIONS=suppressions=${SOURCE}/test/support/tsan.supp" XDG_CACHE_HOME=${FOLDER}/cache
  ${FOLDER}/test/concurrency/concurrency_test)
