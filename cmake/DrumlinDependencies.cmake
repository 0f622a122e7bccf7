# What the libraries of Drumlin are linked with, told once: the build reads it, and find_package(Drumlin) where they are installed.
# Before, drumlin_needs(PACKAGE ...) says how a package is asked for.
drumlin_needs(Eigen3 NO_MODULE)
drumlin_needs(nlohmann_json)
drumlin_needs(fmt)
drumlin_needs(hwy)
drumlin_needs(Threads)
drumlin_needs(ZLIB)
drumlin_needs(OpenSSL COMPONENTS Crypto)

# drumlin_library(TARGET LIBRARY [INCLUDES folder...]): a library that comes without a target of its own
function(drumlin_library target library)
  cmake_parse_arguments(L "" "" "INCLUDES" ${ARGN})
  if(NOT TARGET ${target})
    add_library(${target} INTERFACE IMPORTED GLOBAL)
    target_link_libraries(${target} INTERFACE ${library})
    target_include_directories(${target} INTERFACE ${L_INCLUDES})
  endif()
endfunction()

# deal.II loads the OpenMPI flavour of HDF5: that flavour everywhere, and the serial one where the continuum is not built. CMake's own search would
# ask the projects of users for C and for MPI.
if(DRUMLIN_CONTINUUM)
  find_library(DRUMLIN_HDF5_LIBRARY NAMES hdf5_openmpi hdf5 PATH_SUFFIXES hdf5/openmpi REQUIRED)
else()
  find_library(DRUMLIN_HDF5_LIBRARY NAMES hdf5_serial hdf5 PATH_SUFFIXES hdf5/serial REQUIRED)
endif()
drumlin_library(drumlin::hdf5 ${DRUMLIN_HDF5_LIBRARY})
