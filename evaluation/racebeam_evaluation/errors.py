"""What a run refuses."""


class BadInput(Exception):
    """Input that cannot be evaluated. The message is one sentence: what is wrong, the value, and what is accepted."""
