# CHOLMOD of SuiteSparse, which has neither a pkg-config file nor a CMake package in Debian 12. Makes the target
# CHOLMOD::CHOLMOD. Used by the build, and installed for those who link a static libdrillmbd.
find_path(CHOLMOD_INCLUDE_DIR cholmod.h PATH_SUFFIXES suitesparse DOC "Folder of cholmod.h")
find_library(CHOLMOD_LIBRARY cholmod DOC "libcholmod")
mark_as_advanced(CHOLMOD_INCLUDE_DIR CHOLMOD_LIBRARY)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(CHOLMOD
  REQUIRED_VARS CHOLMOD_LIBRARY CHOLMOD_INCLUDE_DIR
  REASON_FAILURE_MESSAGE "install SuiteSparse (Debian: libsuitesparse-dev), or set CHOLMOD_INCLUDE_DIR and CHOLMOD_LIBRARY")

if(CHOLMOD_FOUND AND NOT TARGET CHOLMOD::CHOLMOD)
  add_library(CHOLMOD::CHOLMOD UNKNOWN IMPORTED)
  set_target_properties(CHOLMOD::CHOLMOD PROPERTIES
    IMPORTED_LOCATION "${CHOLMOD_LIBRARY}"
    INTERFACE_INCLUDE_DIRECTORIES "${CHOLMOD_INCLUDE_DIR}")
endif()
