/// @file
/// What all headers of the client share: the namespace with its version, and the mark of what a library
/// exports. It has only macros, so that threads do not matter. Programs use the classes as
/// racebeam::client::Session.
#pragma once

/// The number changes with the interface of the client. Libraries that were compiled with different clients
/// then work in one program.
#define RACEBEAM_CLIENT_NAMESPACE racebeam::client::inline v0

/// Exceptions pass from a library that hides its symbols to its program.
#ifdef __GNUC__
#define RACEBEAM_CLIENT_API __attribute__((visibility("default")))
#else
#define RACEBEAM_CLIENT_API
#endif
