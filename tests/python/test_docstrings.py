"""The docstrings of the package: their examples run, and each public class has one."""

import doctest
import enum
import importlib
import inspect
import pkgutil
import typing

import package
import pytest

package.require("numpy", "gymnasium")

import racebeam

NEEDS = {"racebeam.results": "racebeam_evaluation", "racebeam.sb3": "stable_baselines3"}


def modules():
    """All modules of the package whose own needs are installed."""
    names = [module.name for module in pkgutil.walk_packages(racebeam.__path__, "racebeam.", onerror=lambda name: None)]
    for name in ["racebeam", *names]:
        if name not in NEEDS or package.has(NEEDS[name]):
            yield importlib.import_module(name)


def needs_no_example(kind):
    """Exceptions, enumerations, records and protocols are described by their fields."""
    records = issubclass(kind, (BaseException, enum.Enum, tuple)) or typing.is_typeddict(kind)
    return records or getattr(kind, "_is_protocol", False)


class TestDocstrings:
    @pytest.mark.needs_program
    def test_the_examples_run(self, subtests):
        for module in modules():
            finder = doctest.DocTestFinder(exclude_empty=True)
            runner = doctest.DocTestRunner(verbose=False)
            output = []
            for test in finder.find(module, module.__name__):
                runner.run(test, out=output.append)
            with subtests.test(module=module.__name__):
                assert "".join(output) == ""

    def test_each_class_that_is_exported_has_an_example(self):
        missing = []
        for module in modules():
            for name in getattr(module, "__all__", ()):
                kind = getattr(module, name)
                if not inspect.isclass(kind) or kind.__module__ != module.__name__ or needs_no_example(kind):
                    continue
                if ">>> " not in (kind.__doc__ or ""):
                    missing.append(f"{module.__name__}.{name}")
        assert missing == []
