"""A client of the racebeam line protocol (protocol/PROTOCOL.md), standard library only.

    with Session.start("build/release/racebeam") as game:       # or Session.tcp(host, port), Session.unix(path)
        game.load("beamfall", seed=7, frame_skip=4)
        game.observe("reward", "ends", "ram", "screen:delta")
        while True:
            shown = game.act("FIRE")                             # {"reward": 0, "terminated": 0, ..., "screen": bytes}
            if shown["terminated"] or shown["truncated"]:
                break

One method a command, in the order of the document. Numbers come as int or float, bytes as bytes. What the server refuses is
raised as Refused, with .code and .sentence; the session goes on.
"""

import base64
import re
import socket
import subprocess
import zlib

# What bytes are written in when `observe` does not say.
USUAL_ENCODING = {"ram": "hex", "screen": "rle", "rgb": "zlib", "grey": "zlib", "palette": "hex", "audio": "hex"}


class Refused(Exception):
    """`error CODE sentence`."""

    def __init__(self, code, sentence):
        super().__init__(f"{code}: {sentence}")
        self.code, self.sentence = code, sentence


def decode_runs(data):
    return b"".join(data[at:at + 1] * data[at + 1] for at in range(0, len(data), 2))


def apply_delta(array, text):
    """Changes `array`, a bytearray, by the text of a delta; it grows to what the text reaches."""
    data, at, place = bytes.fromhex(text), 0, 0
    while at < len(data):
        place += data[at] << 8 | data[at + 1]
        runs, at = data[at + 2], at + 3
        for _ in range(runs):
            value, length, at = data[at], data[at + 1], at + 2
            if place + length > len(array):
                array.extend(bytes(place + length - len(array)))
            array[place:place + length] = bytes([value]) * length
            place += length


def decode_rewards(text):
    """A list from R,R*TIMES,..."""
    rewards = []
    for run in filter(None, text.split(",")):
        reward, _, times = run.partition("*")
        rewards += [int(reward)] * int(times or 1)
    return rewards


DECODERS = {
    "hex": bytes.fromhex,
    "rle": lambda text: decode_runs(bytes.fromhex(text)),
    "base64": base64.b64decode,
    "zlib": lambda text: zlib.decompress(base64.b64decode(text)),
}


def number(text):
    try:
        return int(text)
    except ValueError:
        try:
            return float(text)
        except ValueError:
            return text


