# dasm assembles the functional program for the CPU; scripts/setup installs it.
find_program(DASM dasm REQUIRED)
set(functional_program ${CMAKE_CURRENT_BINARY_DIR}/emulator/functional.bin)
add_custom_command(OUTPUT ${functional_program}
  COMMAND ${DASM} ${CMAKE_CURRENT_SOURCE_DIR}/emulator/cpu/functional.asm -f3 -o${functional_program}
  DEPENDS emulator/cpu/functional.asm VERBATIM)
add_custom_target(functional_program DEPENDS ${functional_program})  # for tests in other folders
