"""Tables, tests and figures from the results of `racebeam experiment` (docs/evaluation.md)."""
