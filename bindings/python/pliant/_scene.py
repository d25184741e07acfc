"""Scenes: the dict of the scene format, with numpy arrays where it has meshes and points."""

from __future__ import annotations

import copy
import json
import math
import os
import stat
from typing import TYPE_CHECKING, Any, Callable, Iterable, Mapping, Union

import numpy as np

from . import _pliant
from ._calls import is_unicode, no_scene_attribute
from ._errors import Error
from ._types import Finding

SceneLike = Union["Scene", Mapping[str, Any], str, "os.PathLike[str]"]
"""What a World is made from: a Scene, a dict of the scene format, or the path of a scene file."""

Vary = Union[Mapping[str, Any], Callable[["Scene", int], Any]]
"""How the worlds of a Batch differ: {JSON pointer: a value for each}, or a function that changes a copy of a scene."""

_KINDS = (
    "cloth", "soft_body", "rope", "rod", "liquid", "grains", "gas", "tracers", "particles", "bodies", "urdf",
)  # fmt: skip
_SHAPES = ("plane", "sphere", "capsule", "box", "mesh")
_DEEPEST = 60
_ATTRIBUTES = frozenset(("arrays", "folder", "file", "_known"))


def _members() -> set[str]:
    """The members that a scene may have."""
    return set(json.loads(_pliant.scene_schema())["$defs"]["scene"]["properties"])


def _step(pointer: str, key: Any) -> str:
    return f"{pointer}/" + str(key).replace("~", "~0").replace("/", "~1")


def _steps(pointer: str) -> list[str]:
    if not isinstance(pointer, str):
        raise TypeError("a JSON pointer is a str, such as '/settings/substeps'")
    if not pointer.startswith("/"):
        raise Error(f"'{pointer}' is no JSON pointer", "begin with '/', as in /settings/substeps")
    return [step.replace("~1", "/").replace("~0", "~") for step in pointer[1:].split("/")]


class _Arrays:
    """The arrays of a scene by name, as C++ takes them."""

    def __init__(self, named: Mapping[str, Any]) -> None:
        self.meshes: dict[str, Any] = {}
        self.tetrahedra: dict[str, Any] = {}
        self.points: dict[str, Any] = {}
        for name, value in named.items():
            self._sort(name, value)

    def _sort(self, name: str, value: Any) -> None:
        if not isinstance(name, str):
            raise TypeError("names of arrays are str")
        if not isinstance(value, (tuple, list)) or len(value) != 2:
            self.points[name] = value
        elif np.ndim(value[1]) == 2 and np.shape(value[1])[1] == 4:
            self.tetrahedra[name] = value
        else:
            self.meshes[name] = value

    def add(self, kind: str, pointer: str, value: Any) -> dict[str, str]:
        """Keeps an array that stands in the dict, and returns the reference that replaces it."""
        getattr(self, kind)[pointer] = value
        return {"array": pointer}

    @property
    def any(self) -> bool:
        return bool(self.meshes or self.tetrahedra or self.points)


def _plain_number(value: Any, pointer: str) -> Any:
    if isinstance(value, float) and not math.isfinite(value):
        raise Error(f"this is {value}", "the scene format has finite numbers alone", element=pointer)
    return value


def _plain_text(value: str, what: str, pointer: str) -> str:
    if not is_unicode(value):
        raise Error(f"{what} {value!r} is not valid Unicode", "remove its lone surrogates", element=pointer)
    return value


def _is_pair(value: Any) -> bool:
    return isinstance(value, (tuple, list)) and len(value) == 2


def _plain_items(value: Mapping[Any, Any], arrays: _Arrays, pointer: str, depth: int) -> dict[str, Any]:
    plain: dict[str, Any] = {}
    for key, item in value.items():
        if not isinstance(key, str):
            raise Error(f"the key {key!r} is no str", "names of members are str", element=pointer)
        _plain_text(key, "the key", pointer)
        at = _step(pointer, key)
        if key in ("mesh", "skin") and _is_pair(item):
            plain[key] = arrays.add("meshes", at, item)
        elif key == "tetrahedra" and _is_pair(item):
            plain[key] = arrays.add("tetrahedra", at, item)
        elif key == "positions" and isinstance(item, np.ndarray):
            plain[key] = arrays.add("points", at, item)
        else:
            plain[key] = _plain(item, arrays, at, depth)
    return plain


