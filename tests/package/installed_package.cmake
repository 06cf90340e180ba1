# Installs the build in BUILD_DIR under WORK_DIR, builds SOURCE_DIR/examples against what was
# installed, and runs it.
function(run)
  execute_process(COMMAND ${ARGV} RESULT_VARIABLE status OUTPUT_VARIABLE out ERROR_VARIABLE out)
  if(NOT status EQUAL 0)
    string(REPLACE ";" " " command "${ARGV}")
    message(FATAL_ERROR "${command}\nended with ${status}:\n${out}")
  endif()
  set(out "${out}" PARENT_SCOPE)
endfunction()

file(REMOVE_RECURSE ${WORK_DIR})
run(${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${WORK_DIR}/prefix)
run(${CMAKE_COMMAND} -S ${SOURCE_DIR}/examples -B ${WORK_DIR}/build -G ${GENERATOR}
    -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_BUILD_TYPE=Release
    -DCMAKE_PREFIX_PATH=${WORK_DIR}/prefix)
run(${CMAKE_COMMAND} --build ${WORK_DIR}/build)
run(${WORK_DIR}/build/build_and_cast ${SOURCE_DIR}/examples/cube.obj ${WORK_DIR}/cube.vdag)
# From the centre of the cube straight down: the bottom face, half of the cube's side away.
if(NOT out MATCHES "voxel 512 0 512 at t = (0\\.99|1)")
  message(FATAL_ERROR "the example prints something else:\n${out}")
endif()
run(${WORK_DIR}/prefix/bin/voxdag verify ${WORK_DIR}/cube.vdag --mesh ${SOURCE_DIR}/examples/cube.obj)
