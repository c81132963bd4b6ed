"""The parts of AtariVectorEnv: machines, results, calls, and the making of them."""
