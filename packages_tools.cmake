# SPDX-License-Identifier: GPL-3.0-or-later
# Read by cpack before it packs: without these tools it makes packages that depend on nothing, and says so in passing.
foreach(tool dpkg-shlibdeps file)
  find_program(found_${tool} ${tool})
  if(NOT found_${tool})
    message(FATAL_ERROR "${tool} is missing, which finds what the packages depend on: apt-get install dpkg-dev file")
  endif()
endforeach()
