// toml++, which reads our files. Some assertions of its version 3.3 don't hold for texts that it refuses right after them,
// such as "[[.": without this, they would end a build that has assertions, and a compiler may take for granted what the
// others say.
#pragma once

#pragma push_macro("NDEBUG")
#undef NDEBUG
#define TOML_ASSERT(expression) static_assert(true)
#include <toml++/toml.h>
#pragma pop_macro("NDEBUG")
