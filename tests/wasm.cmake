# The tests of a build for browsers (cmake --preset wasm -DVOXDAG_BUILD_TESTS=ON; cmake --build build/wasm --target
# wasm_tests; ctest --test-dir build/wasm): the library's, under Node with the machine's files. Those that
# need processes, mapped files or libraries that are left out are not among them.
add_library(gtest STATIC EXCLUDE_FROM_ALL /usr/src/googletest/googletest/src/gtest-all.cc)
target_include_directories(gtest SYSTEM PUBLIC /usr/src/googletest/googletest/include PRIVATE /usr/src/googletest/googletest)
target_compile_options(gtest PRIVATE -w)
set_target_properties(gtest PROPERTIES UNITY_BUILD OFF)

file(GLOB_RECURSE tests CONFIGURE_DEPENDS core/*_test.cpp mesh/*_test.cpp stored/*_test.cpp algebra/*_test.cpp edit/*_test.cpp
  builders/*_test.cpp file/*_test.cpp formats/*_test.cpp)
# Files of these suites ask for what browsers, or the libraries as they are compiled for them, lack. The tests of long DAGs ask for more than 4 GiB.
foreach(left_out core/io/confined_child core/io/atomic_file core/io/mapped_arrays core/io/open_input builders/dag/memory
    formats/readers/memory formats/readers/resident_memory formats/readers/mesh_chunks formats/readers/gltf_compression
    formats/scenes/flight stored/compact/compact_rays formats/input_file algebra/long_source_dag file/long_vdag_file)
  list(REMOVE_ITEM tests ${CMAKE_CURRENT_SOURCE_DIR}/${left_out}_test.cpp)
endforeach()
foreach(source ${tests})
  get_filename_component(folder ${source} DIRECTORY)
  set_property(SOURCE ${source} PROPERTY UNITY_GROUP ${folder})
endforeach()
add_executable(wasm_tests ${tests} support/main.cpp support/wasm_targets.cpp)
set_source_files_properties(support/main.cpp support/wasm_targets.cpp PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
set_target_properties(wasm_tests PROPERTIES UNITY_BUILD_MODE GROUP RULE_LAUNCH_LINK "${CMAKE_COMMAND} -E env NODE_PATH=/usr/share/nodejs")
target_include_directories(wasm_tests PRIVATE ${CMAKE_CURRENT_SOURCE_DIR})
target_link_libraries(wasm_tests PRIVATE voxdag_settings voxdag_formats voxdag_edit gtest nlohmann_json::nlohmann_json
  minizip::minizip zstd::zstd draco::draco meshoptimizer::meshoptimizer PNG::PNG JPEG::JPEG WebP::webp)
target_link_options(wasm_tests PRIVATE -sALLOW_MEMORY_GROWTH=1 -sMAXIMUM_MEMORY=4GB -sNODERAWFS=1 -sENVIRONMENT=node -sEXIT_RUNTIME=1
  "-sPTHREAD_POOL_SIZE=require('os').cpus().length+8")  # some tests start threads themselves
target_compile_definitions(wasm_tests PRIVATE FMT_HEADER_ONLY
  VOXDAG_EXPECTATIONS="${CMAKE_CURRENT_SOURCE_DIR}/formats/readers/pathological_expectations.txt"
  VOXDAG_HAS_OPENVDB=0 VOXDAG_HAS_VDB_EXPORT=0 VOXDAG_HAS_TIFF=0 VOXDAG_HAS_DICOM=0)
# Ask for a pipe, a full disk, or pages that an array gives back.
set(left_out ReadMesh.WhatIsNoFile* ExportGrids.*RefusePipes Npy.ReadsAPipe VdagFile.OtherThings*
  PageVector.CountsItsPages* */MappedMesh.AFullDisk* EsvoMemoryLimit.AnyLimit*)
list(JOIN left_out : left_out)
# With fetch(), the module would load its file from the web.
add_test(NAME wasm.library COMMAND ${CMAKE_CROSSCOMPILING_EMULATOR} -e "delete globalThis.fetch; require(process.argv[1])" $<TARGET_FILE:wasm_tests> --gtest_brief=1 --gtest_filter=-${left_out})
set_tests_properties(wasm.library PROPERTIES TIMEOUT 1200)
add_test(NAME wasm.threads COMMAND ${CMAKE_CROSSCOMPILING_EMULATOR} --test ${CMAKE_CURRENT_SOURCE_DIR}/wasm_threads.test.mjs)
set_tests_properties(wasm.threads PROPERTIES TIMEOUT 600 ENVIRONMENT "VOXDAG_MODULE=$<TARGET_FILE:voxdag_wasm>")
