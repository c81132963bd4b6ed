// For functions that are written apart to be read, and must be one when they run.
#pragma once

#define RACEBEAM_INLINE [[gnu::always_inline]] inline
