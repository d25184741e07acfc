"""Writes pliant/_pliant.pyi, by nanobind's generator, from the module that can be imported.

    python make_stubs.py [FOLDER]

Without a folder the files of the package are written. A test writes them into a folder of its own and compares.
"""

import pathlib
import subprocess
import sys


def main() -> None:
    here = pathlib.Path(__file__).parent / "pliant"
    folder = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else here
    stub = folder / "_pliant.pyi"
    command = [sys.executable, "-m", "nanobind.stubgen", "-q", "-m", "pliant._pliant", "-o", str(stub)]
    subprocess.run(command, check=True)
    text = stub.read_text(encoding="utf-8")
    head = "# Made by scripts/python stubs; do not edit.\n"
    stub.write_text(head + text.rstrip() + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