class Session:
    def __init__(self, reader, writer, close):
        self.reader, self.writer, self._close = reader, writer, close
        self.encodings = {}  # of the fields that observe chose
        self.height = 0
        self.arrays = {}     # (machine, field): what deltas have made so far

    @classmethod
    def start(cls, racebeam="racebeam", *options):
        """A server of one's own, on standard streams."""
        process = subprocess.Popen([racebeam, "serve", "--stdio", *options], stdin=subprocess.PIPE, stdout=subprocess.PIPE)

        def close():
            process.stdin.close()
            process.stdout.close()
            process.wait()
        return cls(process.stdout, process.stdin, close)

    @classmethod
    def tcp(cls, host, port, tls=None):
        """`tls`: an ssl.SSLContext that trusts the server's certificate."""
        connection = socket.create_connection((host, port))
        connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        return cls.connected(tls.wrap_socket(connection, server_hostname=host) if tls else connection)

    @classmethod
    def unix(cls, path):
        connection = socket.socket(socket.AF_UNIX)
        connection.connect(path)
        return cls.connected(connection)

    @classmethod
    def connected(cls, connection):
        reader, writer = connection.makefile("rb"), connection.makefile("wb")

        def close():
            for end in (reader, writer, connection):
                end.close()
        return cls(reader, writer, close)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close_connection()

    def close_connection(self):
        self._close()

    # Requests and replies

    def send(self, *words, **settings):
        """A request without waiting for its reply; receive() gives the replies in their order."""
        words = [str(word) for word in words] + [f"{key}={value}" for key, value in settings.items()]
        self.writer.write((" ".join(words) + "\n").encode())

    def receive(self):
        """The groups of the next reply, each a dictionary of texts."""
        self.writer.flush()
        line = self.reader.readline().decode()
        if not line:
            raise ConnectionError("the server has closed the session")
        status, _, rest = line.rstrip("\n").partition(" ")
        if status == "error":
            raise Refused(*rest.split(" ", 1))
        groups = (" " + rest).split(" |")
        return [dict(word.split("=", 1) for word in group.split(" ") if "=" in word) for group in groups]

    def ask(self, *words, **settings):
        self.send(*words, **settings)
        return self.receive()

    def values(self, *words, **settings):
        return {key: number(text) for key, text in self.ask(*words, **settings)[0].items()}

    def list_of(self, key, *words):
        text = self.ask(*words)[0][key]
        return text.split(",") if text else []

    # Observations

    def decoded(self, texts, machine=0, encodings=None):
        """The fields of one group, as numbers and bytes."""
        encodings = self.encodings if encodings is None else encodings
        return {key: self._value(machine, key.removeprefix("final_"), text, encodings) for key, text in texts.items()}

    def _value(self, machine, field, text, encodings):
        encoding = encodings.get(field)
        if encoding is None:
            return number(text)
        if encoding != "delta":
            return DECODERS[encoding](text)
        array = self.arrays.setdefault((machine, field), bytearray(self._size(field)))
        apply_delta(array, text)
        return bytes(array)

    def _size(self, field):
        if field.startswith("grey84"):
            return 84 * 84 * int(field.partition("x")[2] or 1)
        return {"ram": 128, "palette": 768, "audio": 512, "screen": 160 * self.height, "grey": 160 * self.height,
                "rgb": 480 * self.height}[field]

    def _shown(self, *words, **settings):
        return self.decoded(self.ask(*words, **settings)[0])

    def _machines(self, *words, **settings):
        return [self.decoded(texts, machine) for machine, texts in enumerate(self.ask(*words, **settings)[1:], 1)]

    @staticmethod
    def _encodings(fields):
        pairs = [field.partition(":") for field in fields]
        usual = {name: USUAL_ENCODING.get(name, "zlib" if re.match(r"(grey|rgb)\d", name) else None) for name, _, _ in pairs}
        return {name: encoding or usual[name] for name, _, encoding in pairs if encoding or usual[name]}

    # Commands

    def hello(self, token=None):
        return self.values("hello", token=token) if token else self.values("hello")

    def help(self, *words):
        self.send("help", *words)
        self.writer.flush()
        return self.reader.readline().decode().rstrip("\n").partition(" ")[2]

    def games(self, *words):
        return self.list_of("games", "games", *words)

    def load(self, game, image=None, **settings):
        """`image`: the bytes of a cartridge, when `game` is "inline"."""
        if image is not None:
            settings["image"] = base64.b64encode(image).decode()
        loaded = self.values("load", game, **settings)
        self.height = loaded["height"]
        self.arrays.clear()
        return loaded

    def settings(self):
        return self.values("settings")

    def set(self, **settings):
        return self.values("set", **settings)

    def modes(self):
        return [int(mode) for mode in self.list_of("modes", "modes")]

    def difficulties(self):
        return [int(difficulty) for difficulty in self.list_of("difficulties", "difficulties")]

    def actions(self):
        """Names by number."""
        pairs = (pair.split(":") for pair in self.list_of("actions", "actions"))
        return {int(action): name for action, name in pairs}

    def observe(self, *fields):
        chosen = self.list_of("fields", "observe", *fields)
        if fields:
            self.encodings = self._encodings(fields)
            self.arrays.clear()
        return chosen

    def look(self, *fields):
        texts = self.ask("look", *fields)[0]
        return self.decoded(texts, 0, self._encodings(fields) if fields else None)

    def palette(self):
        """Red, green and blue of each value that a pixel of `screen` can have."""
        data = self.look("palette")["palette"]
        return [tuple(data[at:at + 3]) for at in range(0, len(data), 3)]

    def act(self, *actions):
        return self._shown("act", *actions)

    def reset(self, seed=None):
        return self._shown("reset", **({} if seed is None else {"seed": seed}))

    def peek(self, index, count=1):
        return bytes.fromhex(self.ask("peek", index, count)[0]["bytes"])

    def poke(self, index, data):
        self.ask("poke", index, data.hex().upper())

    def save(self, name, random=0):
        self.ask("save", name, random=random)

    def restore(self, name):
        return self._shown("restore", name)

    def drop(self, *names):
        self.ask("drop", *names)

    def states(self):
        return self.list_of("states", "states")

    def export_state(self, name):
        return base64.b64decode(self.ask("export", name)[0]["data"])

    def import_state(self, name, data):
        self.ask("import", name, base64.b64encode(data).decode())

    def branch(self, name, *sequences, keep=None):
        """Each sequence is a list of actions; answers a dictionary for each, with `rewards`, and `rewards_b` if there are, as lists."""
        words = [f"keep={keep}"] if keep else []
        words += [",".join(map(str, actions)) for actions in sequences]
        results = []
        for texts in self.ask("branch", name, *words)[1:]:
            results.append({key: decode_rewards(text) if key.startswith("rewards") else number(text) for key, text in texts.items()})
        return results

    def open(self, count, autoreset="next-step", **settings):
        self.arrays.clear()
        return self._machines("open", count, autoreset=autoreset, **settings)

    def step(self, *actions):
        return self._machines("step", *actions)

    def restart(self, *mask, seed=None):
        return self._machines("restart", *mask, **({} if seed is None else {"seed": seed}))

    def close(self):
        self.ask("close")

    def record(self, kinds, name, machine=None):
        """`kinds`: one, or several as in "y4m,wav"; `machine`: one of those of open(), 0 the first."""
        return self.values("record", kinds, name, **({} if machine is None else {"machine": machine}))

    def stop_recording(self):
        return self.values("record", "stop")

    def stats(self):
        return self.values("stats")

    def quit(self):
        self.ask("quit")
