"""The package as a whole: stubs, docstrings, versions, examples."""

from __future__ import annotations

import doctest
import inspect
import json
import pathlib
import re
import subprocess
import sys

import pytest
from conftest import ROOT

import pliant

PYTHON = ROOT / "bindings" / "python"


def test_stubs_are_those_of_the_module(tmp_path: pathlib.Path) -> None:
    subprocess.run([sys.executable, str(PYTHON / "tools" / "make_stubs.py"), str(tmp_path)], check=True)
    for made in tmp_path.iterdir():
        assert made.read_text() == (PYTHON / "pliant" / made.name).read_text(), f"{made.name}: run scripts/python stubs"
    assert sorted(made.name for made in tmp_path.iterdir()) == ["_pliant.pyi", "format.pyi"]


def public(thing: object) -> dict[str, object]:
    return {name: getattr(thing, name) for name in vars(thing) if not name.startswith("_")}


@pytest.mark.parametrize("name", [name for name in pliant.__all__ if not name.startswith("__")])
def test_every_public_name_has_a_docstring(name: str) -> None:
    thing = getattr(pliant, name)
    assert inspect.getdoc(thing)
    if inspect.isclass(thing) and thing.__module__.startswith("pliant") and not issubclass(thing, tuple):
        for member, value in public(thing).items():
            if callable(value) or inspect.isdatadescriptor(value):
                is_slot = member in getattr(thing, "__slots__", ())  # documented in the source
                assert is_slot or inspect.getdoc(value), f"{name}.{member}"


def test_the_version_is_that_of_the_library() -> None:
    text = (ROOT / "include" / "pliant" / "version.h").read_text()
    found = re.search(r'PLIANT_VERSION "([^"]+)"', text)
    assert found is not None and pliant.__version__ == pliant.version() == found[1]


@pytest.mark.parametrize("module", ["pliant", "pliant._scene"])
def test_examples_in_docstrings(module: str) -> None:
    __import__(module)
    failed, tried = doctest.testmod(sys.modules[module])
    assert tried > 0 and failed == 0


def test_symbols_of_the_library_stay_inside() -> None:
    from pliant import _pliant

    names = subprocess.run(["nm", "-D", "--defined-only", _pliant.__file__], capture_output=True, text=True)
    if names.returncode != 0:
        pytest.skip("there is no nm")
    exported = [line.split()[-1] for line in names.stdout.splitlines()]
    assert exported == ["PyInit__pliant"]


def test_what_the_module_imports() -> None:
    """Importing costs little beside numpy: no module but those that it needs."""
    program = "import sys, numpy; before = set(sys.modules); import pliant; print(*sorted(set(sys.modules) - before))"
    made = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True).stdout.split()
    assert {"asyncio", "concurrent.futures", "multiprocessing", "numpy.typing", "numpy.testing"}.isdisjoint(made)


RIGHT = """
import numpy as np
import pliant
from pliant.format import Cloth, Object, Scene

cloth: Cloth = {"mesh": pliant.grid_mesh(3, 3, 1, 1), "material": "silk"}
sheet: Object = {"cloth": cloth, "pins": [{"particles": np.array([0])}], "name": "sheet"}
scene: Scene = {"objects": [sheet], "gravity": (0, -9.81, 0), "settings": {"substeps": 5}}
print(pliant.World(scene)["sheet"].particles)
"""
WRONG = {
    '"silk"}': '"paper"}',
    '"pins"': '"pin"',
    '{"substeps": 5}': '{"substeps": "5"}',
    "pliant.World(scene)": "pliant.World(3)",
    ".particles)": ".particle)",
    "print(": "pliant.World(scene).gravity = 3; print(",
    "print(pl": "pliant.Scene().gravity = 3; print(pl",
}


def mypy(text: str, folder: pathlib.Path) -> str:
    api = pytest.importorskip("mypy.api")
    (folder / "program.py").write_text(text)
    out, _, _ = api.run(["--strict", "--cache-dir", str(folder.parent / "mypy"), str(folder / "program.py")])
    return str(out)


def test_types_of_the_format(tmp_path: pathlib.Path) -> None:
    assert "Success" in mypy(RIGHT, tmp_path)
    program = tmp_path / "program.py"
    assert subprocess.run([sys.executable, program], capture_output=True, text=True, check=True).stdout == "9\n"
    for right, wrong in WRONG.items():
        assert RIGHT.count(right) == 1 and "error" in mypy(RIGHT.replace(right, wrong), tmp_path), wrong


def test_types_of_the_format_are_dict_at_run_time() -> None:
    import pliant.format

    assert pliant.format.Cloth is dict
    with pytest.raises(AttributeError):
        getattr(pliant.format, "cloth")


def test_help_lists_the_members_of_scenes() -> None:
    import pydoc

    text = pydoc.render_doc("pliant.format", renderer=pydoc.plaintext)
    assert "class Cloth(TypedDict" in text and "The objects, which move." in text
    records = json.loads(pliant._pliant.scene_schema())["$defs"]
    names = {"".join(part.capitalize() for part in re.split("[-_]", record)) for record in records}
    assert set(dir(pliant.format)) == names and all(f"{name}(" in text or f"{name} = " in text for name in names)
    assert "help(pliant.format)" in pydoc.render_doc("pliant", renderer=pydoc.plaintext)
