# `cpack -G DEB` in the build folder: one Debian package of commands, libraries, headers, data and the Python package.
set(CPACK_PACKAGE_NAME drumlin)
set(CPACK_PACKAGE_CONTACT "Maintainers of Drumlin <maintainers@drumlin.invalid>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
# Libraries are found by what the programs load; what Python imports, and what programs of users are built with, is named.
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_DEPENDS "python3 (>= 3.11), python3-numpy, python3-scipy, python3-h5py, python3-matplotlib, python3-jinja2")
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS
    "g++, cmake, libeigen3-dev, nlohmann-json3-dev, libfmt-dev, libhwy-dev, zlib1g-dev, libssl-dev, libhdf5-openmpi-dev, libdeal.ii-dev")
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "python3-distributed, python3-mpi4py")
include(CPack)