def _plain(value: Any, arrays: _Arrays, pointer: str = "", depth: int = 0) -> Any:
    """The value as JSON can hold it; arrays that the format takes from memory go to `arrays`."""
    if depth > _DEEPEST:
        raise Error("this is nested too deeply", "scenes never need so many levels", element=pointer)
    if isinstance(value, Mapping):
        return _plain_items(value, arrays, pointer, depth + 1)
    if isinstance(value, np.ndarray):
        if np.any(getattr(value, "mask", False)):
            raise Error("this array has masked values", "fill or remove them", element=pointer)
        if value.dtype.kind not in "biuf":
            raise Error(f"this is an array of {value.dtype}", "pass numbers", element=pointer)
        if value.dtype.kind == "f" and not np.isfinite(value).all():
            raise Error("this array has values that are not finite", "replace them", element=pointer)
        return value.tolist()
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, str):
        return _plain_text(value, "the text", pointer)
    if isinstance(value, (bool, int, float)) or value is None:
        return _plain_number(value, pointer)
    if isinstance(value, (list, tuple, range)):
        return [_plain(item, arrays, _step(pointer, i), depth + 1) for i, item in enumerate(value)]
    raise Error(f"this is a {type(value).__name__}", "a scene has dicts, lists, numbers, str and bool", element=pointer)


def files_of(plain: Any) -> list[str]:
    """The paths of meshes and robots that a plain scene names."""
    if isinstance(plain, list):
        return [path for item in plain for path in files_of(item)]
    if not isinstance(plain, dict):
        return []
    own = [plain["file"]] if isinstance(plain.get("file"), str) else []
    return own + [path for item in plain.values() for path in files_of(item)]


def _text(scene: Mapping[str, Any], arrays: _Arrays) -> tuple[str, bool]:
    """The text that C++ reads, and whether it says all: it names no files or arrays, which can change beside it."""
    plain = _plain(scene, arrays)
    plain.setdefault("objects", [])
    return json.dumps(plain, ensure_ascii=False, allow_nan=False), not arrays.any and not files_of(plain)


def copied(value: Any, depth: int = 0) -> Any:
    """A copy of dicts, lists and tuples that shares arrays."""
    if depth > _DEEPEST:
        raise Error("this is nested too deeply", "scenes never need so many levels")
    if isinstance(value, Mapping):
        return {key: copied(item, depth + 1) for key, item in value.items()}
    if isinstance(value, list):
        return [copied(item, depth + 1) for item in value]
    if type(value) is tuple:
        return tuple(copied(item, depth + 1) for item in value)
    return value


def _free_name(kind: str, taken: Iterable[Any]) -> str:
    names = set(taken)
    name, number = kind, 2
    while name in names:
        name, number = f"{kind}_{number}", number + 1
    return name


def _the_kind(members: Mapping[str, Any], kinds: tuple[str, ...], what: str) -> str:
    given = [kind for kind in kinds if kind in members]
    if len(given) != 1:
        said = "none" if not given else " and ".join(given)
        raise Error(f"{what} is given {said} of {', '.join(kinds)}", "give it exactly one")
    return given[0]


def _named(members: Mapping[str, Any], kinds: tuple[str, ...], what: str, taken: list[Any]) -> dict[str, Any]:
    kind = _the_kind(members, kinds, what)
    name = members.get("name")
    if name is None:
        name = _free_name({"bodies": "body"}.get(kind, kind), taken)
    elif not isinstance(name, str):
        raise TypeError("a name is a str")
    elif name in taken:
        raise Error(f"the name '{name}' is taken", "names differ", object=name)
    return {"name": name, **{key: value for key, value in members.items() if key != "name"}}


