# VOXDAG_PARTS names the folders of src/voxdag to build, all of them by default. This file adds the
# folders that those need, by src/voxdag/rooms.txt, and gives:
#   VOXDAG_ROOMS                   the folders to build, in the order of the pipeline
#   VOXDAG_ROOM_<name>_ROOMS       what a folder uses directly
#   VOXDAG_ROOM_<name>_PACKAGES    the packages that it links itself
set(VOXDAG_PARTS all CACHE STRING "Parts of the library to build: all, or names of folders of src/voxdag")

set(rooms_file ${PROJECT_SOURCE_DIR}/src/voxdag/rooms.txt)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${rooms_file})
file(STRINGS ${rooms_file} lines REGEX "^[a-z]")
set(all_rooms "")
foreach(line ${lines})
  string(REGEX MATCH "^([a-z_]+):([^|]*)\\|?(.*)$" matched "${line}")
  set(room ${CMAKE_MATCH_1})
  set(packages "${CMAKE_MATCH_3}")
  separate_arguments(VOXDAG_ROOM_${room}_ROOMS UNIX_COMMAND "${CMAKE_MATCH_2}")
  separate_arguments(VOXDAG_ROOM_${room}_PACKAGES UNIX_COMMAND "${packages}")
  list(APPEND all_rooms ${room})
endforeach()

if(VOXDAG_PARTS STREQUAL "all")
  set(VOXDAG_ROOMS ${all_rooms})
else()
  if(VOXDAG_BUILD_APPS OR VOXDAG_BUILD_TESTS)
    message(FATAL_ERROR "VOXDAG_PARTS: the command line and the tests need all parts; add "
                        "-DVOXDAG_BUILD_APPS=OFF -DVOXDAG_BUILD_TESTS=OFF")
  endif()
  set(needed ${VOXDAG_PARTS})
  foreach(room ${VOXDAG_PARTS})
    if(NOT room IN_LIST all_rooms)
      message(FATAL_ERROR "VOXDAG_PARTS: there is no part ${room}; parts: ${all_rooms}")
    endif()
  endforeach()
  # Rooms use only rooms above them in the table: one pass from the last to the first finds all.
  list(REVERSE all_rooms)
  foreach(room ${all_rooms})
    if(room IN_LIST needed)
      list(APPEND needed ${VOXDAG_ROOM_${room}_ROOMS})
    endif()
  endforeach()
  list(REVERSE all_rooms)
  set(VOXDAG_ROOMS "")
  foreach(room ${all_rooms})
    if(room IN_LIST needed)
      list(APPEND VOXDAG_ROOMS ${room})
    endif()
  endforeach()
endif()
