"""The names of the compiled module of ale_py."""

from racebeam._core import Action, ALEState, LoggerMode
from racebeam.ale_py.interface import ALEInterface
from racebeam.ale_py.vectors import ALEVectorInterface

SDL_SUPPORT = False
__all__ = ["ALEInterface", "ALEState", "ALEVectorInterface", "Action", "LoggerMode", "SDL_SUPPORT"]

globals().update({action.name: action for action in Action})
globals().update({mode.name: mode for mode in LoggerMode})
