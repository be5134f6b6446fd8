# SPDX-License-Identifier: MIT
#
# find_package(nmtan): the targets nmtan::nmtan (shared) and nmtan::static.
get_filename_component(_nmtan_prefix "${CMAKE_CURRENT_LIST_DIR}/@TO_PREFIX@" ABSOLUTE)
get_filename_component(_nmtan_libdir "${CMAKE_CURRENT_LIST_DIR}/../.." ABSOLUTE)

if(NOT TARGET nmtan::nmtan)
  add_library(nmtan::nmtan SHARED IMPORTED)
  set_target_properties(nmtan::nmtan PROPERTIES
    IMPORTED_LOCATION "${_nmtan_libdir}/libnmtan.so.@VERSION@"
    IMPORTED_SONAME libnmtan.so.0
    INTERFACE_INCLUDE_DIRECTORIES "${_nmtan_prefix}/include")
  add_library(nmtan::static STATIC IMPORTED)
  set_target_properties(nmtan::static PROPERTIES
    IMPORTED_LOCATION "${_nmtan_libdir}/libnmtan.a"
    INTERFACE_INCLUDE_DIRECTORIES "${_nmtan_prefix}/include"
    INTERFACE_LINK_LIBRARIES "-pthread;m")
endif()

foreach(_nmtan_target nmtan::nmtan nmtan::static)
  get_target_property(_nmtan_file ${_nmtan_target} IMPORTED_LOCATION)
  if(NOT EXISTS "${_nmtan_file}")
    set(nmtan_FOUND FALSE)
    set(nmtan_NOT_FOUND_MESSAGE "${_nmtan_file} is not there")
  endif()
endforeach()
unset(_nmtan_prefix)
unset(_nmtan_libdir)
unset(_nmtan_file)
