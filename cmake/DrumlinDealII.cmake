# drumlin::dealii where deal.II has been found. deal.II 9.4 has no usable imported target, and deal_ii_setup_target() appends -std=c++17, -O2 and
# a macro to the target and to everything that links it. The same by hand: system includes, definitions and libraries, nothing else.
# DRUMLIN_DEALII_RELEASE: its release library in a Debug build too, without deal.II's own assertions, which take most of the time of a check.
if(NOT TARGET drumlin::dealii)
  set(uses_debug $<AND:$<CONFIG:Debug>,$<NOT:$<BOOL:${DRUMLIN_DEALII_RELEASE}>>>)
  add_library(drumlin::dealii INTERFACE IMPORTED GLOBAL)
  target_include_directories(drumlin::dealii SYSTEM INTERFACE ${DEAL_II_INCLUDE_DIRS})
  target_compile_definitions(drumlin::dealii INTERFACE ${DEAL_II_USER_DEFINITIONS} OMPI_SKIP_MPICXX=1
                             $<IF:${uses_debug},${DEAL_II_USER_DEFINITIONS_DEBUG},${DEAL_II_USER_DEFINITIONS_RELEASE}>)
  # deal.II's list names every library that it was built with; only those that are called should be loaded by ours.
  target_link_libraries(drumlin::dealii INTERFACE -Wl,--as-needed
                        $<IF:${uses_debug},${DEAL_II_LIBRARIES_DEBUG},${DEAL_II_LIBRARIES_RELEASE}>)
endif()
