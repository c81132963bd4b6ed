/** A client of racebeam, the Atari 2600 for agents. It needs nothing outside {@code java.base}. */
module racebeam {
  exports racebeam;
}
