"""Types of the scene format, for editors and type checkers: see format.pyi. At run time each is dict."""

from typing import Any


def __getattr__(name: str) -> Any:
    if name.startswith("_") or not name[:1].isupper():
        raise AttributeError(f"module 'pliant.format' has no attribute '{name}'")
    return dict
