// Has no code: its target makes the precompiled headers of the tests.
