# Installs the build in BUILD_DIR under WORK_DIR, builds SOURCE_DIR/examples and two small projects
# against the installed package, and runs them.
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
# Casts a ray from the centre of the cube straight down: it hits the bottom face, half of the cube's
# side away.
if(NOT out MATCHES "voxel 512 0 512 at t = (0\\.99|1)")
  message(FATAL_ERROR "the example prints something else:\n${out}")
endif()
run(${WORK_DIR}/build/read_vdag ${WORK_DIR}/cube.vdag)
if(NOT out MATCHES "voxel 512 0 512 at t = (0\\.99|1)")
  message(FATAL_ERROR "read_vdag prints something else:\n${out}")
endif()
run(${WORK_DIR}/prefix/bin/voxdag verify ${WORK_DIR}/cube.vdag --mesh ${SOURCE_DIR}/examples/cube.obj)
run(${WORK_DIR}/build/edit_voxels ${WORK_DIR}/cube.vdag ${WORK_DIR}/edited.vdag)
if(NOT out MATCHES "undo gave the snapshot: yes")
  message(FATAL_ERROR "the example prints something else:\n${out}")
endif()
run(${WORK_DIR}/prefix/bin/voxdag verify ${WORK_DIR}/edited.vdag)
run(${WORK_DIR}/build/character)
# Eight stairs of 20 cm lead from 1 m to 2.6 m, and the wall at 9 m stops a radius of 0.3 m.
if(NOT out MATCHES "6 s: stands at 8\\.(69|70), 8\\.00, 2\\.6")
  message(FATAL_ERROR "the example prints something else:\n${out}")
endif()

# Every public header compiles in a project that uses only the installed files.
file(STRINGS ${SOURCE_DIR}/cmake/public_headers.txt headers REGEX "^[a-z]")
set(text "")
foreach(header ${headers})
  string(APPEND text "#include \"voxdag/${header}\"\n")
endforeach()
file(WRITE ${WORK_DIR}/headers/headers.cpp "${text}int main() {}\n")
file(WRITE ${WORK_DIR}/headers/CMakeLists.txt "cmake_minimum_required(VERSION 3.22)
project(headers LANGUAGES CXX)
find_package(voxdag CONFIG REQUIRED)
add_executable(headers headers.cpp)
target_link_libraries(headers PRIVATE voxdag::voxdag)
")
run(${CMAKE_COMMAND} -S ${WORK_DIR}/headers -B ${WORK_DIR}/headers/build -G ${GENERATOR}
    -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_PREFIX_PATH=${WORK_DIR}/prefix)
run(${CMAKE_COMMAND} --build ${WORK_DIR}/headers/build)
file(GLOB_RECURSE internal ${WORK_DIR}/prefix/*-inl.hpp)
if(internal)
  message(FATAL_ERROR "internal headers were installed: ${internal}")
endif()

# A program that builds DAGs needs no package for files, to configure or to run.
set(disabled "")
foreach(package nlohmann_json FastFloat assimp embree CUDAToolkit)
  list(APPEND disabled -DCMAKE_DISABLE_FIND_PACKAGE_${package}=ON)
endforeach()
run(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR}/dag_only -B ${WORK_DIR}/dag_only -G ${GENERATOR}
    -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_PREFIX_PATH=${WORK_DIR}/prefix ${disabled})
run(${CMAKE_COMMAND} --build ${WORK_DIR}/dag_only)
run(${WORK_DIR}/dag_only/dag_only)
if(NOT out MATCHES "^1352 voxels")  # 16³ without the 14³ inside
  message(FATAL_ERROR "dag_only prints something else:\n${out}")
endif()
run(readelf -d ${WORK_DIR}/dag_only/dag_only)
string(REGEX MATCHALL "NEEDED[^\n]*" needed "${out}")
foreach(library ${needed})
  if(NOT library MATCHES "lib(tbb|hwy|png16|jpeg|webp|OpenEXR.*|Imath.*|Iex.*|IlmThread.*|stdc\\+\\+|m|gcc_s|c|atomic|pthread)\\.so|ld-linux")
    message(FATAL_ERROR "a program that links voxdag::builders needs ${library}")
  endif()
endforeach()
