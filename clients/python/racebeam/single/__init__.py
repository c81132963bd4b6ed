"""The parts of AtariEnv: arguments, the game, actions, what is shown, and the window."""
