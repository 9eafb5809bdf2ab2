# Runs at build time. Fails if a file of a room (source folder) includes a header of a room that it may not
# use.
#   FOLDERS  folders of the room, separated by commas
#   USES     folders whose headers the files of the room may include, separated by commas
#   FILES    a text file with the paths of the files of the room, one per line
#   STAMP    a file that is touched if all includes are permitted
cmake_minimum_required(VERSION 3.25)
string(REPLACE "," ";" own "${FOLDERS}")
string(REPLACE "," ";" uses "${USES}")
file(STRINGS ${FILES} files)
set(wrong "")
foreach(file IN LISTS files)
  file(STRINGS ${file} includes REGEX "^#include \"")
  foreach(include IN LISTS includes)
    string(REGEX REPLACE "^#include \"([^\"]+)\".*" "\\1" header "${include}")
    get_filename_component(folder ${header} DIRECTORY)
    if(NOT folder IN_LIST own AND NOT folder IN_LIST uses)
      file(RELATIVE_PATH name ${SOURCE} ${file})
      list(GET own 0 room)
      string(APPEND wrong "${name}: error: ${room} may not include ${header}: rooms.cmake draws no arrow from ${room} to ${folder}\n")
    endif()
  endforeach()
endforeach()
if(wrong)
  message(NOTICE "${wrong}")
  message(FATAL_ERROR "An arrow that the house does not have.")
endif()
file(TOUCH ${STAMP})
