"""The exception of the library."""

from __future__ import annotations

from typing import Any


class Error(ValueError):
    """What is wrong, where, and what to do about it.

    Every part may be empty; ``line`` and ``column`` count from 1, and 0 means none.
    """

    problem: str
    """What is wrong."""
    advice: str
    """What to do."""
    file: str
    """Path of the file."""
    line: int
    """Line in the file."""
    column: int
    """Byte within the line."""
    object: str
    """Name of the object of the scene."""
    element: str
    """Part concerned: "vertex 12", or a JSON pointer into the scene, "/objects/0/mesh"."""

    def __init__(
        self,
        problem: str,
        advice: str = "",
        *,
        file: str = "",
        line: int = 0,
        column: int = 0,
        object: str = "",
        element: str = "",
    ) -> None:
        self.problem, self.advice = problem, advice
        self.file, self.line, self.column = file, line, column
        self.object, self.element = object, element
        super().__init__(self._text())

    def _text(self) -> str:
        place = self.file
        if self.line:
            place = (f"{place}:" if place else "line ") + str(self.line) + (f":{self.column}" if self.column else "")
        what = ", ".join(part for part in (self.object and f"object '{self.object}'", self.element) if part)
        where = ": ".join(part for part in (place, what) if part)
        return (f"{where}: " if where else "") + self.problem + (f"; {self.advice}" if self.advice else "")

    def __reduce__(self) -> Any:
        places = {
            "file": self.file,
            "line": self.line,
            "column": self.column,
            "object": self.object,
            "element": self.element,
        }
        return _error, (self.problem, self.advice, places)


def _error(problem: str, advice: str, places: dict[str, Any]) -> Error:
    return Error(problem, advice, **places)
