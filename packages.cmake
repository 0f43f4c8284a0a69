# SPDX-License-Identifier: GPL-3.0-or-later
# `cpack -G DEB` in a build folder: pfv, libpfv-dev, python3-pfv and liggghts-pfv, of what is built there.
set(CPACK_PACKAGE_NAME pfv)
set(CPACK_PROJECT_CONFIG_FILE ${CMAKE_CURRENT_LIST_DIR}/packages_tools.cmake)
# who answers for the packages: as Debian's own tools are told
set(CPACK_PACKAGE_CONTACT "The pfv developers <nobody@example.invalid>")
if(NOT "$ENV{DEBFULLNAME}" STREQUAL "" AND NOT "$ENV{DEBEMAIL}" STREQUAL "")
  set(CPACK_PACKAGE_CONTACT "$ENV{DEBFULLNAME} <$ENV{DEBEMAIL}>")
endif()
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${CMAKE_LIBRARY_OUTPUT_DIRECTORY})
set(CPACK_STRIP_FILES ON)
# any BLAS works; this one is fast, and its threads do not get in the way of the solver's
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS libopenblas0-serial)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)

set(CPACK_COMPONENTS_ALL development)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libpfv-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_DESCRIPTION "Pore-scale finite volume flow through sphere packings: the C++ library")
# those of debian-packages.txt that the target pfv::pfv links or whose headers its own include
set(needs g++ libcgal-dev libeigen3-dev nlohmann-json3-dev zlib1g-dev libopenmpi-dev libhypre-dev libmetis-dev
    libsuitesparse-dev libtrilinos-amesos2-dev libtrilinos-tpetra-dev libtrilinos-kokkos-dev
    libtrilinos-kokkos-kernels-dev libtrilinos-teuchos-dev libtrilinos-epetra-dev libtrilinos-trilinosss-dev
    libtrilinos-shylu-dev)
if(PFV_WITH_MUMPS)
  list(APPEND needs libmumps-dev)
endif()
list(JOIN needs ", " CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS)

if(PFV_BUILD_COMMAND)
  list(APPEND CPACK_COMPONENTS_ALL command)
  set(CPACK_DEBIAN_COMMAND_PACKAGE_NAME pfv)
  set(CPACK_DEBIAN_COMMAND_PACKAGE_SHLIBDEPS ON)
  set(CPACK_DEBIAN_COMMAND_PACKAGE_SUGGESTS "openmpi-bin, python3-pfv")  # mpirun; pictures
  set(CPACK_DEBIAN_COMMAND_DESCRIPTION "Pore-scale finite volume flow through sphere packings: the command")
endif()
if(PFV_BUILD_PYTHON)
  list(APPEND CPACK_COMPONENTS_ALL python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-pfv)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS ON)
  execute_process(COMMAND ${PFV_PYTHON} -c "import sys; a, b = sys.version_info[:2]; print(f'python3 (>= {a}.{b}), python3 (<< {a}.{b + 1})')"
                  OUTPUT_VARIABLE python OUTPUT_STRIP_TRAILING_WHITESPACE)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "${python}, python3-numpy")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS "python3-matplotlib, python3-vtk9, xvfb")
  set(CPACK_DEBIAN_PYTHON_DESCRIPTION "Pore-scale finite volume flow through sphere packings: the Python module")
endif()
if(PFV_BUILD_LIGGGHTS)
  list(APPEND CPACK_COMPONENTS_ALL liggghts)
  set(CPACK_DEBIAN_LIGGGHTS_PACKAGE_NAME liggghts-pfv)
  set(CPACK_DEBIAN_LIGGGHTS_PACKAGE_SHLIBDEPS ON)
  set(CPACK_DEBIAN_LIGGGHTS_PACKAGE_SUGGESTS "openmpi-bin, python3-pfv")
  set(CPACK_DEBIAN_LIGGGHTS_DESCRIPTION "Pore-scale finite volume flow for LIGGGHTS: fix pfv")
endif()
include(CPack)
