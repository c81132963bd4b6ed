"""The names of envpool.python."""
