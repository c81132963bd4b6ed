// Shared by all public headers: the versioned namespace, and the export macro of the library. It has only
// macros, so that threads do not matter. Programs use the classes as racebeam::Environment:
//
//     racebeam::Environment environment(racebeam::Image::load("builtin:beamfall"));
//     racebeam::v0::Environment& same = environment;  // what the linker sees
//     same.step(racebeam::Action::kFire);
//
// The number in the namespace changes with the interface. A program that was compiled for one interface does
// not link a library of another.
#pragma once

// The sources of the library also use internal classes of the same names. There, the public ones are v0::.
#ifdef RACEBEAM_LIBRARY_SOURCE
#define RACEBEAM_NAMESPACE racebeam::v0
#else
#define RACEBEAM_NAMESPACE racebeam::inline v0
#endif

// All other symbols of the shared library are hidden.
#ifdef __GNUC__
#define RACEBEAM_API __attribute__((visibility("default")))
#else
#define RACEBEAM_API
#endif
