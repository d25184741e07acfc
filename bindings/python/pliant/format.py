# Types of the scene format, for editors and type checkers: see format.pyi. At run time each is dict.

import os
import re
import sys
import types
from typing import Any, List


class _Format(types.ModuleType):
    @property
    def __doc__(self) -> str:  # type: ignore[override]
        """The types with their fields, for help(): the text of the stub, read when it is asked for."""
        with open(os.path.join(os.path.dirname(__file__), "format.pyi"), encoding="utf-8") as file:
            _, head, rest = file.read().split('"""', 2)
        return head + rest[rest.index("\nclass ") :].rstrip()

    def __dir__(self) -> List[str]:
        return re.findall(r"^(?:class )?(\w+)(?: = |\()TypedDict\b", self.__doc__, re.MULTILINE)


def __getattr__(name: str) -> Any:
    if name.startswith("_") or not name[:1].isupper():
        raise AttributeError(f"module 'pliant.format' has no attribute '{name}'")
    return dict


sys.modules[__name__].__class__ = _Format
