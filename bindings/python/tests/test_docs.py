"""The examples of the docs, and those in ../examples, run, and mypy passes over them."""

from __future__ import annotations

import pathlib
import re
import subprocess
import sys

import pytest
from conftest import ROOT

PAGES = ["README.md", "docs/guide/python.md", "docs/guide/researchers.md"]
EXAMPLES = sorted((ROOT / "bindings" / "python" / "examples").glob("*.py"))


def scripts(page: str) -> dict[str, str]:
    """The scripts of a page: blocks that begin with their file's name, and the others together."""
    text = (ROOT / page).read_text(encoding="utf-8")
    found = {"page.py": ""}
    for block in re.findall(r"```python\n(.*?)```", text, re.DOTALL):
        name = re.match(r"# (\w+\.py)\n", block)
        if name is None:
            found["page.py"] += block + "\n"
        else:
            found[name[1]] = block
    return found


def run(program: pathlib.Path, folder: pathlib.Path) -> str:
    done = subprocess.run([sys.executable, str(program)], cwd=folder, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.mark.parametrize("page", PAGES)
def test_pages(page: str, tmp_path: pathlib.Path) -> None:
    api = pytest.importorskip("mypy.api")
    for name, text in scripts(page).items():
        program = tmp_path / name
        program.write_text(text, encoding="utf-8")
        assert run(program, tmp_path) or (tmp_path / "row_0.json").exists()
        out, _, code = api.run(["--cache-dir", str(tmp_path / "mypy"), str(program)])
        assert code == 0, out


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: path.stem)
def test_examples(example: pathlib.Path, tmp_path: pathlib.Path) -> None:
    out = run(example, tmp_path)
    assert out
    if example.stem == "towel":
        numbers = [float(number) for number in re.findall(r"\d+\.\d+", out)]
        low, high, grip, bears, weighs = numbers
        assert low > 0.45 and high < 1
        assert grip == pytest.approx(3, rel=0.05) and bears == pytest.approx(weighs, rel=0.02)
