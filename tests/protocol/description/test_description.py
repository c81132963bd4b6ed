"""From a row of the description come the rows of the program, of the document, and of every client."""

import dataclasses
import importlib.machinery
import importlib.util
import pathlib
import re
import sys
import tempfile

import pytest

SOURCE = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(SOURCE / "protocol/description"))
import description  # noqa: E402
import python_single_file  # noqa: E402
import regions  # noqa: E402

loader = importlib.machinery.SourceFileLoader("generate", str(SOURCE / "protocol/description/generate"))
generate = importlib.util.module_from_spec(importlib.util.spec_from_loader("generate", loader))
loader.exec_module(generate)

CLIENTS = ("python", "java", "js", "lua", "cpp", "shell")
COMPLETION, TYPES = "clients/shell/completion.bash", "clients/js/src/index.d.ts"


def changed(text):
    """The files that change when `text` is added to the description, with their new contents."""
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "protocol.toml"
        path.write_text(f"{description.SOURCE.read_text()}\n{text}")
        files = generate.generated(description.read(path))
    return {name: files[name] for name in generate.stale(files)}


def folders(files):
    return {path.split("/")[1] for path in files if path.startswith("clients/")}


class TestRows:
    def test_the_description_is_what_the_tree_has(self):
        assert changed("") == {}

    def test_a_field_of_bytes_reaches_every_client(self):
        files = changed(
            '[[field]]\nname = "shadow"\nshape = ["height", 160]\nencoding = "delta"\nsummary = "what was"\n'
        )
        assert folders(files) == set(CLIENTS)
        for path, text in files.items():
            assert "shadow" in text, path
        assert "| `shadow` | what was | delta |\n" in files["protocol/PROTOCOL.md"]
        assert ".B shadow\nwhat was\n" in files["protocol/racebeam-protocol.7"]

    def test_a_preset_of_evaluation_reaches_those_who_read_plans_and_logs(self):
        sets = "frame_skip=3 sticky=0.5 action_set=legal max_episode_frames=77 noop_max=0"
        files = changed(f'[[evaluation_preset]]\nname = "brief"\nsets = "{sets}"\n')
        assert {
            path: next(line.strip() for line in text.splitlines() if '"brief"' in line) for path, text in files.items()
        } == {
            "environment/settings/setting_tables.hpp": f'{{"brief", "{sets}"}},',
            "evaluation/racebeam_evaluation/plan.py": '"brief": ("3", "0.5", "legal", "77", "0"),',
            "clients/python/racebeam/single/submission.py": '"brief": (3, 0.5, "legal", 77),',
        }

    def test_a_preset_of_evaluation_sets_what_decides_scores(self):
        with pytest.raises(ValueError, match="evaluation_preset brief: sets 'sticky=0'; it sets frame_skip, sticky"):
            changed('[[evaluation_preset]]\nname = "brief"\nsets = "sticky=0"\n')

    def test_a_command_has_a_method_in_every_client_and_completes_in_bash(self):
        files = changed(
            '[[command]]\nname = "rewind"\nneeds = "game"\nsummary = "go back"\nreturns = "first"\n'
            'arguments = [{ word = "count", text = "N", type = "int" }]\n'
        )
        assert folders(files) == set(CLIENTS)
        assert "[rewind]=''" in files["clients/shell/completion.bash"]
        assert ".B rewind N\ngo back\n" in files["protocol/racebeam-protocol.7"]
        assert "def rewind(self, count: int) -> Values:" in files["clients/python/racebeam/wire/commands.py"]
        assert "public Group rewind(long count) throws" in files["clients/java/src/main/java/racebeam/Commands.java"]
        assert "run_rewind, " in files["protocol/description/command_rows.inc"]

    def test_a_setting_and_an_error_code_reach_the_program_and_the_document(self):
        for text, table, clients in (
            (
                '[[setting]]\nname = "tint"\ntype = "int"\naccepted = "0 to 9"\ndefault = "0"\nsummary = "colours"\n',
                "environment/settings/setting_tables.hpp",
                {COMPLETION, TYPES},
            ),
            (
                '[[error]]\ncode = "too-dark"\nmeaning = "nothing is seen"\n',
                "protocol/description/tables.hpp",
                {COMPLETION},
            ),
        ):
            files = changed(text)
            assert "protocol/PROTOCOL.md" in files
            assert table in files
            assert "protocol/racebeam-protocol.7" in files
            assert {path for path in files if path.startswith("clients/")} == clients

    def test_a_setting_has_a_type_in_typescript(self):
        for kind, accepted, default, expected in (
            ("int", "0 to 9", "0", " number;"),
            ("int", "random, or 1 to 9", "random", ' number | "random";'),
            ("flag", "0 or 1", "0", " 0 | 1 | boolean;"),
            ("text", "red, green or blue", "red", ' "red" | "green" | "blue";'),
            ("text", "none or a whole number", "none", " number | string;"),
        ):
            row = (
                f'name = "tint"\ntype = "{kind}"\naccepted = "{accepted}"\ndefault = "{default}"\nsummary = "colours"\n'
            )
            assert f"  tint?:{expected}\n" in changed(f"[[setting]]\n{row}")[TYPES]

    def test_what_is_true_or_false_is_known_where_0_would_be_true(self):
        for text, clients in (
            (
                '[[setting]]\nname = "tint"\ntype = "flag"\naccepted = "0 or 1"\ndefault = "0"\nsummary = "colours"\n',
                {"lua", "shell", "js"},
            ),
            (
                '[[command]]\nname = "rewind"\nneeds = "game"\nsummary = "go back"\nreturns = "own"\n'
                '[command.reply]\n"tint?" = "flag"\n',
                {"lua", "shell"},
            ),
        ):
            files = changed(text)
            assert folders(files) == clients
            assert "    tint = true,\n" in files["clients/lua/racebeam/field_table.lua"]

    def test_what_is_deprecated_is_marked(self):
        files = changed('[[encoding]]\nname = "old"\nsummary = "as before"\ndeprecated = "hex"\n')
        assert "protocol/PROTOCOL.md" not in files  # its tables have what is current
        assert '{"old", "as before (deprecated: use hex)"}' in files["protocol/description/tables.hpp"]

    def test_an_old_word_reaches_the_program_the_document_and_the_clients_with_types(self):
        files = changed(
            '[[command]]\nname = "rewind"\nneeds = "game"\nsummary = "go back"\nreturns = "first"\n'
            'arguments = [{ key = "frames", text = "N", type = "int", optional = true, old = "steps",'
            ' old_values = { 0 = "1" } }, { key = "loop", text = "N", type = "int", optional = true }]\n'
        )
        assert '{"rewind", "steps", "frames", true}' in files["protocol/description/tables.hpp"]
        assert '{"rewind", "frames=0", "frames=1", true}' in files["protocol/description/tables.hpp"]
        assert "| `rewind` | `steps` | `frames` |\n" in files["protocol/PROTOCOL.md"]
        python = files["clients/python/racebeam/wire/commands.py"]
        assert "*key_values(frames=frames, loop=loop, steps=steps)" in python
        assert "steps: Old name of `frames`." in python
        assert "steps?: number" in files["clients/js/src/index.d.ts"]


