# The library as a package: targets s4tp::core, s4tp::wire, s4tp::gate, s4tp::ecu, s4tp::secoc and s4tp::hal (interfaces
# only), the same names with find_package(s4tp) and with add_subdirectory().
set(package_rooms core hal wire gate ecu secoc)
set(package_targets ${package_rooms})
list(TRANSFORM package_targets PREPEND s4tp_)
foreach(room target IN ZIP_LISTS package_rooms package_targets)
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${room})
  add_library(s4tp::${room} ALIAS ${target})
endforeach()
add_custom_target(s4tp_package DEPENDS ${package_targets})  # all that an installation needs

option(S4TP_INSTALL "Install the library" ${PROJECT_IS_TOP_LEVEL})
if(NOT S4TP_INSTALL)
  return()
endif()
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(package_headers ${CMAKE_INSTALL_INCLUDEDIR}/s4tp)
set(package_config ${CMAKE_INSTALL_LIBDIR}/cmake/s4tp)

install(TARGETS ${package_targets} EXPORT s4tp
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} INCLUDES DESTINATION ${package_headers})
install(EXPORT s4tp NAMESPACE s4tp:: FILE s4tp-targets.cmake DESTINATION ${package_config})

set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS algo/api/headers.txt)
file(STRINGS algo/api/headers.txt core_headers REGEX "^ *algo/")
foreach(header ${core_headers})
  string(STRIP ${header} header)
  cmake_path(GET header PARENT_PATH folder)
  install(FILES ${header} DESTINATION ${package_headers}/${folder})
endforeach()
install(FILES algo/api/s4tp.h DESTINATION ${package_headers})
foreach(room wire gate ecu secoc)
  install(DIRECTORY firmware/${room} DESTINATION ${package_headers}/firmware FILES_MATCHING PATTERN *.hpp PATTERN *.dbc)
endforeach()
install(FILES ${PROJECT_BINARY_DIR}/generated/firmware/wire/generated/s4tp_codec.hpp
  DESTINATION ${package_headers}/firmware/wire/generated)
file(GLOB hal_interfaces CONFIGURE_DEPENDS hal/*.hpp)
install(FILES ${hal_interfaces} DESTINATION ${package_headers}/hal)

configure_package_config_file(toolchain/s4tp-config.cmake.in ${PROJECT_BINARY_DIR}/s4tp-config.cmake
  INSTALL_DESTINATION ${package_config} NO_SET_AND_CHECK_MACRO)
# The file also refuses a consumer whose pointers are of another size: a host's package is no target's.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/s4tp-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/s4tp-config.cmake ${PROJECT_BINARY_DIR}/s4tp-config-version.cmake
  DESTINATION ${package_config})
file(RELATIVE_PATH S4TP_PC_TO_PREFIX /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
configure_file(toolchain/s4tp.pc.in ${PROJECT_BINARY_DIR}/s4tp.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/s4tp.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/s4tp RENAME copyright)
