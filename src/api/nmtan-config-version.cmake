# SPDX-License-Identifier: MIT
#
# Versions with the same soname fit: a 0.x asks for its own x or an earlier one.
set(PACKAGE_VERSION "@VERSION@")
if(PACKAGE_FIND_VERSION VERSION_GREATER PACKAGE_VERSION)
  set(PACKAGE_VERSION_COMPATIBLE FALSE)
else()
  string(REGEX MATCH "^[0-9]+" _nmtan_major "@VERSION@")
  if(PACKAGE_FIND_VERSION_MAJOR EQUAL _nmtan_major OR NOT PACKAGE_FIND_VERSION)
    set(PACKAGE_VERSION_COMPATIBLE TRUE)
  endif()
  if(PACKAGE_FIND_VERSION VERSION_EQUAL PACKAGE_VERSION)
    set(PACKAGE_VERSION_EXACT TRUE)
  endif()
  unset(_nmtan_major)
endif()
