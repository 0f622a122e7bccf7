# drumlin::dealii where deal.II has been found. deal.II 9.4 has no usable imported target, and deal_ii_setup_target() appends -std=c++17, -O2 and
# a macro to the target and to everything that links it. The same by hand: system includes, definitions and libraries, nothing else. From 9.5 on
# there is a target for each build of the library, without the flags that dealii::dealii adds.
# DRUMLIN_DEALII_RELEASE: its release library in a Debug build too, without deal.II's own assertions, which take most of the time of a check.
if(NOT TARGET drumlin::dealii)
  set(uses_debug $<AND:$<CONFIG:Debug>,$<NOT:$<BOOL:${DRUMLIN_DEALII_RELEASE}>>>)
  add_library(drumlin::dealii INTERFACE IMPORTED GLOBAL)
  target_compile_definitions(drumlin::dealii INTERFACE OMPI_SKIP_MPICXX=1)
  if(TARGET dealii::dealii_release)
    set(dealii_libraries $<IF:${uses_debug},dealii::dealii_debug,dealii::dealii_release>)
  else()
    target_include_directories(drumlin::dealii SYSTEM INTERFACE ${DEAL_II_INCLUDE_DIRS})
    target_compile_definitions(drumlin::dealii INTERFACE ${DEAL_II_USER_DEFINITIONS}
                               $<IF:${uses_debug},${DEAL_II_USER_DEFINITIONS_DEBUG},${DEAL_II_USER_DEFINITIONS_RELEASE}>)
    set(dealii_libraries $<IF:${uses_debug},${DEAL_II_LIBRARIES_DEBUG},${DEAL_II_LIBRARIES_RELEASE}>)
  endif()
  # GNU's usual linker reads the symbols of all that these libraries are linked with, 300 of them: 40 s of a processor for each program. Gold,
  # which is of the same package in Debian 12, takes 2.
  include(CheckLinkerFlag)
  check_linker_flag(CXX -fuse-ld=gold DRUMLIN_HAS_GOLD)
  # deal.II's list names every library that it was built with; only those that are called should be loaded by ours.
  target_link_libraries(drumlin::dealii INTERFACE $<$<BOOL:${DRUMLIN_HAS_GOLD}>:-fuse-ld=gold> -Wl,--as-needed ${dealii_libraries})
endif()
