# What the program needs around it: man pages, completions, and on Linux units of systemd and their settings.
find_package(Python3 REQUIRED COMPONENTS Interpreter)
set(texts ${CMAKE_CURRENT_BINARY_DIR}/texts)
add_custom_command(
  OUTPUT ${texts}/racebeam.1
  COMMAND Python3::Interpreter -B ${CMAKE_CURRENT_SOURCE_DIR}/program_text.py ${texts}
    ${CMAKE_CROSSCOMPILING_EMULATOR} $<TARGET_FILE:racebeam>
  DEPENDS racebeam ${CMAKE_CURRENT_SOURCE_DIR}/program_text.py
  COMMENT "Writing man pages and completions"
  VERBATIM)
add_custom_target(program_texts ALL DEPENDS ${texts}/racebeam.1)

install(DIRECTORY ${texts}/ DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT program FILES_MATCHING PATTERN "*.1")
install(FILES ${CMAKE_SOURCE_DIR}/protocol/racebeam-protocol.7 DESTINATION ${CMAKE_INSTALL_MANDIR}/man7 COMPONENT program)
install(FILES ${texts}/racebeam.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME racebeam
  COMPONENT program)
install(FILES ${texts}/_racebeam DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions COMPONENT program)
install(FILES ${texts}/racebeam.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d
  COMPONENT program)
install(FILES ${CMAKE_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} RENAME copyright COMPONENT program)

# Only a package of the system has these; they name places outside of the tree.
set(CMAKE_INSTALL_FULL_BINDIR /usr/bin)
configure_file(systemd/racebeam.service.in racebeam.service @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/racebeam.service ${CMAKE_CURRENT_SOURCE_DIR}/systemd/racebeam.socket
  DESTINATION /lib/systemd/system COMPONENT system EXCLUDE_FROM_ALL)
install(FILES racebeam.toml DESTINATION /etc COMPONENT system EXCLUDE_FROM_ALL)

# cpack -G DEB: racebeam-VERSION.deb, program and system. cpack -G TGZ: a tree that can be moved, program and development.
set(CPACK_PACKAGE_NAME racebeam)
set(CPACK_PACKAGE_VENDOR racebeam)
set(CPACK_PACKAGE_CONTACT "racebeam <racebeam@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "Atari 2600 games as a server for agents")
set(CPACK_PACKAGE_DESCRIPTION "An emulator of the Atari 2600 without a display. Agents in any language play its games
over pipes and sockets. Two games are built in; no other cartridge image is part of the package.")
set(CPACK_RESOURCE_FILE_LICENSE ${CMAKE_SOURCE_DIR}/LICENSE)
set(CPACK_STRIP_FILES ON)
set(CPACK_VERBATIM_VARIABLES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_PACKAGE_SECTION games)
set(CPACK_DEBIAN_PACKAGE_DEPENDS adduser)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_EXTRA
  ${CMAKE_CURRENT_SOURCE_DIR}/debian/conffiles
  ${CMAKE_CURRENT_SOURCE_DIR}/debian/postinst
  ${CMAKE_CURRENT_SOURCE_DIR}/debian/prerm
  ${CMAKE_CURRENT_SOURCE_DIR}/debian/postrm)
set(CPACK_PROJECT_CONFIG_FILE ${CMAKE_CURRENT_SOURCE_DIR}/generators.cmake)
include(CPack)
