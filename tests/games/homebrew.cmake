get_property(own_games GLOBAL PROPERTY RACEBEAM_OWN_GAMES)
foreach(name ${own_games})
  add_test(NAME "homebrew: ${name}.asm assembles to the image in the tree"
    COMMAND ${CMAKE_CURRENT_LIST_DIR}/assemble_homebrew.sh ${CMAKE_SOURCE_DIR}/games/homebrew ${name})
  set_tests_properties("homebrew: ${name}.asm assembles to the image in the tree" PROPERTIES
    SKIP_RETURN_CODE 77 TIMEOUT 60)
endforeach()

racebeam_test(homebrew_tests homebrew_test.cpp LIBRARIES racebeam::games)
