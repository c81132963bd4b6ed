"""One run on both sides, line by line, and a report on the first line that differs."""

import itertools
import shlex

import ours
from images import Image, rule_of
from picture import write_comparison
from reference import Reference
from run import step_word

EVENT = {"R": [], "A": ["action", "reward", "over"], "M": ["index", "value"]}
OBSERVATION = ["lives", "ram", "screen", "audio", "truncated", "frame", "episode frame", "rgb", "grey"]
IDENTICAL, DIFFERENT, FAILED = "identical", "DIFFERENT", "failed"


def fields(line):
    words = line.split()
    return dict(zip([*EVENT.get(words[0], []), *OBSERVATION], words[1:]))


def differing_fields(theirs, line):
    """(field, reference, racebeam) of all fields that differ."""
    if line.split()[:1] != theirs.split()[:1]:
        return [("event", theirs.split()[0], line[:1])]
    a, b = fields(theirs), fields(line)
    return [(field, a[field], b.get(field, "nothing")) for field in a if a[field] != b.get(field)]


def differing_bytes(theirs, mine):
    """(address, reference, racebeam) of the bytes of RAM that differ."""
    return [(f"ram[{0x80 + i:02X}]", f"{a:02x}", f"{b:02x}") for i, (a, b) in enumerate(zip(theirs, mine)) if a != b]


def differing_lists(game, reference):
    """(list, reference, racebeam) of the lists that the game offers."""
    row = ours.catalogue().get(rule_of(game), {})

    def sort(key, values):
        return sorted(values) if key in ("modes", "difficulties") else values

    return [
        (key, theirs, row.get(key))
        for key, theirs in reference.lists().items()
        if theirs != sort(key, row.get(key, []))
    ]


class Comparison:
    def __init__(self, run, folder, extra=(), forms=()):
        self.run, self.folder, self.extra, self.forms = run, folder, extra, forms
        self.image = Image(run)
        self.steps = list(run.steps())
        self.count = 0  # steps

    def steps_taken(self):
        for step in self.steps:
            self.count += 1
            yield step

    def result(self):
        reference = Reference(self.run, self.image)
        lists = differing_lists(self.run.game, reference)
        if lists:
            return self.verdict(DIFFERENT, 0, "what the game offers differs\n" + table(lists))
        output = ours.play(self.run, self.image, self.steps, self.extra)
        for number, (theirs, line) in enumerate(
            itertools.zip_longest(reference.lines(self.steps_taken()), output.lines)
        ):
            if theirs != line:
                return self.verdict(
                    DIFFERENT, reference.frames, self.explain(reference, number, theirs, line, output.end)
                )
        if output.end:
            return self.verdict(DIFFERENT, reference.frames, f"racebeam ended with {output.end}")
        for form in self.forms:
            difference = self.difference_of(form, output.lines)
            if difference:
                return self.verdict(DIFFERENT, reference.frames, difference)
        return self.verdict(IDENTICAL, reference.frames, "")

    def difference_of(self, form, lines):
        """The first difference between these lines and those of another variant of racebeam, or nothing."""
        options, variables = ours.FORMS[form]
        other = ours.play(self.run, self.image, self.steps, [*self.extra, *options], variables)
        for number, (line, theirs) in enumerate(itertools.zip_longest(lines, other.lines)):
            if line != theirs:
                return f"{form}, line {number}: {theirs or other.end}, where all else have {line}"
        return f"{form} ended with {other.end}" if other.end else ""

    def verdict(self, verdict, frames, report):
        return {"run": self.run.name, "verdict": verdict, "frames": frames, "report": report}

    def explain(self, reference, number, theirs, line, end):
        where = (
            f"line {number}, frame {reference.ale.getFrameNumber()}, "
            f"act {reference.act_of_episode} of episode {reference.episode}"
        )
        if line is None:
            return f"{where}: racebeam ended with {end or 'fewer lines'}"
        differences = differing_fields(theirs or "nothing", line)
        sight = ours.look(self.run, self.image, self.steps[: self.count], number, self.extra)
        evidence = self.evidence(reference, number, sight)
        return "\n".join([f"first difference in {where}", table(differences), *evidence])

    def evidence(self, reference, number, sight):
        """The bytes of RAM that differ, a picture, and the commands that reproduce the difference."""
        stem = self.folder / self.run.name.replace(":", "-").replace(",", "-").replace("=", "")
        self.folder.mkdir(parents=True, exist_ok=True)
        script = stem.with_name(stem.name + ".actions")
        script.write_text("\n".join(map(step_word, self.steps[: self.count])) + "\n")
        options = [*self.extra, "--screen-of", str(number)]
        command = ours.trace_command(self.run, self.image.path, script, options)
        if sight:
            bytes_of_ram = differing_bytes(reference.ram.tobytes(), sight.ram)
            if bytes_of_ram:
                yield table(bytes_of_ram[:16])
            reference.colors()
            picture = stem.with_name(stem.name + ".png")
            pixels = write_comparison(picture, reference.screen, reference.rgb, sight.screen, sight.rgb)
            yield f"  {pixels} pixels differ: {picture} (reference | racebeam | difference)"
        extra = f" --racebeam-options={shlex.quote(shlex.join(self.extra))}" if self.extra else ""
        yield f"  again:    scripts/conformance --run {shlex.quote(self.run.name)}{extra}"
        yield f"  racebeam: {shlex.join(map(str, command))}"


def result_of(run, result):
    """A result that is a sentence is the reason why the comparison failed."""
    if not isinstance(result, str):
        return result
    return {"run": run.name, "verdict": FAILED, "frames": 0, "report": result}


def table(differences):
    return "\n".join(f"  {field:13} reference {theirs}  racebeam {mine}" for field, theirs, mine in differences)
