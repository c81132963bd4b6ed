/// @file
/// The client of the racebeam line protocol: racebeam::client::connect() and
/// racebeam::client::async_connect().
#pragma once

#include "racebeam/client/async_session.hpp"
#include "racebeam/client/session.hpp"
