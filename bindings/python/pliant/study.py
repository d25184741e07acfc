"""Studies: many variants of a scene, on processes, as a table."""

from __future__ import annotations

import csv
import dataclasses
import hashlib
import itertools
import json
import os
import pickle
from typing import TYPE_CHECKING, Any, Callable, Mapping, Sequence, Union

from . import _pliant
from ._errors import Error
from ._scene import Scene, SceneLike, as_scene

if TYPE_CHECKING:
    from concurrent.futures import Executor

Measure = Callable[["_pliant.World"], Any]
Measures = Union[Measure, Mapping[str, Measure]]


class Table(list[dict[str, Any]]):
    """The rows of a study: a list of dicts, one a variant, in the order of the variants.

    Each has the values by JSON pointer, the measures by name, and:

    - ``ok``: True if all frames ran and are finite
    - ``explain``: what went wrong, or the warnings of the last frame; else empty
    - ``state_hash``: World.state_hash() at the end; None if there is none
    - ``frames``: number of frames that ran
    - ``milliseconds``: mean time of a frame [ms]
    """

    @property
    def columns(self) -> list[str]:
        """The names of all values, in the order in which they come first."""
        return list(dict.fromkeys(itertools.chain.from_iterable(self)))

    @property
    def failures(self) -> Table:
        """The rows that are not ok."""
        return Table(row for row in self if not row["ok"])

    def column(self, name: str) -> list[Any]:
        """The values of a column; None where a row lacks it."""
        return [row.get(name) for row in self]

    def write(self, path: str | os.PathLike[str]) -> None:
        """Writes a CSV file with a line of names."""
        with open(path, "w", newline="", encoding="utf-8") as file:
            writer = csv.DictWriter(file, self.columns)
            writer.writeheader()
            writer.writerows(self)


@dataclasses.dataclass(frozen=True)
class Variant:
    """One variant: what a process needs to run it, and pickles."""

    scene: Scene
    """The scene with its values."""
    values: dict[str, Any]
    """Values by JSON pointer."""
    measures: dict[str, Measure]
    frames: int | None
    threads: int

    @property
    def key(self) -> str:
        """What identifies the variant: a hash of its scene, its frames and the names of its measures."""
        plain, arrays = self.scene.extract()
        text = json.dumps([plain, self.frames, sorted(self.measures)], sort_keys=True)
        hashed = hashlib.sha256(text.encode())
        for name in sorted(arrays):
            hashed.update(pickle.dumps((name, arrays[name]), protocol=4))
        return hashed.hexdigest()

    def run(self) -> dict[str, Any]:
        """Runs it, and returns its row. What goes wrong is in the row: nothing is raised but KeyboardInterrupt."""
        row: dict[str, Any] = {**self.values, **dict.fromkeys(self.measures)}
        row.update(ok=False, explain="", state_hash=None, frames=0, milliseconds=0.0)
        try:
            self._run_into(row)
        except Exception as error:  # a row for each variant, whatever happens
            row["ok"] = False
            row["explain"] = str(error) if isinstance(error, Error) else f"{type(error).__name__}: {error}"
        return row

    def _run_into(self, row: dict[str, Any]) -> None:
        world = _pliant.World(self.scene, threads=self.threads)
        total = 0.0
        for report in world.frames(self.frames):
            total += report.milliseconds
            row.update(frames=report.frame, milliseconds=total / max(report.frame, 1), explain=report.explain())
        row["state_hash"] = world.state_hash()
        for name, measure in self.measures.items():
            value = measure(world)
            row[name] = value.item() if hasattr(value, "item") and getattr(value, "ndim", 0) == 0 else value
        row["ok"] = report.ok


def run_variant(variant: Variant) -> dict[str, Any]:
    """Runs a variant: what a study submits to its executor."""
    return variant.run()


def _measures_of(measure: Measures | None) -> dict[str, Measure]:
    if measure is None:
        return {}
    if isinstance(measure, Mapping):
        named = dict(measure)
    elif callable(measure):
        named = {getattr(measure, "__name__", "measure"): measure}
    else:
        raise TypeError("measure is a function of a World, or a dict of such functions")
    for name, one in named.items():
        if not isinstance(name, str) or not callable(one):
            raise TypeError("measures are functions of a World by name")
    return named


def _values_of(vary: Mapping[str, Any]) -> list[dict[str, Any]]:
    if not isinstance(vary, Mapping):
        raise TypeError("what varies is a dict {JSON pointer: values}")
    for pointer, values in vary.items():
        if isinstance(values, (str, bytes)) or not hasattr(values, "__iter__"):
            raise TypeError(f"the values of '{pointer}' are no list")
    return [dict(zip(vary, one)) for one in itertools.product(*(list(values) for values in vary.values()))]


def variants(
    scene: SceneLike,
    vary: Mapping[str, Any] | Sequence[Mapping[str, Any]],
    *,
    measure: Measures | None = None,
    frames: int | None = None,
    threads: int = 1,
) -> list[Variant]:
    """The variants of a study, to run one by one: in a Slurm array, task i calls ``variants(...)[i].run()``.

    ``vary``: {JSON pointer: values}, of which all combinations are taken, or a list of {JSON pointer: value}.
    """
    if frames is not None and (isinstance(frames, bool) or not isinstance(frames, int)):
        raise TypeError("frames is a whole number")
    if frames is not None and frames < 1:
        raise Error(f"frames is {frames}", "run 1 or more")
    base, named = as_scene(scene), _measures_of(measure)
    if isinstance(vary, (list, tuple)):
        all_values = [dict(one) for one in vary]
    else:
        all_values = _values_of(vary)  # type: ignore[arg-type]
    made = []
    for values in all_values:
        one = base.copy()
        for pointer, value in values.items():
            one.assign(pointer, value)
        made.append(Variant(one, values, named, frames, threads))
    return made


