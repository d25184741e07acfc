"""What errors say of calls with wrong arguments and of attributes that cannot be set. The compiled part calls this."""

from __future__ import annotations

import ast
import difflib
import numbers
from typing import Any, Callable, Mapping, Sequence

_EXPECTED = {
    "float": "a number",
    "int": "a whole number",
    "str": "a str",
    "bool": "True or False",
    "bytes": "bytes",
    "None": "None",
    "AnyArray": "an array of numbers",
    "FloatArray": "an array of float32",
    "IntsLike": "a list or array of whole numbers",
    "VectorLike": "a list or array of numbers",
    "VectorsLike": "an array of shape (n, 3), or a list of vectors",
    "MeshLike": "(vertices, triangles)",
    "Any": "a number, or an array of them",
    "SceneLike": "a Scene, a dict of the scene format, or the path of a scene file",
}
_NAMED = {
    "body": "the name of a body, or its index",
    "joint": "the name of a joint, or its index",
}
_INT_MOST = 2**31 - 1


def shown(value: Any) -> str:
    """A value and its type, short."""
    if value is None:
        return "None"
    name = type(value).__name__
    article = "an" if name[0] in "aeiouAEIO" or name == "ndarray" else "a"
    if isinstance(value, (str, bytes, bool, int, float)) and len(repr(value)) <= 40:
        return f"{value!r}, {article} {name}"
    return f"{article} {name}"


def is_unicode(text: str) -> bool:
    """False if UTF-8 cannot hold a text, for its lone surrogates."""
    try:
        text.encode()
    except UnicodeEncodeError:
        return False
    return True


def wrong_type(what: str, value: Any, expected: str) -> str:
    """The text of a TypeError."""
    return f"{what} is {shown(value)}; pass {expected}"


def _alternatives(annotation: str) -> list[str]:
    return [part.rsplit(".", 1)[-1] for part in annotation.split(" | ")]


def _fits_one(value: Any, kind: str) -> bool:
    if kind == "None" or value is None:
        return kind == "None" and value is None
    if kind == "float":
        return isinstance(value, numbers.Real) and not isinstance(value, bool)
    if kind == "int":
        return isinstance(value, numbers.Integral) and abs(int(value)) <= _INT_MOST
    if kind in ("str", "bool", "bytes", "dict", "list"):
        return type(value).__name__ == kind or (kind == "bool" and type(value).__name__ == "bool_")
    known = {"State", "Report", "Description", "Object", "Collider", "MeshCollider"}
    return kind not in known or any(base.__name__ == kind for base in type(value).__mro__)


def _words(annotation: str) -> str:
    words = [_EXPECTED.get(kind, f"a {kind.split('[')[0]}") for kind in _alternatives(annotation)]
    return " or ".join(words)


class _Parameters:
    """The parameters of a function by its signature: names, annotations, and which need no value."""

    def __init__(self, signature: str) -> None:
        text = signature.replace("\\0", "...").strip().rstrip(":")
        parsed = ast.parse(text + ": ...").body[0]
        assert isinstance(parsed, ast.FunctionDef)
        every = [*parsed.args.posonlyargs, *parsed.args.args, *parsed.args.kwonlyargs]
        self.names = [one.arg for one in every]
        self.annotations = {one.arg: ast.unparse(one.annotation) for one in every if one.annotation is not None}
        self.free = set(self.names[len(self.names) - len(parsed.args.defaults) :]) if parsed.args.defaults else set()

    def list(self) -> str:
        names = [name for name in self.names if name != "self"]
        return ", ".join(names) if names else "no argument"


def _problem(of: _Parameters, given: Sequence[Any], named: Mapping[str, Any]) -> str | None:
    if len(given) > len(of.names):
        extra = len(given) - len(of.names)
        return f"takes {of.list()}, and was given {extra} argument{'s' if extra > 1 else ''} more"
    values = dict(zip(of.names, given))
    for name, value in named.items():
        if name not in of.names:
            close = difflib.get_close_matches(name, of.names, 1)
            return f"has no argument '{name}'" + (f"; did you mean '{close[0]}'?" if close else f"; it takes {of.list()}")
        if name in values:
            return f"was given '{name}' twice"
        values[name] = value
    for name in of.names:
        if name not in values and name not in of.free:
            return f"needs '{name}'; it takes {of.list()}"
    for name, value in values.items():
        if isinstance(value, str) and not is_unicode(value):
            return f"{name} is {shown(value)} that is not valid Unicode; remove its lone surrogates"
        kinds = of.annotations.get(name)
        if name == "self" or kinds is None or any(_fits_one(value, kind) for kind in _alternatives(kinds)):
            continue
        is_large = isinstance(value, numbers.Integral) and not isinstance(value, bool)
        expected = _NAMED.get(name, _words(kinds))
        return wrong_type(name, value, f"{expected} of at most 32 bits" if is_large and "int" in kinds else expected)
    return None


