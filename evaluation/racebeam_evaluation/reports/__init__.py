"""The kinds of reports, each of which racebeam-evaluate makes for --report or --paper."""