class _Kept:
    """The rows of a study that was begun, in a file: one JSON object a line, {"key": ..., "row": ...}."""

    def __init__(self, path: str | os.PathLike[str] | None) -> None:
        self.path = path
        self.rows: dict[str, dict[str, Any]] = {}
        if path is None or not os.path.exists(path):
            return
        with open(path, encoding="utf-8") as file:
            for line in file:
                try:
                    kept = json.loads(line)
                    self.rows[kept["key"]] = kept["row"]
                except (ValueError, KeyError, TypeError):
                    continue  # the last line of a run that was killed

    def add(self, key: str, row: dict[str, Any]) -> None:
        if self.path is None:
            return
        try:
            line = json.dumps({"key": key, "row": row}, default=lambda value: value.tolist())
        except (TypeError, AttributeError):
            words = "a study with `resume` keeps rows as JSON: measures return numbers, str, lists or arrays"
            raise TypeError(words) from None
        with open(self.path, "a", encoding="utf-8") as file:
            file.write(line + "\n")


def _require_pickles(measures: dict[str, Measure]) -> None:
    for name, measure in measures.items():
        try:
            pickle.dumps(measure)
        except Exception:
            raise Error(
                f"the measure '{name}' cannot be sent to another process",
                "define it by def at the top of a module, not as a lambda, or pass a ThreadPoolExecutor",
            ) from None


def study(
    scene: SceneLike,
    vary: Mapping[str, Any] | Sequence[Mapping[str, Any]],
    *,
    measure: Measures | None = None,
    frames: int | None = None,
    executor: Executor | Any = None,
    workers: int | None = None,
    threads: int = 1,
    resume: str | os.PathLike[str] | None = None,
    progress: Callable[[int, int], Any] | None = None,
) -> Table:
    """Runs variants of a scene side by side, and returns a row for each.

    ``vary``: {JSON pointer: values}, of which all combinations are taken, or a list of {JSON pointer: value}.
    ``measure``: a function of the World at the end, or a dict of functions by name. ``frames``: None for the scene's
    number. ``workers``: number of processes, as many as the machine has threads if None; 0: this process alone.
    ``executor``: anything with ``submit`` instead, such as a ThreadPoolExecutor or a ``Client`` of dask. ``threads`` of
    each World. ``resume``: a file that keeps rows as they come: what it has of another run is not run again.
    ``progress(done, of)`` is called after each row.

    A variant that fails is a row, too: ``ok`` is false, and ``explain`` says why. The rows do not depend on how they
    are computed: the bits are the same. Raises Error for what is wrong with the call itself.

    Under the start method "spawn", which is used, a script calls this below ``if __name__ == "__main__":``.
    """
    all_variants = variants(scene, vary, measure=measure, frames=frames, threads=threads)
    if workers is not None and (isinstance(workers, bool) or not isinstance(workers, int)):
        raise TypeError("workers is a whole number")
    if workers is not None and workers < 0:
        raise Error(f"workers is {workers}", "pass 0, for this process alone, or more")
    if executor is not None and not hasattr(executor, "submit"):
        raise TypeError("an executor has a method submit")
    kept = _Kept(resume)
    keys = [variant.key if resume is not None else "" for variant in all_variants]
    rows: dict[int, dict[str, Any]] = {i: kept.rows[key] for i, key in enumerate(keys) if key in kept.rows}
    missing = [i for i in range(len(all_variants)) if i not in rows]

    def take(i: int, row: dict[str, Any]) -> None:
        rows[i] = row
        kept.add(keys[i], row)
        if progress is not None:
            progress(len(rows), len(all_variants))

    if executor is None and (workers == 0 or not missing):
        for i in missing:
            take(i, all_variants[i].run())
    elif executor is not None:
        _submit(executor, all_variants, missing, take)
    else:
        import concurrent.futures
        import multiprocessing

        _require_pickles(_measures_of(measure))
        count = min(workers or os.cpu_count() or 1, max(len(missing), 1))
        # oneTBB promises nothing after a fork.
        with concurrent.futures.ProcessPoolExecutor(count, multiprocessing.get_context("spawn")) as pool:
            _submit(pool, all_variants, missing, take)
    return Table(rows[i] for i in range(len(all_variants)))


def _submit(
    executor: Any, all_variants: list[Variant], missing: list[int], take: Callable[[int, dict[str, Any]], None]
) -> None:
    """Submits variants, and takes their rows in order. A worker that dies is a row, too."""
    futures = {i: executor.submit(run_variant, all_variants[i]) for i in missing}
    try:
        for i, future in futures.items():
            try:
                row = future.result()
            except Exception as error:  # the process ended, or something does not pickle
                variant = all_variants[i]
                row = {**variant.values, **dict.fromkeys(variant.measures)}
                row.update(ok=False, explain=f"{type(error).__name__}: {error}")
                row.update(state_hash=None, frames=0, milliseconds=0.0)
            take(i, row)
    except BaseException:
        for future in futures.values():
            future.cancel()
        raise
