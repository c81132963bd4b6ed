"""The parts of AtariEnv: arguments, the game, actions, and what is shown."""
