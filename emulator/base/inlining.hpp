// RACEBEAM_INLINE is for functions that are separate in the source, and must be one in the machine code. The
// preset `fuzz` disables it: with instrumentation, compiling the combined function takes an hour.
#pragma once

#ifndef RACEBEAM_INLINE
#define RACEBEAM_INLINE [[gnu::always_inline]] inline
#endif