class Scene(dict[str, Any]):
    """A description of a simulation: a dict of the scene format, with arrays in it.

    Members are those of docs/reference/scene-format.md: ``frame_time``, ``gravity``, ``settings``, ``objects``,
    ``colliders``, ... Where the format has a mesh, ``(vertices, triangles)`` may stand; where it has tetrahedra,
    ``(points, tetrahedra)``; for ``positions`` an array of shape (n, 3). Other arrays count as lists. Vertices are
    taken as they are, so indices are those of the caller. The scene is checked when a World is made from it.

    ``description`` is a dict to start from, which is copied (arrays are shared); members given by name replace its own.
    ``arrays``: meshes and points by name, for references ``{"array": "NAME"}``. ``folder``: where relative paths of
    meshes begin.

    >>> scene = Scene(frame_time=1 / 60, gravity=(0, -9.81, 0))
    >>> scene.add(rope={"line": {"from": [0, 0, 0], "to": [1, 0, 0], "points": 10}}, pins=[{"particles": [0]}])
    'rope'
    """

    arrays: dict[str, Any]
    """Meshes and points by name."""
    folder: str
    """Where relative paths begin."""
    file: str
    """Path of the file that it was read from; named by errors. Empty: none."""

    def __init__(
        self,
        description: Mapping[str, Any] | None = None,
        /,
        *,
        arrays: Mapping[str, Any] | None = None,
        folder: str | os.PathLike[str] = "",
        **members: Any,
    ) -> None:
        if description is not None and not isinstance(description, Mapping):
            raise TypeError("a Scene is made from a dict; Scene.read() reads a file, Scene.parse() text")
        super().__init__(copied(description or {}))
        self.update(copied(members))
        inherited = description if isinstance(description, Scene) else None
        self.arrays = dict(inherited.arrays if inherited is not None else {})
        self.arrays.update(arrays or {})
        self.folder = os.fspath(folder) or (inherited.folder if inherited is not None else "")
        self.file = inherited.file if inherited is not None else ""
        self._known: tuple[str, str, _pliant.Description] | None = None  # text, folder, what they say

    if not TYPE_CHECKING:  # type checkers would take any attribute

        def __setattr__(self, name: str, value: Any) -> None:
            if name in _ATTRIBUTES or (type(self) is not Scene and name not in _members()):
                super().__setattr__(name, value)
            else:
                raise AttributeError(no_scene_attribute(name, name in _members()))

    @classmethod
    def read(cls, path: str | os.PathLike[str], arrays: Mapping[str, Any] | None = None) -> Scene:
        """Reads a scene file. Raises Error with file, line and column if it is wrong."""
        return cls._read(path, arrays)[0]

    @classmethod
    def _read(
        cls, path: str | os.PathLike[str], arrays: Mapping[str, Any] | None = None
    ) -> tuple[Scene, _pliant.Description]:
        name = os.fspath(path)
        if not isinstance(name, str):
            raise TypeError("a path is a str or os.PathLike")
        if not is_unicode(name):
            raise Error(f"the path {name!r} is not valid Unicode", "pass the path of a scene file")
        try:
            if not stat.S_ISREG(os.stat(name).st_mode):  # opening a pipe would wait for its writer
                raise Error("not a regular file", "pass the path of a scene file", file=name)
            with open(name, encoding="utf-8") as file:
                text = file.read()
        except (OSError, UnicodeError) as error:
            words = error.strerror if isinstance(error, OSError) else "is no UTF-8"
            raise Error(f"cannot be read: {words}", "pass the path of a scene file", file=name) from error
        return cls._of_text(text, name, os.path.dirname(name), arrays)

    @classmethod
    def parse(
        cls, text: str, folder: str | os.PathLike[str] = "", arrays: Mapping[str, Any] | None = None
    ) -> Scene:
        """Reads a scene from JSON text; paths of meshes are relative to `folder`."""
        if not isinstance(text, str):
            raise TypeError("the text of a scene is a str")
        return cls._of_text(text, "", os.fspath(folder), arrays)[0]

    @classmethod
    def _of_text(
        cls, text: str, name: str, folder: str, arrays: Mapping[str, Any] | None
    ) -> tuple[Scene, _pliant.Description]:
        named = _Arrays(arrays or {})
        # C++ reads it first: its errors have line and column.
        known = _pliant.describe(text, name, folder, named.meshes, named.tetrahedra, named.points, True)
        scene = cls(json.loads(text), arrays=arrays, folder=folder)
        scene.file = name
        plain, says_all = _text(scene, named)
        if says_all:
            scene._known = (plain, folder, known)
        return scene, known

    def _add(self, list_name: str, members: dict[str, Any]) -> str:
        things = self.setdefault(list_name, [])
        if not isinstance(things, list):
            what = type(things).__name__
            raise Error(f'"{list_name}" is a {what}', "it is a list of dicts", element=f"/{list_name}")
        things.append(members)
        return str(members["name"])

    def _names(self, list_name: str) -> list[Any]:
        things = self.get(list_name) or []
        if not isinstance(things, list):
            return []
        return [thing.get("name") for thing in things if isinstance(thing, Mapping)]

    def add(self, **members: Any) -> str:
        """Adds an object and returns its name.

        One member says what it is: cloth, soft_body, rope, rod, liquid, grains, gas, tracers, particles, bodies or
        urdf. Others are those of an object in the scene format: name, pins, attachments, thickness, ...
        """
        return self._add("objects", copied(_named(members, _KINDS, "an object", self._names("objects"))))

    def add_collider(self, **members: Any) -> str:
        """Adds a collider and returns its name. One member says its shape: plane, sphere, capsule, box or mesh."""
        return self._add("colliders", copied(_named(members, _SHAPES, "a collider", self._names("colliders"))))

    def lookup(self, pointer: str) -> Any:
        """The value at a JSON pointer, such as "/objects/0/cloth/material". Raises Error if there is none."""
        at: Any = self
        for step in _steps(pointer):
            if isinstance(at, list) and step.isdecimal() and int(step) < len(at):
                at = at[int(step)]
            elif isinstance(at, Mapping) and step in at:
                at = at[step]
            else:
                raise Error("there is no such member", "see what is above it", element=pointer)
        return at

    def assign(self, pointer: str, value: Any) -> None:
        """Sets the value at a JSON pointer; "-" appends to a list. Members on the way that are missing are made.

        The value is copied (arrays are shared).
        """
        steps, value = _steps(pointer), copied(value)
        at: Any = self
        for i, step in enumerate(steps):
            last = i + 1 == len(steps)
            if isinstance(at, list):
                if step == "-":
                    at.append(None if last else {})
                elif not step.isdecimal() or int(step) >= len(at):
                    raise Error(f"there is no item '{step}' to set", f"the list has {len(at)}", element=pointer)
                index = len(at) - 1 if step == "-" else int(step)
                if last:
                    at[index] = value
                else:
                    at = at[index]
            elif isinstance(at, dict):
                if last:
                    at[step] = value
                else:
                    at = at.setdefault(step, [] if steps[i + 1] == "-" else {})
            else:
                raise Error(f"there is no member '{step}' to set", "above is no dict and no list", element=pointer)

    def check(self, seconds: float = 0) -> list[Finding]:
        """Findings of the scene: (grave, message, advice). A World refuses scenes with grave ones.

        `seconds`: also runs trials for about so long, as ``pliant check`` does, and advises settings [s].
        Raises Error if the scene does not follow the format.
        """
        return self.compiled().check(seconds)

    def describe(self) -> str:
        """A line about the scene and one for each object and collider, for people to read."""
        return self.compiled().describe()

    def to_json(self, indent: int | None = None) -> str:
        """The scene as JSON text. Arrays in it become references ``{"array": POINTER}``; see extract()."""
        return json.dumps(_plain(self, _Arrays({})), indent=indent, ensure_ascii=False, allow_nan=False)

    def extract(self) -> tuple[dict[str, Any], dict[str, Any]]:
        """The scene as (plain dict, arrays by name), so that Scene(plain, arrays=arrays) is the same scene."""
        arrays = _Arrays(self.arrays)
        plain = _plain(self, arrays)
        return plain, {**arrays.meshes, **arrays.tetrahedra, **arrays.points}

    def write(self, path: str | os.PathLike[str]) -> None:
        """Writes a scene file. Raises Error if the scene has arrays, which a file cannot hold."""
        plain, arrays = self.extract()
        if arrays:
            raise Error(
                "the scene has arrays, which a scene file cannot hold",
                "write meshes by write_mesh() and refer to the files, or pickle the Scene",
                file=os.fspath(path),
            )
        with open(path, "w", encoding="utf-8") as file:
            json.dump(plain, file, indent=2, ensure_ascii=False, allow_nan=False)
            file.write("\n")

    def compiled(self) -> _pliant.Description:
        """The scene as C++ has read it, from which World and Batch are made. Raises Error if it is wrong."""
        arrays = _Arrays(self.arrays)
        text, says_all = _text(self, arrays)
        if says_all and self._known is not None and self._known[:2] == (text, self.folder):
            return self._known[2]
        try:
            made = _pliant.describe(text, "", self.folder, arrays.meshes, arrays.tetrahedra, arrays.points, True)
        except Error as error:  # lines of the text that was made here say nothing
            raise Error(
                error.problem, error.advice, file=error.file or self.file, object=error.object, element=error.element
            ) from None
        self._known = (text, self.folder, made) if says_all else None
        return made

    def copy(self) -> Scene:
        """A copy of dicts and lists that shares arrays."""
        return type(self)(self)

    def __copy__(self) -> Scene:
        return self.copy()

    def __deepcopy__(self, memo: dict[int, Any]) -> Scene:
        return type(self)(copy.deepcopy(dict(self), memo), arrays=copy.deepcopy(self.arrays, memo), folder=self.folder)

    def __reduce__(self) -> Any:
        return _scene, (dict(self), self.arrays, self.folder, self.file)

    def __repr__(self) -> str:
        objects, colliders = (len(self.get(name) or []) for name in ("objects", "colliders"))
        return f"<pliant.Scene: {objects} objects, {colliders} colliders>"


