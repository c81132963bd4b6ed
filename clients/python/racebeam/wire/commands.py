"""The commands of the line protocol."""

from __future__ import annotations

import base64
import os
from collections.abc import Iterable

from .encodings import decode_rewards
from .exchange import Exchange
from .messages import Values, format_word, key_values, optional_words, parse_number


class Commands(Exchange):
    """A method for each command. The commands whose request or reply needs more than its words come first.

    The other methods follow in the order of the document. Each returns what `Exchange.request` returns, unless its
    docstring says otherwise.
    """

    def help(self, *words: str) -> str:
        """Explain.

        Args:
            *words: A command, a setting or a chapter. Default: all commands.

        Returns:
            The text of the reply.
        """
        return self._exchange(lambda: self._read_status(self._read_line())[1], "help", *words)

    def game(self, name: str) -> Values:
        """Describe one game.

        Args:
            name: Name of the game.

        Returns:
            A dictionary with what `games NAME` replies, such as its modes and the MD5 of its image.
        """
        return self._first("games", name)

    def load(self, game: str, image: bytes | None = None, **settings: object) -> Values:
        """Power on and begin an episode.

        Args:
            game: Name of the game, MD5 of its image, or "inline".
            image: The bytes of a cartridge, if `game` is "inline".
            **settings: Settings of the protocol. `as_` is its setting `as`, the game whose rules apply.

        Returns:
            A dictionary with what `load` replies, such as the MD5 of the image and the size of the screen.
        """
        rules = settings.pop("as_", None)
        data = None if image is None else base64.b64encode(image).decode()
        return self._first("load", game, *key_values(image=data, **{"as": rules}, **settings))

    def two_player_modes(self) -> list[int]:
        """List the modes of the game for two players.

        Returns:
            The numbers of the modes.
        """
        return self._ints_of("two_player_modes", "modes")

    def actions(self) -> dict[int, str]:
        """List the actions that act accepts.

        Returns:
            The names of the actions by their numbers.
        """
        pairs = (pair.split(":") for pair in self._list_of("actions", "actions"))
        return {int(action): name for action, name in pairs}

    def names(self) -> tuple[dict[int, str], list[str]]:
        """List the names of bytes of the fields ram and tia.

        Returns:
            The names of bytes of `ram` by their indices, and the names of the bytes of `tia` in order.
        """
        found = self.ask("names")[0]
        pairs = (pair.split(":") for pair in found["ram_names"].split(",") if pair)
        return {int(index): name for index, name in pairs}, found["tia_names"].split(",")

    def palette(self) -> list[tuple[int, int, int]]:
        """List the colours of the field screen.

        Returns:
            Red, green and blue, 0 to 255, of each value of a pixel.
        """
        data = bytes.fromhex(self.ask("look", "palette:hex")[0]["palette"])
        return [(data[at], data[at + 1], data[at + 2]) for at in range(0, len(data), 3)]

    def peek(self, index: int, count: int = 1) -> bytes:
        """Read bytes of RAM.

        Args:
            index: Index of the first byte, 0 to 127.
            count: Number of bytes.

        Returns:
            The bytes.
        """
        return bytes.fromhex(self.ask("peek", index, count)[0]["bytes"])

    def poke(self, index: int, data: bytes | Iterable[int]) -> None:
        """Write bytes of RAM.

        Args:
            index: Index of the first byte, 0 to 127.
            data: The bytes, or numbers from 0 to 255.

        Raises:
            TypeError: If `data` is something else.
        """
        try:
            written = bytes(list(data))
        except (TypeError, ValueError):
            raise TypeError(f"data is {data!r}; it takes bytes, or numbers from 0 to 255") from None
        self.ask("poke", index, written.hex().upper())

    def export_state(self, name: str, episode: bool | int = False, whole: bool | int = False) -> bytes:
        """Return a state, for later or for another process.

        Args:
            name: Name of the state.
            episode: Whether the score, the progress of the episode and the stack of screens are included.
            whole: Old name of `episode`.

        Returns:
            The state as bytes, which `import_state` takes.
        """
        return base64.b64decode(self.ask("export", name, *key_values(episode=episode or whole or None))[0]["data"])

    def import_state(self, name: str, data: bytes) -> None:
        """Save an exported state.

        Args:
            name: Name of the state.
            data: What `export_state` returned.
        """
        self.ask("import", name, base64.b64encode(data).decode())

    def branch(self, name: str, *sequences: Iterable[object], keep: str | None = None) -> list[Values]:
        """Play lists of actions from a state; the session itself does not change.

        Args:
            name: Name of the state.
            *sequences: Lists of actions.
            keep: Prefix of the names under which the last states are saved: PREFIX0, PREFIX1 and so on.

        Returns:
            The values of each list. `rewards`, and `rewards_b` with two players, are lists of a reward for each act.
        """
        words = [*key_values(keep=keep), *(",".join(map(format_word, actions)) for actions in sequences)]
        return [
            {
                key: decode_rewards(text) if key.startswith("rewards") else parse_number(text)
                for key, text in texts.items()
            }
            for texts in self.ask("branch", name, *words)[1:]
        ]

    def close(self) -> None:
        """Close the machines, as `close_machines` does. The session continues."""
        self.close_machines()

    def save_png(self, path: str | os.PathLike[str], machine: int | None = None) -> None:
        """Save a picture of the screen as a PNG file.

        Args:
            path: Path of the file, on this computer.
            machine: The index of a machine of open, from 0. Default: the machine of load.
        """
        data = base64.b64decode(self.ask("shot", *key_values(machine=machine))[0]["data"])
        with open(path, "wb") as file:
            file.write(data)

    def stop_recording(self) -> Values:
        """End the recording.

        Returns:
            A dictionary with what `record stop` replies: the files, and the frames that they have.
        """
        return self._first("record", "stop")

    # generated: commands, from protocol/protocol.toml

    def hello(self, token: str | None = None) -> Values:
        """Greet the server; the reply has its name, version and limits.

        Args:
            token: A token that the server accepts.

        Returns:
            A dictionary with `server`, `protocol`, `max_line`, `max_machines`, `max_states`, `max_request_frames`,
            `max_reply`, `max_idle`, `threads`, `recording`, `admitted`, `encodings` and `presets`.
        """
        return self._first("hello", *key_values(token=token))

    def games(self, which: str | None = None) -> list[str]:
        """List the games whose image is here, or all known games; or describe one.

        Args:
            which: All for all known games, or the name of a game to describe.

        Returns:
            The list `games` of the reply, as texts.
        """
        return self._list_of("games", "games", *optional_words(which))

    def settings(self) -> Values:
        """Show the settings in effect.

        Returns:
            A dictionary with `game`, `md5`, `rule`, `width`, `height` and `format`, and `image` where it applies, and
            each setting.
        """
        return self._first("settings")

    def set(self, mode: int | None = None, difficulty: int | None = None) -> Values:
        """Change the mode, from the next reset on, or the difficulty, at once.

        Args:
            mode: A number that modes lists.
            difficulty: A number that difficulties lists.

        Returns:
            A dictionary with `mode` and `difficulty`.
        """
        return self._first("set", *key_values(mode=mode, difficulty=difficulty))

    def modes(self) -> list[int]:
        """List the game's modes.

        Returns:
            The list `modes` of the reply, as numbers.
        """
        return self._ints_of("modes", "modes")

    def difficulties(self) -> list[int]:
        """List the game's difficulties.

        Returns:
            The list `difficulties` of the reply, as numbers.
        """
        return self._ints_of("difficulties", "difficulties")

    def observe(self, *fields: str) -> list[str]:
        """Select the fields of replies.

        Args:
            *fields: The fields, such as lives or screen:rle, or none; without them, the selection does not change.

        Returns:
            The list `fields` of the reply, as texts.
        """
        return self._list_of("fields", "observe", *fields)

    def look(self, *fields: str) -> Values:
        """Show these fields once; without fields, the selected ones.

        Args:
            *fields: The fields, such as lives or screen:rle.

        Returns:
            A dictionary with these fields, and `over` where it applies.
        """
        return self._first("look", *fields)

    def act(self, *actions: object) -> Values:
        """Play actions until the episode ends.

        Args:
            *actions: Names or numbers of actions, also with marks, such as RIGHT*10.

        Returns:
            A dictionary with the selected fields, and `recording_ended`, `log_ended` and `over` where they apply.
        """
        return self._first("act", *actions)

    def reset(self, seed: int | str | None = None) -> Values:
        """Begin an episode; with a seed, power on anew with it.

        Args:
            seed: The seed with which the console is powered on anew, or random.

        Returns:
            A dictionary with the selected fields.
        """
        return self._first("reset", *key_values(seed=seed))

    def save(
        self,
        name: str,
        generator: bool | int | None = None,
        machine: int | None = None,
        random: bool | int | None = None,
    ) -> None:
        """Save the state; generator=1: with the random generator.

        Args:
            name: A name for the state.
            generator: 1: the state includes the random generator.
            machine: The index of a machine of open, from 0.
            random: Old name of `generator`.
        """
        self.ask("save", name, *key_values(generator=generator, machine=machine, random=random))

    def restore(self, name: str, machine: int | None = None) -> Values:
        """Restore a saved state.

        Args:
            name: The name of the state.
            machine: The index of a machine of open, from 0.

        Returns:
            A dictionary with the selected fields, and `over` where it applies.
        """
        return self._first("restore", name, *key_values(machine=machine))

    def drop(self, *names: str) -> None:
        """Delete states.

        Args:
            *names: The names of the states, or all.
        """
        self.ask("drop", *names)

    def states(self) -> list[str]:
        """List the names of the states.

        Returns:
            The list `states` of the reply, as texts.
        """
        return self._list_of("states", "states")

    def open(
        self,
        count: int,
        autoreset: str | None = None,
        steps: str | None = None,
        start: str | None = None,
        life_loss: str | None = None,
        stack: str | None = None,
        pool: bool | int | None = None,
        lives: str | None = None,
    ) -> list[Values]:
        """Create N machines with the loaded game and settings; their seeds count up.

        Args:
            count: The number of machines.
            autoreset: What happens at the end of an episode.
            steps: What a step is.
            start: How an episode begins; requires steps=frames.
            life_loss: What a lost life does.
            stack: What a stack of screens begins with; requires steps=frames.
            pool: Which frames a stack shows; requires steps=frames.
            lives: Old name of `life_loss`.

        Returns:
            A dictionary for each machine, with the selected fields.
        """
        return self._rest(
            "open",
            count,
            *key_values(
                autoreset=autoreset, steps=steps, start=start, life_loss=life_loss, stack=stack, pool=pool, lives=lives
            ),
        )

    def step(self, *actions: object) -> list[Values]:
        """Play one act on each machine: an action each, or one for all.

        Args:
            *actions: An action for each machine, or one for all.

        Returns:
            A dictionary for each machine, with the selected fields, and `over` where it applies.
        """
        return self._rest("step", *actions)

    def restart(self, mask: str | None = None, seed: int | str | None = None) -> list[Values]:
        """Reset the machines that have a 1 in MASK, such as 0110, or all; seeds count up.

        Args:
            mask: A 0 or a 1 for each machine, such as 0110.
            seed: The seed with which machine 0 is powered on anew; machine 1 gets the next one, and so on.

        Returns:
            A dictionary for each machine, with the selected fields, and `over` where it applies.
        """
        return self._rest("restart", *optional_words(mask), *key_values(seed=seed))

    def close_machines(self) -> None:
        """Close the machines."""
        self.ask("close")

    def record(self, kinds: str, name: str, machine: int | None = None) -> Values:
        """Record frames, sound or both into the server's folder.

        Args:
            kinds: The kinds of files, separated by commas, such as gif,wav.
            name: A name for the files, without an extension.
            machine: The index of a machine of open, from 0.

        Returns:
            A dictionary with `recording`, `recorded`, `frames`, `bytes`, `complete` and `recording_ended` where they
            apply.
        """
        return self._first("record", kinds, name, *key_values(machine=machine))

    def log(
        self,
        name: str,
        agent: str | None = None,
        version: str | None = None,
        agent_seed: int | None = None,
        trial: int | None = None,
        training_frames: int | None = None,
        phrase: str | None = None,
        role: str | None = None,
        link: str | None = None,
        machine: int | None = None,
    ) -> Values:
        """Log the episodes from the next reset on, so that anybody can verify them.

        Args:
            name: A name for the submission, or inline; last answers with the last log, and stop ends logging.
            agent: The agent's name (default: agent).
            version: The agent's version (default: 1).
            agent_seed: The agent's seed (default: 0).
            trial: The number of the trial (default: 1).
            training_frames: Frames that the agent was trained on (default: 0).
            phrase: The phrase that the episodes' seeds follow from, with _ for a blank.
            role: What the agent is.
            link: A page about the agent.
            machine: The index of a machine of open, from 0.

        Returns:
            A dictionary with `log`, `unit`, `logged`, `unlogged`, `complete`, `log_ended`, `episode`, `row`, `bytes`
            and `data` where they apply.
        """
        return self._first(
            "log",
            name,
            *key_values(
                agent=agent,
                version=version,
                agent_seed=agent_seed,
                trial=trial,
                training_frames=training_frames,
                phrase=phrase,
                role=role,
                link=link,
                machine=machine,
            ),
        )

    def shot(self, name: str | None = None, machine: int | None = None) -> Values:
        """Write the screen as NAME.png into the server's folder; without NAME or folder, answer with it as base64.

        Args:
            name: A name for the file, without .png.
            machine: The index of a machine of open, from 0.

        Returns:
            A dictionary with `width`, `height` and `bytes`, and `picture` and `data` where they apply.
        """
        return self._first("shot", *optional_words(name), *key_values(machine=machine))

    def share(self, name: str, watchers: int | None = None) -> Values:
        """Let other sessions watch the game under this name.

        Args:
            name: A name for the shared session.
            watchers: The most sessions that may watch at the same time.

        Returns:
            A dictionary with `share` and `watchers`.
        """
        return self._first("share", name, *key_values(watchers=watchers))

    def unshare(self) -> None:
        """Stop sharing the game."""
        self.ask("unshare")

    def shared(self) -> list[Values]:
        """List the shared sessions.

        Returns:
            A dictionary for each session, with `name`, `game`, `frame`, `score`, `episode` and `fps`.
        """
        return self._rest("shared")

    def watch(self, name: str, *fields: str, since: int | None = None) -> Values:
        """Show the latest copy of a shared session.

        Args:
            name: The name of the shared session.
            *fields: Fields among screen, ram and palette, such as screen:delta.
            since: The frame of the last reply; the fields come only if there is a newer one.

        Returns:
            A dictionary with these fields, and `game`, `frame`, `score`, `episode`, `over`, `lives`, `reward`, `action`
            and `height`.
        """
        return self._first("watch", name, *key_values(since=since), *fields)

    def stats(self) -> Values:
        """Show counters of this session.

        Returns:
            A dictionary with `requests`, `errors`, `acts`, `frames`, `episodes`, `bytes_in`, `bytes_out`, `states` and
            `machines`.
        """
        return self._first("stats")

    def quit(self) -> None:
        """End the session."""
        self.ask("quit")

    # end of commands
