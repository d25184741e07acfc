"""Studies: many variants of a scene, on processes, as a table."""

from __future__ import annotations

import collections
import contextlib
import csv
import dataclasses
import hashlib
import itertools
import json
import os
import pickle
import queue
from typing import TYPE_CHECKING, Any, Callable, Mapping, Sequence, Union

import numpy as np

from . import _calls, _pliant
from ._errors import Error
from ._scene import Scene, SceneLike, as_scene, copied, files_of

if TYPE_CHECKING:
    from concurrent.futures import Executor, Future, ProcessPoolExecutor

_COLUMNS = frozenset(("ok", "explain", "state_hash", "frames", "milliseconds"))

Measure = Callable[["_pliant.World"], Any]
Measures = Union[Measure, Mapping[str, Measure]]


class Table(list[dict[str, Any]]):
    """The rows of a study: a list of dicts, one a variant, in the order of the variants.

    Each has the values by JSON pointer, the measures by name, and:

    - ``ok``: True if all frames ran and are finite; False if the run was stopped
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
        """What identifies the variant: a hash of its scene, its frames, the names of its measures and the version.

        Files of meshes and robots count by path, size and time, measures by name alone.
        """
        plain, arrays = self.scene.extract()
        files = [_stamp(self.scene.folder, path) for path in files_of(plain)]
        of_all = [_pliant.version(), plain, self.scene.folder, files, self.frames, sorted(self.measures)]
        text = json.dumps(of_all, sort_keys=True)
        hashed = hashlib.sha256(text.encode())
        for name in sorted(arrays):
            hashed.update(pickle.dumps((name, arrays[name]), protocol=4))
        return hashed.hexdigest()

    def run(self) -> dict[str, Any]:
        """Runs it, and returns its row. What goes wrong is in the row: nothing is raised but KeyboardInterrupt."""
        row = self.failed("")
        try:
            self._run_into(row)
        except Exception as error:  # a row for each variant, whatever happens
            row["ok"] = False
            row["explain"] = _words_of(error)
        return row

    def failed(self, explain: str) -> dict[str, Any]:
        """The row of a variant that has not run."""
        row: dict[str, Any] = {**copied(self.values), **dict.fromkeys(self.measures)}
        row.update(ok=False, explain=explain, state_hash=None, frames=0, milliseconds=0.0)
        return row

    def _run_into(self, row: dict[str, Any]) -> None:
        world = _pliant.World(self.scene, threads=self.threads)
        total = 0.0
        for report in world.frames(self.frames):
            total += report.milliseconds
            row.update(frames=report.frame, milliseconds=total / max(report.frame, 1), explain=report.explain())
        row["state_hash"] = world.state_hash()
        for name, measure in self.measures.items():
            try:
                row[name] = _as_kept(measure(world))
            except Exception as error:
                raise _InMeasure(f"measure '{name}': {_words_of(error)}") from error
        row["ok"] = report.ok and not report.stopped
        if report.stopped:
            row["explain"] = "; ".join(filter(None, [row["explain"], "the run was stopped"]))


class _InMeasure(Exception):
    """What a measure raised, with its name."""


def _words_of(error: Exception) -> str:
    return str(error) if isinstance(error, (Error, _InMeasure)) else f"{type(error).__name__}: {error}"


def _as_kept(value: Any) -> Any:
    """A measure as a file of rows gives it back, so that rows do not depend on `resume`."""
    if isinstance(value, (np.generic, np.ndarray)) and value.dtype.kind in "biuf":
        return value.tolist()
    try:
        text = json.dumps(value, ensure_ascii=False, default=lambda of: of.tolist())
        text.encode()
        return json.loads(text)
    except (TypeError, AttributeError, ValueError):
        problem = f"returned {_calls.shown(value)}, which no table holds"
        raise Error(problem, "return numbers, str, lists or arrays") from None


def _stamp(folder: str, path: str) -> list[Any]:
    """What tells whether a file has changed."""
    try:
        found = os.stat(os.path.join(folder, path))
    except (OSError, ValueError):  # the run says what is wrong with it
        return [path]
    return [path, found.st_size, found.st_mtime_ns]


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
        if name in _COLUMNS or name.startswith("/"):
            raise Error(f"a measure is called '{name}', as a column of each row is", "give it another name")
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
        all_values = [copied(dict(one)) for one in vary]
    else:
        all_values = _values_of(vary)  # type: ignore[arg-type]
    made = []
    for values in all_values:
        one = base.copy()
        for pointer, value in values.items():
            one.assign(pointer, value)
        made.append(Variant(one, copied(values), named, frames, threads))
    return made


_ROW_BEGINS = '{"key": "'


class _Kept:
    """The rows of a study that was begun, in a file: one JSON object a line, {"key": ..., "row": ...}."""

    def __init__(self, path: str | os.PathLike[str] | None) -> None:
        self.path = path
        self.rows: dict[str, dict[str, Any]] = {}
        self._begin = ""  # what ends a line that was cut off
        if path is None or not os.path.exists(path):
            return
        if not os.path.isfile(path):
            raise Error("this is no file", "`resume` is the path of a file that the study makes", file=os.fspath(path))
        with open(path, encoding="utf-8", errors="replace") as file:
            for number, line in enumerate(file, 1):
                self._begin = "" if line.endswith("\n") else "\n"
                try:
                    kept = json.loads(line)
                    self.rows[kept["key"]] = kept["row"]
                except (ValueError, KeyError, TypeError):
                    # The last line of a run that was killed may be cut off; such a run may have been resumed since.
                    if line.strip() and not line.startswith(_ROW_BEGINS[: len(line.rstrip())]):
                        raise Error(
                            f"line {number} is no row of a study, so that nothing was added to it",
                            "`resume` is a file of the study's own: name one that is not there yet",
                            file=os.fspath(path),
                        ) from None

    def add(self, key: str, row: dict[str, Any]) -> None:
        if self.path is None:
            return
        line = json.dumps({"key": key, "row": row}, default=lambda value: value.tolist())
        with open(self.path, "a", encoding="utf-8") as file:
            file.write(self._begin + line + "\n")
        self._begin = ""


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
    ``measure``: a function of the World at the end, or a dict of functions by name; it may also go on with the World,
    as an episode with control does. It returns a number, a str, or a list; arrays become lists. ``frames``: None for the scene's
    number. ``workers``: number of processes, as many as the machine has threads if None; 0: this process alone.
    ``executor``: anything with ``submit`` instead, such as a ThreadPoolExecutor or a ``Client`` of dask. ``threads`` of
    each World. ``resume``: a file that keeps rows as they come: what it has of another run is not run again, unless
    the scene, its frames, the names of measures, the version of Pliant, or path, size or time of a file that the scene
    names has changed. Measures count by name: remove the file after a change of their code, or of meshes that a .urdf
    file names. ``progress(done, of)`` is called after each row.

    A variant that fails is a row, too: ``ok`` is false, and ``explain`` says why. If a process dies, variants that ran
    beside it run again, each alone in a process; one whose process dies once more is a row that fails, which ``resume``
    does not keep. The rows do not depend on how they are computed: the bits are the same. Raises Error for what is
    wrong with the call itself.

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

    def take(i: int, row: dict[str, Any], is_kept: bool = True) -> None:
        rows[i] = row
        if is_kept:
            kept.add(keys[i], row)
        if progress is not None:
            progress(len(rows), len(all_variants))

    if executor is None and (workers == 0 or not missing):
        for i in missing:
            take(i, all_variants[i].run())
    elif executor is not None:
        _as_they_end(
            lambda i: executor.submit(run_variant, all_variants[i]),
            collections.deque(missing),
            max(len(missing), 1),
            lambda i, future: take(i, *_row(all_variants[i], future)),
        )
    else:
        _require_pickles(_measures_of(measure))
        _in_processes(all_variants, missing, min(workers or os.cpu_count() or 1, len(missing)), take)
    return Table(rows[i] for i in range(len(all_variants)))


def _row(variant: Variant, future: Any) -> tuple[dict[str, Any], bool]:
    """The row of a future, and whether to keep it: not if no run made it."""
    try:
        return future.result(), True
    except Exception as error:  # the process ended, or something does not pickle
        return variant.failed(f"{type(error).__name__}: {error}"), False


def _as_they_end(
    submit: Callable[[int], Any], left: collections.deque[int], most: int, take: Callable[[int, Any], None]
) -> None:
    """Submits what is left, at most so many at a time, and takes futures as they end."""
    ended: queue.SimpleQueue[int] = queue.SimpleQueue()
    futures: dict[int, Any] = {}

    def put(i: int) -> Callable[[Any], None]:
        return lambda _: ended.put(i)

    try:
        while left or futures:
            while left and len(futures) < most:
                i = left.popleft()
                futures[i] = submit(i)
                if hasattr(futures[i], "add_done_callback"):
                    futures[i].add_done_callback(put(i))
                else:
                    ended.put(i)  # in order, then
            i = ended.get()
            take(i, futures.pop(i))
    except BaseException:
        for future in futures.values():
            future.cancel()
        raise


def _pool(count: int) -> ProcessPoolExecutor:
    import concurrent.futures  # not with the package, which is imported in less time
    import multiprocessing

    # oneTBB promises nothing after a fork.
    return concurrent.futures.ProcessPoolExecutor(count, multiprocessing.get_context("spawn"))


def _submitted(pool: Executor, variant: Variant) -> Future[dict[str, Any]]:
    from concurrent.futures import BrokenExecutor, Future

    try:
        return pool.submit(run_variant, variant)
    except BrokenExecutor as error:
        future: Future[dict[str, Any]] = Future()
        future.set_exception(error)
        return future


def _in_processes(all_variants: list[Variant], missing: list[int], count: int, take: Callable[..., None]) -> None:
    """Runs variants on processes.

    One that dies takes its pool along. What ran then runs again, each alone, and the rest in a new pool. Where no row
    ever comes, as from a script that does not guard its main part, the third dead pool is the last.
    """
    from concurrent.futures import BrokenExecutor

    left = collections.deque(missing)
    suspects: dict[int, Any] = {}
    rest: list[int] = []
    dead, some_came = 0, False

    def take_last(i: int, future: Any) -> None:
        nonlocal some_came
        some_came = some_came or not isinstance(future.exception(), BrokenExecutor)
        take(i, *_row(all_variants[i], future))

    def take_or_suspect(i: int, future: Any) -> None:
        if not isinstance(future.exception(), BrokenExecutor):
            return take_last(i, future)
        suspects[i] = future
        rest.extend(left)
        left.clear()

    while left:
        suspects, rest = {}, []
        with _pool(count) as pool:
            _as_they_end(lambda i: _submitted(pool, all_variants[i]), left, count, take_or_suspect)
        if len(suspects) == 1:
            take_last(*suspects.popitem())
        elif suspects:
            with contextlib.ExitStack() as stack:
                alone = {i: stack.enter_context(_pool(1)) for i in suspects}
                again = collections.deque(suspects)
                _as_they_end(lambda i: _submitted(alone[i], all_variants[i]), again, len(alone), take_last)
        dead += 1
        if dead == 3 and not some_came:
            for i in rest:
                take(i, all_variants[i].failed("not run: processes end before a row comes"), False)
            break
        left = collections.deque(rest)
