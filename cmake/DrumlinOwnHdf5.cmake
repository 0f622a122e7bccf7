# HDF5 within a program. The OpenMPI flavour, which deal.II needs, brings MPI, curl, Kerberos and some thirty libraries more, whose loading takes longer
# than a small contact problem. A program that never links deal.II sets its property DRUMLIN_OWN_HDF5 and holds Debian's serial flavour, where that is
# installed in the same version: our files are written without MPI in any case. The headers stay those of the one flavour.
find_library(DRUMLIN_OWN_HDF5_LIBRARY NAMES libhdf5.a PATH_SUFFIXES hdf5/serial)
find_path(DRUMLIN_OWN_HDF5_INCLUDES H5pubconf.h PATH_SUFFIXES hdf5/serial)
find_library(DRUMLIN_SZIP_LIBRARY NAMES sz)
mark_as_advanced(DRUMLIN_OWN_HDF5_LIBRARY DRUMLIN_OWN_HDF5_INCLUDES DRUMLIN_SZIP_LIBRARY)
set(own_hdf5_version none)
if(DRUMLIN_OWN_HDF5_INCLUDES)
  file(STRINGS ${DRUMLIN_OWN_HDF5_INCLUDES}/H5pubconf.h own_hdf5_version REGEX "define H5_PACKAGE_VERSION ")
  string(REGEX REPLACE ".*\"(.*)\".*" "\\1" own_hdf5_version "${own_hdf5_version}")
endif()
if(DRUMLIN_OWN_HDF5_LIBRARY AND DRUMLIN_SZIP_LIBRARY AND own_hdf5_version VERSION_EQUAL HDF5_VERSION)
  drumlin_library(drumlin::own_hdf5 "${DRUMLIN_OWN_HDF5_LIBRARY};${DRUMLIN_SZIP_LIBRARY};ZLIB::ZLIB;m;${CMAKE_DL_LIBS}")
  set_property(TARGET drumlin::hdf5 PROPERTY INTERFACE_LINK_LIBRARIES
               "$<IF:$<BOOL:$<TARGET_PROPERTY:DRUMLIN_OWN_HDF5>>,drumlin::own_hdf5,${DRUMLIN_HDF5_LIBRARY}>")
elseif(NOT DRUMLIN_HDF5_LIBRARY MATCHES "\\.a(;|$)")
  message(STATUS "HDF5 ${HDF5_VERSION} is not there as a static library (found: ${own_hdf5_version}): `drumlin` loads the shared one")
endif()
