"""The C++ sources include what the table of rooms allows (docs/rooms.toml)."""

import re
import sys

import pytest
import room_table
from tree import ROOT

sys.path.insert(0, str(ROOT / "docs/pictures"))
import draw  # noqa: E402


class TestThisTree:
    def test_every_include_is_allowed_and_every_row_is_used(self):
        assert room_table.faults() == []

    def test_no_portable_source_includes_a_header_of_the_operating_system(self):
        assert room_table.system_faults() == []

    def test_no_portable_source_waits_for_an_atomic_variable(self):
        assert room_table.waits_for_atomics() == []

    def test_each_row_uses_only_rows_above_it(self):
        assert room_table.order_faults() == []

    def test_the_table_has_all_rooms(self):
        assert room_table.missing() == []

    def test_the_document_has_the_rooms_of_the_table_in_their_order(self):
        document = (ROOT / "docs/architecture.md").read_text()
        for folder, rows in room_table.read()[1].items():
            line = re.search(rf"^\| `{folder}/` \| (`.*) \|$", document, re.MULTILINE)
            names = [name for name in re.findall(r"`([\w/]+)`", line[1]) if name in rows] if line else []
            assert names == [room for room in rows if room != room_table.TOP], folder


TABLE = """
[portable]
folders = ["low", "high"]
except = ["low/linux"]
headers = ["zlib.h"]
refused = ["latch"]
[folders]
low = []
high = ["low"]
[rooms.high]
first = ["shared.hpp"]
second = ["first"]
"""


class TestTheCheck:
    @pytest.fixture(autouse=True)
    def set_up(self, tmp_path):
        self.root = tmp_path
        self.write(room_table.TABLE, TABLE)
        self.write("low/base.hpp", "")
        self.write("high/shared.hpp", "")
        self.write("high/first/one.hpp", '#include "low/base.hpp"\n#include "high/shared.hpp"\n#include <low/no.hpp>\n')
        self.write("high/second/two.cpp", '#include "high/first/one.hpp"\n')

    def write(self, name, text):
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)

    def test_what_is_allowed_is_accepted(self):
        assert room_table.faults(self.root) == []
        assert room_table.order_faults(self.root) == []
        assert room_table.missing(self.root) == ["high"]  # the table has no "top"

    def test_an_include_that_is_not_allowed_is_named(self):
        self.write("low/up.cpp", '  # include "high/shared.hpp"\n')
        self.write("high/first/back.cpp", '#include "high/second/new.hpp"\n')
        self.write("high/second/new.hpp", '#include "high/shared.hpp"\n')
        assert room_table.faults(self.root) == [
            "low/up.cpp includes high/shared.hpp",
            "high/first/back.cpp includes high/second/new.hpp",
            "high/second/new.hpp includes high/shared.hpp",
        ]

    def test_a_header_of_the_operating_system_is_named(self):
        self.write("high/first/one.hpp", "#include <vector>\n")
        self.write("low/base.hpp", "#include <zlib.h>\n")
        self.write("low/linux/pages.cpp", "#include <sys/mman.h>\n")
        assert room_table.system_faults(self.root) == []
        self.write("low/time.cpp", "#  include <time.h>\n")
        self.write("high/first/pages.cpp", "#include <sys/mman.h>\n")
        self.write("low/base.hpp", "")
        assert room_table.system_faults(self.root) == [
            "low/time.cpp includes time.h",
            "high/first/pages.cpp includes sys/mman.h",
            "docs/rooms.toml: no portable source includes zlib.h",
        ]

    def test_what_waits_for_an_atomic_variable_is_named(self):
        self.write("low/base.hpp", "#include <zlib.h>\n#include <latch>\n")
        self.write("low/wait.cpp", "flag_.wait(false);\n")
        self.write("low/count.cpp", "count.wait(0, std::memory_order::acquire);\n")
        self.write("low/lock.cpp", "changed_.wait(lock);\nloop.turns.wait(loop.context, client.usage);\n")
        assert "low/base.hpp includes latch" in room_table.system_faults(self.root)
        assert room_table.waits_for_atomics(self.root) == ["low/count.cpp", "low/wait.cpp"]

    def test_a_row_that_nobody_needs_is_named(self):
        self.write("high/second/two.cpp", "")
        assert room_table.faults(self.root) == ["docs/rooms.toml: nothing in second of high uses first"]

    def test_a_circle_and_a_room_without_a_row_are_named(self):
        self.write(room_table.TABLE, TABLE.replace('["shared.hpp"]', '["second"]'))
        self.write("high/third/three.hpp", "")
        assert room_table.order_faults(self.root) == ["high: first uses second"]
        assert room_table.missing(self.root) == ["high", "high/third"]

    def test_arrows_that_follow_from_others_are_not_drawn(self):
        uses = {"a": [], "b": ["a"], "c": ["a", "b"], "d": ["a"]}
        assert draw.needed(uses) == [("b", "a"), ("c", "b"), ("d", "a")]
