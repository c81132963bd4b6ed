// For functions that are written apart to be read, and must be one when they run. Not where everything is instrumented:
// the preset `fuzz` says so, since such a function would have so many parts that compiling it takes an hour.
#pragma once

#ifndef RACEBEAM_INLINE
#define RACEBEAM_INLINE [[gnu::always_inline]] inline
#endif
