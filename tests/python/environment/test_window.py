"""The window of render_mode "human"."""

import os
import subprocess
import sys

import package
import pytest

package.require("gymnasium", "numpy")

os.environ.setdefault("SDL_AUDIODRIVER", "dummy")
if "DISPLAY" not in os.environ:
    os.environ.setdefault("SDL_VIDEODRIVER", "dummy")


@pytest.mark.needs_modules("pygame")
class TestWindow:
    """Windows of SDL's driver that shows nothing. To see them on a display, set SDL_VIDEODRIVER."""

    def check(self, script, *words, **variables):
        """What a script says at last."""
        done = subprocess.run(
            [sys.executable, "-c", script], capture_output=True, text=True, env={**os.environ, **variables}
        )
        assert (done.returncode, done.stdout.split()[-len(words) :]) == (0, [*words]), done.stderr

    def test_a_person_sees_each_frame(self):
        script = (
            "import racebeam, time\n"
            "env = racebeam.AtariEnv('beamfall', render_mode='human')\n"
            "quiet = racebeam.AtariEnv('beamfall')\n"
            "assert (env.reset(seed=1)[0] == quiet.reset(seed=1)[0]).all() and env.render() is None\n"
            "begin = time.monotonic()\n"
            "for action in range(15):\n"
            "    a, b = env.step(action), quiet.step(action)\n"
            "    assert (a[0] == b[0]).all() and a[1:] == b[1:], (a[1:], b[1:])\n"
            "took = time.monotonic() - begin\n"
            "import pygame\n"
            "picture = pygame.surfarray.array3d(pygame.display.get_surface())[::4, ::2].swapaxes(0, 1)\n"
            "assert (picture == a[0]).all()\n"
            "env.close()\n"
            "print(0.8 < took)"
        )
        self.check(script, "True")

    def test_games_share_the_window_until_each_is_closed(self):
        self.check(
            "import copy, pygame, racebeam\n"
            "def window(): return pygame.surfarray.array3d(pygame.display.get_surface())[::4, ::2].swapaxes(0, 1)\n"
            "games = [racebeam.AtariEnv(game, render_mode='human', sound=True) for game in ('beamfall', 'updraft')]\n"
            "games.append(copy.deepcopy(games[0]))\n"
            "for _ in range(2):\n"
            "    for game in games:\n"
            "        assert (game.reset(seed=1)[0] == window()).all()\n"
            "        print(pygame.display.get_caption()[0])\n"
            "for game in games[:2]:\n"
            "    game.close()\n"
            "assert (games[2].step(1)[0] == window()).all()\n"
            "games[2].close()\n"
            "assert not pygame.display.get_init() and not pygame.mixer.get_init()\n"
            "games = [racebeam.AtariEnv('beamfall', render_mode='human') for _ in range(2)]\n"
            "pygame.quit()  # as another's environment does\n"
            "games[0].reset(); del games[0], game; games[0].close()\n"
            "assert not pygame.display.get_init()\n",
            *("Beamfall", "Updraft", "Beamfall") * 2,
        )

    def test_the_close_button_closes_the_window_and_the_games_go_on(self):
        self.check(
            "import pygame, racebeam, time\n"
            "games = [racebeam.AtariEnv('beamfall', render_mode='human', sound=True) for _ in range(2)]\n"
            "for game in games: game.reset(seed=1)\n"
            "pygame.event.post(pygame.event.Event(pygame.QUIT))\n"
            "games[0].step(1)\n"
            "assert not pygame.display.get_init() and not pygame.mixer.get_init()\n"
            "begin = time.monotonic()\n"
            "for _ in range(300): games[0].step(1), games[1].step(1)\n"
            "print(time.monotonic() - begin < 5, pygame.display.get_init())\n"
            "later = racebeam.AtariEnv('beamfall', render_mode='human')\n"
            "later.reset(), games[0].close(), later.step(0)\n"
            "print(pygame.display.get_init())\n"
            "later.close()\n"
            "print(pygame.display.get_init())\n",
            *("True", "False", "True", "False"),
        )

    def test_keys_change_the_speed_and_pause(self):
        self.check(
            "import pygame, racebeam, threading, time\n"
            "def press(key): pygame.event.post(pygame.event.Event(pygame.KEYDOWN, unicode=key))\n"
            "def seconds(game, frames):\n"
            "    begin = time.monotonic()\n"
            "    for _ in range(frames): game.step(0)\n"
            "    return time.monotonic() - begin\n"
            "game = racebeam.AtariEnv('beamfall', render_mode='human', frameskip=1)\n"
            "game.reset(seed=1)\n"
            "for _ in range(3): press('-'); game.step(0)\n"
            "print(seconds(game, 4) > 0.4)  # 7.5 frames a second\n"
            "for _ in range(3): press('+'); game.step(0)\n"
            "press('x')\n"
            "print(seconds(game, 30) > 0.4)\n"
            "press('=')\n"
            "game.step(0)\n"
            "print(game._window._speed.factor)\n"
            "press('p')\n"
            "threading.Timer(0.6, press, 'p').start()\n"
            "print(seconds(game, 1) > 0.5)\n"
            "press('p')\n"
            "threading.Timer(0.3, pygame.event.post, [pygame.event.Event(pygame.QUIT)]).start()\n"
            "game.step(0), game.close()\n",
            *("True", "True", "2.0", "True"),
        )

    def test_a_person_sees_the_environments_of_a_vector(self):
        self.check(
            "import numpy as np, pygame, racebeam, time\n"
            "def window(): return pygame.surfarray.array3d(pygame.display.get_surface())[::4, ::2].swapaxes(0, 1)\n"
            "envs = racebeam.AtariVectorEnv('beamfall', 3, seed=1, obs_type='rgb', stack_num=1, maxpool=False,\n"
            "    render_mode='human')\n"
            "envs.reset()\n"
            "begin = time.monotonic()\n"
            "for step in range(6):\n"
            "    screens = envs.step([step, 1, 0])[0][:, 0]\n"
            "took = time.monotonic() - begin\n"
            "empty = np.zeros_like(screens[0])\n"
            "assert (window() == np.block([[[screens[0]], [screens[1]]], [[screens[2]], [empty]]])).all()\n"
            "print(pygame.display.get_caption()[0], 0.25 < took, envs.render())\n"
            "envs.close()\n"
            "print(pygame.display.get_init())\n",
            *("Beamfall", "True", "None", "False"),
        )

    def test_the_first_sixteen_of_many_environments_are_shown(self):
        self.check(
            "import pygame, racebeam\n"
            "envs = racebeam.AtariVectorEnv('beamfall', 20, batch_size=5, render_mode='human', frameskip=60)\n"
            "envs.reset()\n"
            "pygame.event.post(pygame.event.Event(pygame.QUIT))\n"
            "print(pygame.display.get_surface().get_size())\n"
            "for _ in range(10): envs.step([0] * 5)\n"
            "print(pygame.display.get_init())\n",
            *("(1280,", "840)", "False"),
        )

    def test_a_window_that_nobody_sees_is_warned_of(self):
        self.check(
            "import os, warnings\n"
            "for name in ('SDL_VIDEODRIVER', 'DISPLAY', 'WAYLAND_DISPLAY'): os.environ.pop(name, None)\n"
            "import racebeam\n"
            "warnings.simplefilter('error')\n"
            "try: racebeam.AtariEnv('beamfall', render_mode='human')\n"
            "except (UserWarning, racebeam.InvalidInput) as found: print('a display' in str(found))",
            "True",
        )

    def test_without_a_display_a_sentence_says_so(self):
        self.check(
            "import racebeam\n"
            "try: racebeam.AtariEnv('beamfall', render_mode='human')\n"
            "except racebeam.InvalidInput as error: print('needs a display' in str(error))",
            "True",
            SDL_VIDEODRIVER="x11",
            DISPLAY="",
        )
