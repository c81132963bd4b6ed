// Translated code calls functions, and is called, by the System V convention on every system. On Windows, the
// compiler's own convention is another one.
#pragma once

#if defined(_WIN32)
#define RACEBEAM_SYSV_ABI __attribute__((sysv_abi))
#else
#define RACEBEAM_SYSV_ABI
#endif
