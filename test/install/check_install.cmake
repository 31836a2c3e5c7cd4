# The test install.a_package_builds_against_the_installed_one.
#
#   BUILD      the build to install
#   CONSUMER   a package to build against it
#   EXAMPLE    a second package, which plans for the robot of ROBOT.urdf and ROBOT.srdf
#   PLUGIN     a third package, which adds a planner
#   PREFIX     the CMAKE_INSTALL_PREFIX of BUILD
#   GENERATOR  the CMake generator of BUILD, because a machine may have only one
#   LAUNCHER   compiler launcher (ccache, or empty)
#   SANITIZE   whether BUILD has sanitizers, which CONSUMER then needs too
#   MODULE     whether BUILD has the Python module
#   MODULE_ENVIRONMENT  variables with which Python can load a sanitized module

# All files go to a temporary folder. In the package's own folder, roslaunch would find the installed launch file too.
execute_process(COMMAND mktemp --directory OUTPUT_VARIABLE folder OUTPUT_STRIP_TRAILING_WHITESPACE)

# fail(MESSAGE): ends the test.
function(fail message)
  file(REMOVE_RECURSE ${folder})
  message(FATAL_ERROR "${message}")
endfunction()

# run(WHAT COMMAND...): runs the command and sets `output`. If it fails, the error shows WHAT and the command's output.
function(run what)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT status EQUAL 0)
    fail("${what}: ${status}\n${output}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

# require_no_warning(WHAT OUTPUT): fails if the output has a warning.
function(require_no_warning what output)
  if(output MATCHES "[Ww]arning")
    fail("${what} gives a warning:\n${output}")
  endif()
endfunction()

# A sourced workspace would hide the installed files.
foreach(name LD_LIBRARY_PATH CMAKE_PREFIX_PATH ROS_PACKAGE_PATH PYTHONPATH)
  unset(ENV{${name}})
endforeach()
# The files go below DESTDIR. `cmake --install --prefix` would not do: catkin's setup files go to the prefix that BUILD
# was configured with, whatever --prefix is, and a test must not write there.
set(ENV{DESTDIR} ${folder}/root)
set(prefix ${folder}/root${PREFIX})
# The programs are compiled without optimisation, because they run for a moment only. Sanitized libraries need the
# sanitizers only where a program is linked.
set(build_options -DCMAKE_BUILD_TYPE=Release "-DCMAKE_CXX_FLAGS_RELEASE=-O0 -DNDEBUG"
  -DCMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER})
# ccache finds the results of earlier runs only if it leaves out the name of the temporary folder.
set(ENV{CCACHE_BASEDIR} ${folder})
set(ENV{CCACHE_NOHASHDIR} 1)
if(SANITIZE)
  foreach(kind EXE SHARED)
    list(APPEND build_options "-DCMAKE_${kind}_LINKER_FLAGS=-fsanitize=address,undefined")
  endforeach()
endif()

run("the package does not install" ${CMAKE_COMMAND} --install ${BUILD})
unset(ENV{DESTDIR})
run("find_package does not find it" ${CMAKE_COMMAND} -S ${CONSUMER} -B ${folder}/build -G ${GENERATOR}
  -DCMAKE_PREFIX_PATH=${prefix} ${build_options} -DPYTHON_EXECUTABLE=${PYTHON_EXECUTABLE})
run("a package does not build against it" ${CMAKE_COMMAND} --build ${folder}/build)
# A cube of 0.2 m. The installed read_mesh reads it.
set(cube ${folder}/cube.obj)
file(WRITE ${cube} "v -.1 -.1 -.1\nv .1 -.1 -.1\nv .1 .1 -.1\nv -.1 .1 -.1\nv -.1 -.1 .1\nv .1 -.1 .1\nv .1 .1 .1\nv -.1 .1 .1
f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n")
foreach(program with_variables with_targets)
  run("${program} gives wrong answers" ${folder}/build/${program} ${cube})
endforeach()

# The example finds a path from its start to its goal.
run("find_package does not find it for the example" ${CMAKE_COMMAND} -S ${EXAMPLE} -B ${folder}/example -G ${GENERATOR}
  -DCMAKE_PREFIX_PATH=${prefix} ${build_options} "-DCMAKE_CXX_FLAGS=-Wall -Wextra"
  -DPYTHON_EXECUTABLE=${PYTHON_EXECUTABLE})
require_no_warning("finding the package" "${output}")
run("the example does not build" ${CMAKE_COMMAND} --build ${folder}/example)
require_no_warning("building the example" "${output}")
# rosrun looks for programs in this folder.
set(program ${folder}/example/devel/lib/plan_a_motion/plan_a_motion)
run("the example finds no path" ${program} ${ROBOT}.urdf ${ROBOT}.srdf drive left right)
if(NOT output MATCHES "-1 0\\.8[^\n]*\n(.*\n)+1 0\\.8")
  fail("the example's path is another one:\n${output}")
endif()

# The planner of another package builds.
run("find_package does not find it for the plugin" ${CMAKE_COMMAND} -S ${PLUGIN} -B ${folder}/plugin -G ${GENERATOR}
  -DCMAKE_PREFIX_PATH=${prefix} ${build_options} -DPYTHON_EXECUTABLE=${PYTHON_EXECUTABLE}
  -DPython3_EXECUTABLE=${PYTHON_EXECUTABLE})
run("the plugin does not build" ${CMAKE_COMMAND} --build ${folder}/plugin)

# The installed tools run without a sourced workspace.
foreach(tool check_states generate_acm)
  run("${tool} does not run" ${prefix}/lib/gpu_planning_scene/${tool} --version)
endforeach()

set(share share/gpu_planning_scene)
foreach(file setup.bash ${share}/launch/planning_scene.launch ${share}/config/demo/kr5_scene.yaml ${share}/package.xml
        lib/gpu_planning_scene/planning_scene_node lib/gpu_planning_scene/demo_client.py
        lib/gpu_planning_scene/show_scene.py lib/gpu_planning_scene/allow_collision.py lib/gpu_planning_scene/save_scene.py
        lib/gpu_planning_scene/joint_sliders.py lib/gpu_planning_scene/limit_speed.py ${share}/config/scene.rviz
        ${share}/launch/live_demo.launch ${share}/launch/show_scene.launch ${share}/config/demo/arm.urdf
        ${share}/planner_plugins.xml lib/libgpu_planning_scene_planners.so)
  if(NOT EXISTS ${prefix}/${file})
    fail("${file} is not installed")
  endif()
endforeach()

# The Python module stands beside the messages of the same package.
if(MODULE)
  set(ENV{PYTHONPATH} ${prefix}/lib/python3/dist-packages)
  run("the Python module gives wrong answers" ${CMAKE_COMMAND} -E env ${MODULE_ENVIRONMENT} ${PYTHON_EXECUTABLE} -B
    ${CMAKE_CURRENT_LIST_DIR}/check_module.py ${prefix} ${ROBOT}.urdf ${cube})
endif()

# The programs compile the installed shaders: with a damaged shader the program fails and names it.
file(WRITE ${prefix}/share/gpu_planning_scene/shaders/shader_constants.h "#error the installed one\n")
execute_process(COMMAND ${folder}/build/with_variables ${cube} RESULT_VARIABLE status ERROR_VARIABLE output OUTPUT_VARIABLE output)
if(status EQUAL 0 OR NOT output MATCHES "the installed one")
  fail("the installed shaders are not used: ${status}\n${output}")
endif()
file(REMOVE_RECURSE ${folder})