def _scene(description: dict[str, Any], arrays: dict[str, Any], folder: str, file: str) -> Scene:
    scene = Scene(description, arrays=arrays, folder=folder)
    scene.file = file
    return scene


def as_scene(scene: SceneLike) -> Scene:
    """A Scene of what a caller gave."""
    if isinstance(scene, Scene):
        return scene
    if isinstance(scene, Mapping):
        return Scene(scene)
    if isinstance(scene, (str, os.PathLike)):
        return Scene.read(scene)
    raise TypeError("a scene is a Scene, a dict of the scene format, or the path of a scene file")


def as_description(scene: SceneLike) -> _pliant.Description:
    """What C++ makes a World from."""
    if isinstance(scene, (str, os.PathLike)):
        return Scene._read(scene)[1]
    return scene if isinstance(scene, _pliant.Description) else as_scene(scene).compiled()


def one_thing(
    list_name: str, members: dict[str, Any], objects: list[str], colliders: list[str]
) -> _pliant.Description:
    """The description of one object or collider that is to be added to a World with these names."""
    if list_name == "objects":
        named = _named(members, _KINDS, "an object", list(objects))
    else:
        named = _named(members, _SHAPES, "a collider", list(colliders))
    return Scene({list_name: [named]}).compiled()


def _varied(scene: Scene, i: int, vary: Vary) -> Scene:
    one = scene.copy()
    if isinstance(vary, Mapping):
        for pointer, values in vary.items():
            one.assign(pointer, values[i])
    elif vary(one, i) is not None:
        raise TypeError("the function of vary returned something: change the scene that it is given, and return nothing")
    return one


def _of_world(i: int, scene: Scene) -> _pliant.Description:
    try:
        return scene.compiled()
    except Error as error:
        raise Error(
            f"of world {i}: {error.problem}", error.advice, file=error.file, object=error.object, element=error.element
        ) from None


def variants(scene: SceneLike, n: int, vary: Vary | None) -> list[_pliant.Description]:
    """What the worlds of a Batch are made from: one description for all, or one for each."""
    if vary is None:
        return [as_description(scene)]
    if not isinstance(vary, Mapping) and not callable(vary):
        raise TypeError("vary is a dict {JSON pointer: values}, or a function (scene, i)")
    if isinstance(vary, Mapping):
        for pointer, values in vary.items():
            if not hasattr(values, "__len__") or isinstance(values, (str, bytes)):
                raise TypeError(f"the values of '{pointer}' are no list")
            if len(values) != n:
                raise Error(f"there are {len(values)} values for {n} worlds", "give one for each", element=pointer)
    base = as_scene(scene)
    return [_of_world(i, _varied(base, i, vary)) for i in range(n)]
