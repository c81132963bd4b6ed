"""The program answers the conversations of earlier versions as those versions did. VERSION.txt has them.

A reply may have keys that the recorded one lacks. To record the conversations of clients/conformance with this version:
  .venv/bin/python tests/server/recorded/test_recorded.py >tests/server/recorded/VERSION.txt
"""

import base64
import pathlib
import re
import sys
import tempfile
import zlib

FOLDER = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(FOLDER.parent))
from harness import SOURCE, run  # noqa: E402

CONVERSATION = pathlib.Path(SOURCE) / "clients/conformance/conversation.txt"
IMAGE = base64.b64encode((pathlib.Path(SOURCE) / "games/homebrew/updraft.bin").read_bytes()).decode()
SHOWN = 40  # characters of a value; of a longer one, the length and the Adler-32 are recorded
CHANGES = {
    "server",
    "threads",
    "bytes_in",
    "bytes_out",
    "bytes",
    "fps",
    "encodings",
    "presets",
}  # from run to run, or by additions


def short(value):
    return value if len(value) <= SHOWN else f"{len(value)}:{zlib.adler32(value.encode()):08x}"


def pairs(group):
    """The keys and values of a group. The bytes of a state are those of one version."""
    found = [word.partition("=")[::2] for word in group.split() if "=" in word]
    return {key: short(value) for key, value in found if key not in CHANGES and key != "data"}


def parsed(reply):
    """The status of a reply, and its groups. The sentence of an error is for people, and so is help."""
    status, _, rest = reply.partition(" ")
    if status == "error":
        return [status, {"code": rest.split(" ")[0]}]
    return [status, *map(pairs, f" {rest}".split(" |"))]


def replies(output):
    """The lines of the output, without the bytes that follow them."""
    found = []
    while output:
        line, _, output = output.partition(b"\n")
        found.append(line.decode("latin-1"))
        raw = re.search(rb" raw=(\d+)$", line)
        output = output[int(raw[1]) :] if raw else output
    return found


def hold(requests):
    """The replies to the requests of one session."""
    text = "".join(f"{request}\n" for request in requests).replace("$IMAGE", IMAGE)
    with tempfile.TemporaryDirectory() as folder:
        _, output, _ = run(
            "serve", "--stdio", "--record-dir", ".", "--log-level", "error", data=text.encode(), cwd=folder
        )
    return replies(output)


def conversations():
    """The requests of each section that one session of any server can hold."""
    for section in re.split(r"^section ", CONVERSATION.read_text(), flags=re.MULTILINE)[1:]:
        name, *steps = section.splitlines()
        steps = [step for step in steps if step and step != "connect $TCP"]
        requests = [step.partition(" ")[2] for step in steps if step.startswith(("> ", "send "))]
        plain = all(step.startswith((">", "send ", "receive ")) for step in steps)
        if plain and not re.search(r"\$(?!IMAGE)|^help|^record", "\n".join(requests), re.MULTILINE):
            yield name.split()[0], requests


def record():
    for name, requests in conversations():
        print(f"# {name}")
        for request, reply in zip(requests, hold(requests), strict=True):
            print(f"> {request}\n< {' '.join(recorded(reply))}")


def recorded(reply):
    """The words of a reply as they are recorded."""
    status, *groups = parsed(reply)
    for place, group in enumerate(groups):
        yield "|" if place else status
        yield from (f"{key}={value}" for key, value in group.items())


class TestRecorded:
    def test_each_recorded_conversation_is_answered_as_it_was(self, subtests):
        files = sorted(FOLDER.glob("*.txt"))
        assert files
        for path in files:
            for conversation in re.split(r"^# .*\n", path.read_text(), flags=re.MULTILINE)[1:]:
                lines = conversation.splitlines()
                requests = [line[2:] for line in lines[::2]]
                with subtests.test(version=path.stem, begins=requests[:2]):
                    self.check(requests, [line[2:] for line in lines[1::2]])

    def check(self, requests, expected):
        replies = hold(requests)
        assert len(replies) == len(expected)
        for request, reply, line in zip(requests, replies, expected):
            now, then = (
                parsed(reply),
                [
                    line.split()[0],
                    *(
                        {key: value for key, _, value in (word.partition("=") for word in group.split()) if key}
                        for group in f" {line.partition(' ')[2]}".split(" |")
                    ),
                ],
            )
            assert [now[0], len(now)] == [then[0], len(then)], request
            for group, before in zip(now[1:], then[1:]):
                values = {key: group.get(key) for key in before}
                assert values == before, request


if __name__ == "__main__":
    record()
