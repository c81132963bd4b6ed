"""The small mistakes of scripts/check/mutants."""

import importlib.machinery
import importlib.util
import pathlib

import mutations

SOURCE = pathlib.Path(__file__).resolve().parents[2]


def edits(line):
    return set(mutations.edits_of(line))


class TestEdits:
    def test_limits_and_conditions_are_turned(self):
        turned = {"  if (a <= b && !c) return;", "  if (a < b || !c) return;", "  if (a < b && c) return;"}
        assert edits("  if (a < b && !c) return;") == turned
        assert edits("  return a == b;") == {"  return a != b;"}
        assert edits("  return std::min(a, b);") == {"  return std::max(a, b);", "  return std::min(b, a);"}

    def test_a_number_is_one_too_large_and_arguments_are_exchanged(self):
        assert edits("  const int most = 15;") == {"  const int most = 16;"}
        assert edits("  return call(a, b.c);") == {"  return call(b.c, a);"}
        assert edits('  return call("a", b);') == {'  return call(b, "a");'}
        assert edits("  return x0 - 0x1F;") == {"  return x0 + 0x1F;"}

    def test_a_statement_is_dropped_but_no_declaration(self):
        for line in ("  call(a);", "  a.b->c[i] = d;", "  ++count;", "  count_ += more;"):
            assert "" in edits(line), line
        for line in ("  return a;", "  const int a = b;", "  using std::min;", "  throw Error(a);"):
            assert "" not in edits(line), line

    def test_texts_comments_and_angle_brackets_are_not_code(self):
        assert edits('  return "a < b";  // 7 && 8') == set()
        assert edits("  return std::vector<int>(a);") == set()
        assert mutations.mutants("#include <a>\n// a < 1\nstatic_assert(a < 1);\n") == []
        source = 'auto a = R"(1\n2 < 3)";\nauto b = R"x(4)"\n5)x";\nreturn 6;\n'
        assert [each.line for each in mutations.mutants(source)] == [5]


class TestPython:
    def edits(self, line):
        return set(mutations.edits_of(line, mutations.PYTHON))

    def test_words_and_divisions_are_exchanged(self):
        assert self.edits("    if not a and b in c:") == {"    if a and b in c:", "    if not a or b in c:"}
        assert self.edits("    return a / max(b)") == {"    return a * max(b)", "    return a / min(b)"}
        assert self.edits("    return a not in b") == {"    return a in b"}

    def test_a_statement_that_defines_a_name_is_not_dropped(self):
        for line in ("    call(a)", "    a.b = c", "    a[b] = c", "    a += b"):
            assert "    pass" in self.edits(line), line
        for line in ("    a = b", "    return call(a)", "    raise Error(a)"):
            assert "    pass" not in self.edits(line), line

    def test_docstrings_are_not_code_and_each_mutant_compiles(self):
        source = 'def f(a):\n    """a < 1\n\n    b < 2."""\n    return a < 3\n'
        found = mutations.mutants(source, mutations.PYTHON)
        assert [each.after.strip() for each in found] == ["return a <= 3", "return a < 4"]
        assert mutations.mutants("call(1,\n     b)\n", mutations.PYTHON)[0].after == "call(2,"
        assert not mutations.compiles("call(\n")


class TestMutants:
    SOURCE = "int f(int a) {\n  return a + 1;\n}\n"

    def test_each_changes_one_line(self):
        found = mutations.mutants(self.SOURCE)
        assert [mutant.line for mutant in found] == [2, 2]
        assert [mutant.apply(self.SOURCE) for mutant in found] == [
            "int f(int a) {\n  return a - 1;\n}\n",
            "int f(int a) {\n  return a + 2;\n}\n",
        ]
        assert str(found[0]) == "2: return a + 1;\n    return a - 1;"


class TestRooms:
    def test_each_test_of_a_room_is_there(self):
        loader = importlib.machinery.SourceFileLoader("mutants", str(SOURCE / "scripts/check/mutants"))
        script = importlib.util.module_from_spec(importlib.util.spec_from_loader("mutants", loader))
        loader.exec_module(script)
        named = [test for room in script.PYTHON_ROOMS.values() for test in room.tests]
        named += [test.relative_to(script.COPY) for room in script.PROGRAM_ROOMS.values() for test in room.tests]
        assert len(named) > 30
        assert [str(test) for test in named if not (SOURCE / test).exists()] == []
