# What `cmake --install` puts where, below one prefix that may be moved afterwards: nothing installed knows where it was built.
include(CMakePackageConfigHelpers)

# The libraries that users name hold the small ones, which are exported too for they are static.
add_library(drumlin_user_particles INTERFACE)
target_link_libraries(drumlin_user_particles INTERFACE drumlin_particles_lab drumlin_particles drumlin_hdf5_files)
add_library(drumlin_user_coupling INTERFACE)
target_link_libraries(drumlin_user_coupling INTERFACE drumlin_coupling drumlin_law drumlin_results drumlin_statistics)
add_library(drumlin_user_continuum INTERFACE)
target_link_libraries(drumlin_user_continuum INTERFACE drumlin_continuum drumlin_continuum_model drumlin_continuum_io)
foreach(name particles coupling continuum)
  set_target_properties(drumlin_user_${name} PROPERTIES EXPORT_NAME ${name})
endforeach()

install(TARGETS drumlin_flags drumlin_includes drumlin_common drumlin_documents drumlin_statistics drumlin_law drumlin_results drumlin_hdf5_files
                drumlin_particles drumlin_particles_lab drumlin_coupling drumlin_continuum_model drumlin_user_particles drumlin_user_coupling
        EXPORT DrumlinTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
set(export_sets Drumlin)
if(DRUMLIN_CONTINUUM)
  list(APPEND export_sets DrumlinContinuum)
  install(TARGETS drumlin_continuum drumlin_continuum_io drumlin_user_continuum
          EXPORT DrumlinContinuumTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
  install(TARGETS drumlin-flow drumlin-run RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()
# The component `commands` is what a Python wheel holds (setup.py).
install(TARGETS drumlin RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT commands)

# As in the sources: #include "particles/stepping/simulation.hpp". Headers in `detail` are private to their room. Discs on ranks are a program only.
install(DIRECTORY coupling particles continuum DESTINATION ${DRUMLIN_INSTALLED_INCLUDES}
        FILES_MATCHING PATTERN "*.hpp" PATTERN "*-inl.h" PATTERN detail EXCLUDE PATTERN distributed EXCLUDE)

install(DIRECTORY data/scenes data/rheology data/paper data/cost data/limits data/pair DESTINATION ${DRUMLIN_INSTALLED_DATA} COMPONENT commands)
install(FILES data/problems/drum-300-mu-0.4-flow.h5 DESTINATION ${DRUMLIN_INSTALLED_DATA}/problems COMPONENT commands)
install(DIRECTORY apps/costs apps/figures apps/pages DESTINATION ${DRUMLIN_INSTALLED_PACKAGE} COMPONENT commands PATTERN __pycache__ EXCLUDE)
install(FILES docs/formats/quantities.md DESTINATION ${DRUMLIN_INSTALLED_PACKAGE}/figures COMPONENT commands)
install(FILES data/laws/laws.csv DESTINATION ${DRUMLIN_INSTALLED_PACKAGE}/library COMPONENT commands)
install(FILES README.md CHANGELOG.md CITATION.cff LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR} FILES_MATCHING PATTERN "*.md")  # that help cites

# Made by the program that is installed.
install(CODE [[
  set(program $ENV{DESTDIR}${CMAKE_INSTALL_PREFIX}/bin/drumlin)
  set(zsh_folder site-functions)
  if(CMAKE_INSTALL_PREFIX STREQUAL "/usr")  # of a Debian package: the zsh there does not look into /usr/share/zsh/site-functions
    set(zsh_folder vendor-completions)
  endif()
  foreach(page IN ITEMS "--man|man/man1/drumlin.1" "--completion;bash|bash-completion/completions/drumlin" "--completion;zsh|zsh/${zsh_folder}/_drumlin"
                        "--completion;fish|fish/vendor_completions.d/drumlin.fish")
    string(REPLACE "|" ";" parts "${page}")
    list(POP_BACK parts file)
    set(file $ENV{DESTDIR}${CMAKE_INSTALL_PREFIX}/share/${file})
    get_filename_component(folder ${file} DIRECTORY)
    file(MAKE_DIRECTORY ${folder})
    execute_process(COMMAND ${program} ${parts} OUTPUT_FILE ${file} COMMAND_ERROR_IS_FATAL ANY)
  endforeach()
]] COMPONENT commands)

set(config_folder ${CMAKE_INSTALL_LIBDIR}/cmake/Drumlin)
configure_package_config_file(cmake/DrumlinConfig.cmake.in ${CMAKE_BINARY_DIR}/cmake/DrumlinConfig.cmake
                              INSTALL_DESTINATION ${config_folder} PATH_VARS DRUMLIN_INSTALLED_DATA)
write_basic_package_version_file(${CMAKE_BINARY_DIR}/cmake/DrumlinConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/cmake/DrumlinConfig.cmake ${CMAKE_BINARY_DIR}/cmake/DrumlinConfigVersion.cmake
              cmake/DrumlinDependencies.cmake cmake/DrumlinDealII.cmake DESTINATION ${config_folder})
foreach(set ${export_sets})
  install(EXPORT ${set}Targets NAMESPACE Drumlin:: DESTINATION ${config_folder})
endforeach()
