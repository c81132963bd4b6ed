"""Makes logs of episodes and folders of submissions, as docs/episodes.md and docs/evaluation.md describe them."""

import hashlib
import pathlib
import struct
import zlib

from made_results import RESULTS

SETTINGS = "frame_skip=5 sticky=0 action_set=full max_episode_frames=18000"
ABOUT = """agent = "{agent}"
version = "1.0"
words = "Ours <b>& theirs</b>"
preset = "{preset}"
training_frames = 4000000
link = "https://example.org/agent"
"""


def seal(contents, size=None):
    """The bytes of a log with these contents."""
    head = struct.pack("<8sIQ", b"RBEPISOD", 1, len(contents) if size is None else size)
    deflated = zlib.compress(contents)
    return head + struct.pack("<I", zlib.crc32(deflated, zlib.crc32(head))) + deflated


def log(row, settings=SETTINGS, actions=None):
    """The bytes of the log of a row of results.csv."""
    actions = bytes([3] * int(row["decisions"])) if actions is None else actions
    hashes = bytes(8 * (int(row["decisions"]) // 256)) + bytes.fromhex(row["state_hash"])[::-1]
    text = (
        "load {game} seed={environment_seed} {settings}\nimage {image_md5}\n"
        "from unit={unit} agent={agent} trial={trial} episode={episode} agent_seed={agent_seed} version={version}\n"
        "ended score={score} frames={frames} decisions={decisions} end={end} lives={lives}\n\n"
    ).format(**row, settings=settings)
    return seal(text.encode() + hashes + actions)


def row_of(agent, game, trial, episode, score, **others):
    """A row of results.csv, by column; the digest is that of its log."""
    row = {
        "unit": f"{game}-{agent}-{trial}",
        "game": game,
        "image_md5": f"md5-of-{game}",
        "agent": agent,
        "trial": str(trial),
        "episode": str(episode),
        "environment_seed": "7",
        "agent_seed": "9",
        "score": str(score),
        "frames": "1500",
        "decisions": "300",
        "end": "terminated",
        "lives": "0",
        "state_hash": "00000000000000ff",
        "version": "0.1.0",
        **others,
    }
    return {**row, "log_digest": hashlib.sha256(log(row)).hexdigest()}


def submission(folder, agent="mine", scores=None, preset="paper2013"):
    """Writes a submission of {game: [scores of the episodes of each trial]}, and returns its folder and rows."""
    folder = pathlib.Path(folder)
    scores = {"pong": [[1, 3], [5, 7]]} if scores is None else scores
    rows = [
        row_of(agent, game, trial, episode, score)
        for game, trials in scores.items()
        for trial, episodes in enumerate(trials, 1)
        for episode, score in enumerate(episodes, 1)
    ]
    folder.mkdir(parents=True)
    (folder / "agent.toml").write_text(ABOUT.format(agent=agent, preset=preset))
    write_rows(folder, rows)
    for row in rows:
        path = log_path(folder, row)
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(log(row))
    return folder, rows


def write_rows(folder, rows):
    """Writes results.csv."""
    lines = [",".join(row[name] for name in RESULTS.split(",")) for row in rows]
    (folder / "results.csv").write_text("\n".join([RESULTS, *lines, ""]))


def log_path(folder, row):
    """The path of the log of a row."""
    return folder / "logs" / row["unit"] / f"{row['episode']}.episode"
