"""The names of envpool.atari.registration."""

from racebeam import ale_games

__all__ = ["atari_game_list"]

atari_game_list = sorted(set(ale_games.ALL) - ale_games.TWO_PLAYER)
