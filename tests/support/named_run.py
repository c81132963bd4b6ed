"""A run of a comparison. Its name contains everything that determines it: `pong:skip=4,seed=7` is the same
run on every machine. Settings that it does not name have their defaults."""

import dataclasses


class NamedRun:
    """The base of a dataclass: its first field is the game, the others are numbers with defaults."""

    ALWAYS = ("seed",)  # fields that every name contains

    @property
    def name(self):
        lines = [
            field
            for field in dataclasses.fields(self)[1:]
            if getattr(self, field.name) != field.default or field.name in self.ALWAYS
        ]
        return f"{self.game}:" + ",".join(f"{field.name}={getattr(self, field.name)}" for field in lines)

    @classmethod
    def parse(cls, text):
        """The run of that name. Raises ValueError with a sentence."""
        game, _, settings = text.partition(":")
        kinds = {
            field.name: float if isinstance(field.default, float) else int for field in dataclasses.fields(cls)[1:]
        }
        values = {}
        for word in filter(None, settings.split(",")):
            key, _, value = word.partition("=")
            if key not in kinds:
                raise ValueError(f"'{key}' of the run '{text}' is not one of {', '.join(kinds)}")
            try:
                values[key] = kinds[key](value)
            except ValueError:
                raise ValueError(f"'{value}' is not a value for {key} of the run '{text}'") from None
        return cls(game, **values)