class TestMistakes:
    def test_a_mistake_in_the_description_is_named(self):
        for text, sentence in (
            (
                '[[error]]\ncode = "a"\nmeening = "b"\n',
                "rows of error have no meening; they have code, deprecated, meaning, since",
            ),
            ('[[encoding]]\nname = "hex"\nsummary = ""\n', r"a name is there twice: \['hex', 'hex'\]"),
            (
                '[[field]]\nname = "x"\nsummary = ""\nshape = [1]\n',
                "field x: a field of bytes has a shape and an encoding",
            ),
            ('[[command]]\nname = "x"\nneeds = "luck"\nsummary = ""\nreturns = "own"\n', "needs is 'luck'"),
        ):
            with pytest.raises(ValueError, match=sentence):
                changed(text)

    def test_a_file_without_its_region_is_refused(self):
        with pytest.raises(ValueError, match="the file has no region fields"):
            regions.with_region("nothing\n", "", "#", "fields", "")


class TestSingleFile:
    def test_it_has_the_definitions_of_the_modules_and_the_imports_of_all(self):
        text = python_single_file.joined(
            {
                "one": 'import re\n\nA = re.compile("a")\n',
                "client": (
                    '"""What it is."""\n\nfrom typing import Any\n\nfrom .one import A\n\nB: Any = A\n\n'
                    '__all__ = ["B"]\n'
                ),
            }
        )
        names = {}
        exec(text, names)
        assert names["B"] is names["A"]
        assert (names["__all__"], names["__doc__"]) == (["B"], "What it is.")

    def test_two_modules_that_define_one_name_are_refused(self):
        with pytest.raises(ValueError, match="two modules of the client in Python define A"):
            python_single_file.joined({"one": "A = 1\n", "client": "A = 2\n"})


class TestVersions:
    def test_every_row_says_since_when_it_is_there(self):
        protocol = description.read()
        for table in (
            protocol.commands,
            protocol.settings,
            protocol.presets,
            protocol.fields,
            protocol.encodings,
            protocol.errors,
        ):
            for row in table:
                assert re.search(r"^\d+\.\d+\.\d+$", dataclasses.asdict(row)["since"])