def _called(function: Callable[..., Any]) -> str:
    name = getattr(function, "__qualname__", function.__name__)
    owner, _, last = name.rpartition(".")
    if last == "__init__":
        return f"{owner}()"
    if last == "__getitem__":
        return f"{owner}[...]"
    return f"{name}()"


def explain(function: Callable[..., Any], given: Sequence[Any], named: Mapping[str, Any]) -> str:
    """Which argument of a call is wrong, and what is expected."""
    called = _called(function)
    try:
        of = _Parameters(function.__nb_signature__[0][0])  # type: ignore[attr-defined]
        problem = _problem(of, given, named)
    except (SyntaxError, AttributeError, IndexError, AssertionError):
        return f"{called} was given arguments of wrong types; see its docstring"
    if problem is None:
        kinds = ", ".join(shown(value) for value in [*given[1:], *named.values()])
        return f"{called} was given arguments of wrong types: {kinds}; it takes {of.list()}"
    return f"{called} {problem}" if problem.split(" ")[0] in ("takes", "has", "was", "needs") else f"{called}: {problem}"


_INSTEAD = {
    "World": "the description is read when a World is made: change the Scene before, or the World by edit(), add() and "
    "remove()",
    "Object": "change it by its functions, or by World.edit()",
    "Collider": "move it by set_pose() or teleport()",
    "MeshCollider": "move it by set_pose(), set_positions() or teleport()",
    "Batch": "change the scene before the Batch is made, or batch.worlds",
    "BatchObject": "change it by its functions, or batch.worlds",
    "State": "a State is a value that a World restores",
    "Report": "a Report says what a step did",
}


def no_attribute(kind: type, name: str) -> str:
    """Why an attribute cannot be set, and what to do instead."""
    owner = kind.__name__
    article = "an" if owner[0] in "AEIO" else "a"
    setter = f"set_{name}" if hasattr(kind, f"set_{name}") else f"set_{name.rstrip('s')}"
    if hasattr(kind, setter):
        instead = f"call {setter}()"
    else:
        instead = _INSTEAD.get(owner, "use its functions")
    if not hasattr(kind, name):
        return f"{article} {owner} has no attribute '{name}'; {instead}"
    is_function = callable(getattr(kind, name))
    if owner == "World" and not is_function:
        instead = "restore() puts a World at another State"
    return f"'{name}' of {article} {owner} " + ("is a function" if is_function else "can only be read") + f"; {instead}"


_MAKES = {
    "Object": 'world["NAME"]',
    "Collider": 'world.collider("NAME")',
    "MeshCollider": 'world.mesh_collider("NAME")',
    "BatchObject": 'batch["NAME"]',
    "State": "World.state()",
    "Report": "World.step()",
    "Writer": "World.writer()",
    "Edit": "World.edit()",
    "Gauges": "World.gauges()",
    "_Frames": "World.frames()",
    "Description": "Scene.compiled()",
}


def no_construction(kind: type) -> str:
    """Why a class cannot be called, and what makes its objects."""
    names = [base.__name__ for base in kind.__mro__ if base.__name__ in _MAKES]
    name = names[0] if names else kind.__name__
    article = "an" if name[0] in "AEIO" else "a"
    return f"{article} {name} cannot be made by a call; {_MAKES.get(name, 'the package')} returns one"


def no_scene_attribute(name: str, is_member: bool) -> str:
    """The same of a Scene."""
    if is_member:
        return f"a Scene is a dict, in which '{name}' is an item; write scene['{name}'] = ..."
    return f"a Scene has no attribute '{name}'; it is a dict of the scene format: write scene['NAME'] = ..., or assign()"
