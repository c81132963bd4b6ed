"""The parts of AtariVectorEnv: machines and how they are made, calls, and results."""
