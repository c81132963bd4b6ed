"""Attacks by one client of the line protocol, or of the classic one."""

import os
import pathlib
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from attack import BINARY, LOAD, Lacking, Session, Talk, attack, fault_of_end, fault_of_line, files_in, resident

HUGE = [
    *(str(base + more).encode() for base in (2**31, 2**32, 2**53, 2**63, 2**64) for more in (-1, 0, 1)),
    *(b"-" + str(2**power).encode() for power in (31, 32, 63, 64)),
    b"9" * 400,
    b"-1",
    b"-0",
    b"+1",
    b"0x10",
    b"1e9",
    b"1e308",
    b"1e999",
    b"nan",
    b"-inf",
    b"1_000",
    b"\xd9\xa1",
    b"1.5",
    b"",
]
REQUESTS = [
    b"act 0*%s",
    b"act %s",
    b"step %s",
    b"open %s",
    b"restart %s",
    b"reset seed=%s",
    b"load beamfall seed=%s",
    b"load beamfall frame_skip=%s",
    b"load beamfall frame_skip=2-%s",
    b"load beamfall sticky=%s",
    b"load beamfall max_episode_frames=%s",
    b"load beamfall noop_max=%s",
    b"load beamfall mode=%s",
    b"load beamfall difficulty=%s",
    b"load beamfall reward_min=%s",
    b"load beamfall system_seed=%s",
    b"load beamfall height=%s",
    b"load beamfall ystart=%s",
    b"peek %s",
    b"poke %s 1",
    b"poke 1 %s",
    b"observe grey%sx84x1",
    b"observe grey84x84x%s",
    b"branch root 0*%s",
    b"branch root %s",
    b"save a machine=%s",
    b"share room watchers=%s",
    b"look ram %s",
    b"stats %s",
    b"act 1 strength=%s",
    b"act 1@%s",
]
BAD_NAMES = [
    b".",
    b"..",
    b"../x",
    b"../../etc/passwd",
    b"/tmp/x",
    b"a/b",
    b"a\\b",
    b"-rf",
    b"~",
    b"$(id)",
    b"`id`",
    b";id",
    b"a\0b",
    b"\xff\xfe",
    b"\xe2\x80\xae",
    b"%2e%2e%2f",
    b"a" * 255,
    b"a" * 4096,
    b"a" * 100_000,
    b"*",
    b"a=b",
    b"CON",
    b".hidden",
    b"\x1b[2J",
    b"x.png",
    b"nul\r",
    b"",
]
NAMED = [
    b"record png %s",
    b"record gif,wav %s",
    b"log %s",
    b"shot %s",
    b"share %s",
    b"watch %s",
    b"save %s",
    b"restore %s",
    b"drop %s",
    b"export %s",
    b"import %s AAAA",
    b"branch root keep=%s 0",
    b"load %s",
    b"help %s",
    b"games %s",
]


@attack(times=1)
def huge_numbers(chance, times):
    """Each number, in each place of a request that takes one. At the end, the session still plays."""
    for _ in range(times):
        with Talk("--max-request-frames", "20000", "--max-memory", "256M") as talk:
            for number in HUGE:
                talk.ask(LOAD)
                talk.ask(b"save root")
                for request in REQUESTS:
                    yield fault_of_line(talk.ask(request % number))
            talk.ask(LOAD)
            yield "" if talk.ask(b"act 0").startswith(b"ok ") else "the session does not play on"


@attack(times=1)
def names(chance, times):
    """Names that lead out of a folder, or through a shell. Nothing may be written outside of the folder of recordings,
    nor replaced in it."""
    for _ in range(times):
        with tempfile.TemporaryDirectory() as place:
            records = pathlib.Path(place) / "records"
            records.mkdir()
            (records / "kept.gif").write_bytes(b"kept")
            (pathlib.Path(place) / "x").write_bytes(b"kept")
            with Talk("--record-dir", str(records)) as talk:
                talk.ask(LOAD)
                talk.ask(b"save root")
                for name in [*BAD_NAMES, b"kept"]:
                    for request in NAMED:
                        yield fault_of_line(talk.ask((request % name).replace(b"\n", b"")))
                    talk.ask(b"record stop")
                    talk.ask(LOAD)
                    talk.ask(b"save root")
            outside = {path: data for path, data in files_in(place).items() if not path.startswith("records/")}
            yield "" if outside == {"x": b"kept"} else f"the folder's surroundings now have {list(outside)}"
            yield "" if (records / "kept.gif").read_bytes() == b"kept" else "a file was replaced"


KEPT = 4096  # states on the stack of a classic session


@attack(times=2)
def stacks_of_states(chance, times):
    """A classic client pushes far more states than a stack keeps, and pops one more than it keeps."""
    for _ in range(times):
        with Session("stdio") as session:
            wire = session.wire
            wire.line()
            wire.send(b"0,0,0,1\n")  # only the episode's state
            wire.line()
            for action, count in ((43, 5 * KEPT), (44, KEPT), (0, 1)):
                for _ in range(count):
                    wire.send(b"%d,18\n" % action)
                    line = wire.line()
                    yield "" if line == b"0,0:\n" else f"the reply is {line[:100]!r}"
            memory = resident(session)
            yield "" if memory < 256 else f"{memory:.0f} MiB are resident"
            wire.send(b"44,18\n")
            wire.rest()
            yield fault_of_end(session.status(), "\n".join(session.server.log()), (1,))


