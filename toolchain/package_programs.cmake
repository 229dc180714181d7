# The host's package: programs with their data, documentation, man page, completion, bill of materials. Programs lie in
# lib/s4tp and find share/s4tp from there, wherever the prefix is (sim_host/processes/own_files.hpp).
set(package_programs s4tp_tool s4tp_ecu_process s4tp_world_process)
foreach(program s4tp_telemetry_process s4tp_view_process)
  if(TARGET ${program})
    list(APPEND package_programs ${program})
  endif()
endforeach()
add_dependencies(s4tp_package ${package_programs})

# Written from what the programs say for --help.
set(manual ${PROJECT_BINARY_DIR}/manual)
file(MAKE_DIRECTORY ${manual})
add_custom_command(OUTPUT ${manual}/s4tp.1 ${manual}/s4tp.bash
  COMMAND ${S4TP_PYTHON} -B ${PROJECT_SOURCE_DIR}/toolchain/manual.py $<TARGET_FILE:s4tp_tool> ${manual}
  DEPENDS ${package_programs} ${PROJECT_SOURCE_DIR}/toolchain/manual.py COMMENT "Writing man page and completion")
add_custom_target(s4tp_manual ALL DEPENDS ${manual}/s4tp.1 ${manual}/s4tp.bash)
add_dependencies(s4tp_package s4tp_manual)
if(NOT S4TP_INSTALL)
  return()
endif()

set(doc ${CMAKE_INSTALL_DATADIR}/doc/s4tp)
install(TARGETS ${package_programs} RUNTIME DESTINATION lib/s4tp)
file(CREATE_LINK ../lib/s4tp/s4tp_tool ${manual}/s4tp SYMBOLIC)
install(FILES ${manual}/s4tp DESTINATION ${CMAKE_INSTALL_BINDIR})
install(DIRECTORY sim_host/scenarios DESTINATION ${CMAKE_INSTALL_DATADIR}/s4tp)
install(FILES toolchain/budget.json firmware/wire/s4tp.dbc DESTINATION ${CMAKE_INSTALL_DATADIR}/s4tp)
install(PROGRAMS toolchain/vcan_machine.sh DESTINATION ${CMAKE_INSTALL_DATADIR}/s4tp)
install(FILES ${manual}/s4tp.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
install(FILES ${manual}/s4tp.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME s4tp)
install(FILES README.md CHANGELOG.md CONTRIBUTING.md DESTINATION ${doc})
install(DIRECTORY docs DESTINATION ${doc})
# What they are made of (SPDX), asked when ninja is done: it knows every header that was read.
set(program_files ${package_programs})
list(TRANSFORM program_files REPLACE "(.+)" "$<PATH:RELATIVE_PATH,$<TARGET_FILE:\\1>,${PROJECT_BINARY_DIR}>")
list(JOIN program_files " " program_files)
install(CODE "execute_process(COMMAND ${S4TP_PYTHON} -B ${PROJECT_SOURCE_DIR}/toolchain/bill_of_materials.py ${PROJECT_BINARY_DIR}
  ${PROJECT_VERSION} \$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${doc}/s4tp.spdx.json ${program_files} RESULT_VARIABLE code)
if(code)
  message(WARNING \"no bill of materials: it wants Debian's dpkg and a build by ninja\")
endif()")

# cpack makes the Debian package; what its programs load it depends on.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME s4tp)
set(CPACK_PACKAGE_CONTACT "s4tp developers <s4tp@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "Planner firmware for cars: library, headers and a virtual world to drive it in")
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS sumo)
set(CPACK_STRIP_FILES ON)
include(CPack)
