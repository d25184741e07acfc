"""Writes the generated files of the package, from the module that can be imported.

    python make_stubs.py [FOLDER]

_pliant.pyi has the signatures of the compiled part, by nanobind's generator; format.pyi the types of the scene format, from
its schema. Without a folder the files of the package are written. A test writes them into a folder of its own and compares.
"""

from __future__ import annotations

import json
import keyword
import pathlib
import re
import subprocess
import sys
import tempfile
import textwrap
from typing import Any

HEAD = "# Made by scripts/python stubs; do not edit.\n"

FORMAT = '''"""Types of the scene format (docs/reference/scene-format.md): what the dicts of a Scene hold.

They are for editors and type checkers: `scene: pliant.format.Scene = {...}`. At run time each is dict.
"""

from typing import Any, Literal, Sequence, TypedDict

from typing_extensions import Required

from ._types import AnyArray, MeshLike

'''

# The functions that refuse attributes: with them in a stub, type checkers would take any attribute.
REFUSES = re.compile(r'    def __(?:set|del)attr__\(self, .*\):\n        """Implement .*"""\n\n')

# Where the format has one of these, arrays of the caller may stand.
FROM_MEMORY = {"mesh": "MeshLike", "tetrahedra": "MeshLike", "points": "AnyArray"}


def class_name(definition: str) -> str:
    return "".join(part.capitalize() for part in definition.replace("-", "_").split("_"))


def alternatives(types: list[str]) -> str:
    return " | ".join(dict.fromkeys(types))


def list_type(schema: dict[str, Any]) -> str:
    item = type_of(schema["items"]) if "items" in schema else "Any"
    is_numeric = item in ("float", "int") or item.startswith("Sequence[float]")
    return f"Sequence[{item}]" + (" | AnyArray" if is_numeric else "")


def type_of(schema: dict[str, Any]) -> str:
    """The type of a value, as text."""
    if "$ref" in schema:
        definition = schema["$ref"].rsplit("/", 1)[1]
        array = FROM_MEMORY.get(definition)
        return class_name(definition) + (f" | {array}" if array else "")
    for key in ("anyOf", "oneOf"):
        if key in schema and "properties" not in schema:
            return alternatives([type_of(one) for one in schema[key]])
    if "enum" in schema:
        return f"Literal[{', '.join(repr(value) for value in schema['enum'])}]"
    if "const" in schema:
        return f"Literal[{schema['const']!r}]"
    kind = schema.get("type")
    simple = {"number": "float", "integer": "int", "boolean": "bool", "string": "str", "object": "dict[str, Any]"}
    return list_type(schema) if kind == "array" else simple.get(str(kind), "Any")


def member_type(schema: dict[str, Any], name: str) -> str:
    text = type_of(schema["properties"][name])
    return f"Required[{text}]" if name in schema.get("required", []) else text


def docstring(text: str, indent: str) -> list[str]:
    text = text.replace("\\", "\\\\").replace('"""', "'''")
    lines = textwrap.wrap(text, 116 - len(indent), break_on_hyphens=False)
    if not lines:
        return []
    if lines[-1].endswith('"'):
        lines[-1] += " "
    return [f'{indent}"""' + lines[0], *(indent + line for line in lines[1:-1]), indent + lines[-1] + '"""'] if (
        len(lines) > 1
    ) else [f'{indent}"""{lines[0]}"""']


def record(definition: str, schema: dict[str, Any]) -> list[str]:
    """A TypedDict, as a class where the names of its members allow it."""
    name = class_name(definition)
    members = {key: value for key, value in schema.get("properties", {}).items() if not key.startswith("$")}
    if all(member.isidentifier() and not keyword.iskeyword(member) for member in members):
        lines = [f"class {name}(TypedDict, total=False):", *docstring(schema.get("description", ""), "    "), ""]
        for member, one in members.items():
            lines += [f"    {member}: {member_type(schema, member)}", *docstring(one.get("description", ""), "    ")]
        return lines
    lines = [f"{name} = TypedDict(", f'    "{name}",', "    {"]
    for member, one in members.items():
        comment = textwrap.wrap(one.get("description", ""), 108, break_on_hyphens=False)
        lines += [*(f"        # {line}" for line in comment), f'        "{member}": {member_type(schema, member)!r},']
    return [*lines, "    },", "    total=False,", ")", *docstring(schema.get("description", ""), "")]


def format_types() -> str:
    from pliant._pliant import scene_schema

    definitions = json.loads(scene_schema())["$defs"]
    blocks = ["\n".join(record(definition, schema)) for definition, schema in definitions.items()]
    return FORMAT + "\n\n".join(blocks) + "\n"


def main() -> None:
    here = pathlib.Path(__file__).absolute().parents[1] / "pliant"
    folder = pathlib.Path(sys.argv[1]).absolute() if len(sys.argv) > 1 else here
    stub = folder / "_pliant.pyi"
    command = [sys.executable, "-m", "nanobind.stubgen", "-q", "-m", "pliant._pliant", "-o", str(stub)]
    subprocess.run(command, check=True, cwd=tempfile.gettempdir())  # not where ./pliant is the sources
    text = REFUSES.sub("", stub.read_text(encoding="utf-8")).rstrip()
    stub.write_text(HEAD + text + "\n", encoding="utf-8")
    (folder / "format.pyi").write_text(HEAD + format_types(), encoding="utf-8")


if __name__ == "__main__":
    main()