@attack(times=2)
def states_with_pictures(chance, times):
    """256 states of stacks of pictures. Each is restored, in any order, to what was observed when it was saved."""
    for _ in range(times):
        with Talk("--max-memory", "512M") as talk:
            talk.ask(LOAD)
            talk.ask(b"observe reward frame ram screen:rle grey84x84x16:hex")
            seen = {}
            for number in range(256):
                reply = talk.ask(b"act %d*%d" % (chance.randrange(18), chance.randrange(1, 40)))
                yield fault_of_line(reply)
                yield fault_of_line(talk.ask(b"save s%d" % number))
                seen[number] = talk.ask(b"look ram screen:rle grey84x84x16:hex")
            yield "" if talk.ask(b"save too-many").startswith(b"error limit") else "a state too many is saved"
            for number in chance.sample(sorted(seen), len(seen)):
                talk.ask(b"restore s%d" % number)
                same = talk.ask(b"look ram screen:rle grey84x84x16:hex") == seen[number]
                yield "" if same else f"state s{number} shows something else"


@attack(times=100_000)
def resets(chance, times):
    """Resets, a thousand at a time. The memory does not grow, and the last episode is that of a new machine."""
    with Talk() as talk, Talk() as other:
        talk.ask(LOAD)
        before = None
        for done in range(0, times, 1000):
            count = min(1000, times - done)
            talk.send(b"".join(b"reset seed=%d\n" % chance.randrange(1, 2**31) for _ in range(count)))
            for _ in range(count):
                yield fault_of_line(talk.line())
            before = before or resident(talk.session)
        grown = resident(talk.session) - before
        yield "" if grown < 8 else f"{grown:.1f} MiB more are resident after the resets"
        other.ask(LOAD.replace(b"seed=1", b"seed=77"))
        talk.ask(b"reset seed=77")
        replies = []
        for each in (talk, other):
            each.ask(b"observe reward ram screen:rle")
            replies.append(each.ask(b"act 3*200"))
        yield "" if replies[0] == replies[1] else "the last episode is another than that of a new machine"


@attack(times=50)
def exports_into_another_process(chance, times):
    """A whole export, as it is and altered, into another server, which has the same game or another one loaded."""
    for _ in range(times):
        with Talk() as talk, Talk() as other:
            talk.ask(LOAD)
            talk.ask(b"act %d*%d" % (chance.randrange(18), chance.randrange(1, 300)))
            talk.ask(b"save here")
            state = talk.ask(b"export here episode=1").split(b"data=")[-1].strip()
            other.ask(LOAD.replace(b"seed=1", b"seed=9") if chance.random() < 0.5 else b"load updraft")
            yield fault_of_line(other.ask(b"import there " + state))
            other.ask(LOAD)
            yield fault_of_line(other.ask(b"import there " + state))
            yield fault_of_line(other.ask(b"restore there"))
            same = other.ask(b"look ram screen:rle") == talk.ask(b"look ram screen:rle")
            yield "" if same else "the state is another in another process"
            for _ in range(20):
                altered = bytearray(state)
                altered[chance.randrange(len(altered))] = chance.choice(b"Az09+/=")
                cut = altered[: chance.randrange(len(altered))] if chance.random() < 0.3 else altered
                yield fault_of_line(other.ask(b"import altered " + bytes(cut)))
                yield fault_of_line(other.ask(b"restore altered"))
                yield fault_of_line(other.ask(b"act 0*10"))


def replies(program, *requests):
    done = subprocess.run([program, "serve", "--stdio"], input=b"\n".join(requests) + b"\n", capture_output=True)
    return done.stdout.splitlines(keepends=True)


@attack(times=100)
def exports_into_another_version(chance, times):
    """Exports of the program of another commit, which --other names, into this one, and the other way round. A
    state is refused by a sentence, or all that is played after it is the same in both."""
    if "RACEBEAM_OTHER" not in os.environ:
        raise Lacking("--other does not name the program of another commit")
    versions = BINARY, os.environ["RACEBEAM_OTHER"]
    plays = [b"observe reward lives ram screen:rle", b"act 3*100 1*50", b"reset", b"act 11*50"]
    for number in range(times):
        source, target = versions if number % 2 else versions[::-1]
        game = chance.choice([b"beamfall", b"updraft"])
        load = b"load %s seed=%d frame_skip=4 sticky=0.25" % (game, chance.randrange(1, 1000))
        act = b"act %d*%d 1*3" % (chance.randrange(18), chance.randrange(1, 300))
        export = b"export here" + chance.choice([b"", b" whole=1"])
        *_, exported = replies(source, load, act, b"save here random=1", export)
        played = replies(source, load, act, b"save here random=1", *plays)[3:]
        there = replies(target, load, b"import there " + exported.split(b"data=")[-1].strip(), b"restore there", *plays)
        yield fault_of_line(there[1])
        if there[1].startswith(b"ok"):
            yield "" if there[3:] == played else "a state plays on otherwise in another version"


@attack(times=1)
def long_session(chance, times):
    """Commands with random arguments, in any order, for half a minute of one session."""
    words = [*NAMED, *REQUESTS]
    values = [b"0", b"1", b"7", b"root", b"beamfall", b"updraft", b"a", b"ram", b"screen", b"FIRE", *HUGE[:4]]
    for _ in range(times):
        with tempfile.TemporaryDirectory() as records:
            with Talk("--record-dir", records, "--max-request-frames", "5000", "--max-memory", "256M") as talk:
                end = time.monotonic() + 30
                while time.monotonic() < end:
                    yield fault_of_line(talk.ask(chance.choice(words) % chance.choice(values)))
