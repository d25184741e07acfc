"""Types that the signatures name, and small tuples that functions return."""

from __future__ import annotations

from typing import Any, Callable, Mapping, NamedTuple, Sequence, Tuple, Union

import numpy as np

FloatArray = np.ndarray[Any, np.dtype[np.float32]]
"""An array of float32."""
IntArray = np.ndarray[Any, np.dtype[np.int32]]
"""An array of int32."""
AnyArray = np.ndarray[Any, np.dtype[Any]]
"""An array of numbers of any type."""
IntsLike = Union[Sequence[int], AnyArray]
"""Indices: a list, or an array of integers."""
VectorLike = Union[Sequence[float], AnyArray]
"""A few numbers, such as (x, y, z)."""
VectorsLike = Union[Sequence[Sequence[float]], AnyArray]
"""Vectors, shape (n, 3): an array of float32 is used as it is, others are converted."""
Mesh = Tuple[FloatArray, IntArray]
"""A triangle mesh: vertices [m], shape (n, 3), and triangles, shape (m, 3), counter-clockwise seen from outside."""
MeshLike = Tuple[VectorsLike, Any]
"""A mesh that is given: (vertices, triangles)."""
Vector = Tuple[float, float, float]
"""x, y, z."""


class Pose(NamedTuple):
    """A rigid pose: a point p of the local frame is at rotation p + position."""

    position: Vector
    """Of the frame's origin [m]."""
    rotation: tuple[float, float, float, float]
    """Quaternion (x, y, z, w)."""


class Load(NamedTuple):
    """What a joint does to its second body, in world axes."""

    force: Vector
    """[N]"""
    torque: Vector
    """About the joint's anchor [N m]."""


class JointState(NamedTuple):
    """Where the second body of a joint is against the first, in axes of the joint that are fixed in the first body.

    x is along the axis of a hinge or slider. All is 0 at time 0.
    """

    displacement: Vector
    """Of the second body's anchor from its place in the first [m]."""
    rotation: Vector
    """A vector along the axis whose length is the angle, up to half a turn [rad]."""
    velocity: Vector
    """Of the second body's anchor, as seen from the first [m/s]."""
    angular_velocity: Vector
    """Of the second body against the first [rad/s]."""


class Loads(NamedTuple):
    """Load of the joints in all worlds of a Batch."""

    force: FloatArray
    """[N], shape (worlds, 3), or (worlds, k, 3) of k joints."""
    torque: FloatArray
    """About the joints' anchors [N m], of the same shape."""


class JointStates(NamedTuple):
    """JointState of the joints in all worlds of a Batch: arrays of shape (worlds, 3), or (worlds, k, 3) of k joints."""

    displacement: FloatArray
    """[m]"""
    rotation: FloatArray
    """[rad]"""
    velocity: FloatArray
    """[m/s]"""
    angular_velocity: FloatArray
    """[rad/s]"""


class Finding(NamedTuple):
    """What a check found."""

    grave: bool
    """True if the scene cannot be simulated for it."""
    message: str
    """What is wrong, and where."""
    advice: str
    """What to do about it; may be empty."""


class ContactEvent(NamedTuple):
    """The contacts between two things in a frame."""

    change: str
    """"begin", "persist" or "end"."""
    first: str
    """Name of an object or collider."""
    second: str
    """Name of the other one; the same for self-contact."""
    contacts: int
    """Largest number of contacts in a substep."""
    impulse: float
    """Sum of the magnitudes of their normal impulses over the frame [N s]."""
    position: Vector
    """Mean position, weighted by impulse [m]."""
    normal: Vector
    """Mean direction of the push on the first; zero if pushes cancel."""
    push: Vector
    """Sum of their normal impulses on the first [N s]."""


class BodyTouch(NamedTuple):
    """The contacts between a rigid body and another one, a collider or particles in a frame, without friction."""

    first: str
    """Name of an object or collider."""
    first_body: str
    """Name of its body; empty for a collider or particles."""
    second: str
    """Name of the other object or collider."""
    second_body: str
    """Name of its body; empty for a collider or particles."""
    contacts: int
    """Largest number of contacts in a substep."""
    impulse: float
    """Sum of the magnitudes of their normal impulses over the frame [N s]."""
    position: Vector
    """Mean position, weighted by impulse [m]."""
    push: Vector
    """Sum of their normal impulses on the first [N s]; over the duration of the frame it is the mean force."""


class ForceArrays:
    """What a force function gets: the particles of one object in a substep, and the forces to fill.

    The arrays belong to the function: they may be kept, and are filled again for the next call.
    """

    __slots__ = ("object", "positions", "velocities", "masses", "forces", "time")

    object: str
    """Name of the object."""
    positions: FloatArray
    """[m], shape (n, 3), in the order of the mesh."""
    velocities: FloatArray
    """[m/s], shape (n, 3)."""
    masses: FloatArray
    """[kg], shape (n,); infinite for pinned particles, on which forces have no effect."""
    forces: FloatArray
    """To be filled [N], shape (n, 3); zero at the call."""
    time: float
    """Simulated time [s]."""

    def __init__(
        self, object: str, positions: FloatArray, velocities: FloatArray, masses: FloatArray, forces: FloatArray
    ) -> None:
        self.object, self.positions, self.velocities = object, positions, velocities
        self.masses, self.forces, self.time = masses, forces, 0.0

    def __repr__(self) -> str:
        return f"<pliant.ForceArrays of '{self.object}': {len(self.masses)} particles>"


Forces = Union[Callable[[ForceArrays], Any], Mapping[str, Callable[[ForceArrays], Any]]]
"""A force function for all objects, or functions by name of object."""
