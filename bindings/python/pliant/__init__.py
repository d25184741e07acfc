"""Pliant: position based dynamics of cloth, ropes, soft bodies, rigid bodies, liquids and grains.

A Scene describes a simulation, a World runs it, and its objects give and take numpy arrays. help(pliant.format) lists
the members of a Scene.

>>> import pliant
>>> scene = pliant.Scene()
>>> scene.add(cloth={"mesh": pliant.grid_mesh(8, 8, 1, 1), "material": "silk"}, pins=[{"particles": [0, 7]}])
'cloth'
>>> world = pliant.World(scene)
>>> world.run(10).ok
True
>>> world["cloth"].positions().shape
(64, 3)
"""

from . import _calls, _errors, _types, format  # noqa: F401  (the compiled part looks for the first three)
from ._errors import Error
from ._pliant import (
    Batch,
    BatchObject,
    Collider,
    Edit,
    Gauges,
    MeshCollider,
    Object,
    Report,
    State,
    World,
    Writer,
    fabrics,
    grid_mesh,
    read_mesh,
    sphere_mesh,
    version,
    write_mesh,
)
from ._scene import Scene
from .study import Table, study
from ._types import BodyTouch, ContactEvent, Finding, ForceArrays, JointState, JointStates, Load, Loads, Pose

__version__ = version()

__all__ = [
    "Batch",
    "BatchObject",
    "BodyTouch",
    "Collider",
    "ContactEvent",
    "Edit",
    "Error",
    "Finding",
    "ForceArrays",
    "Gauges",
    "JointState",
    "JointStates",
    "Load",
    "Loads",
    "MeshCollider",
    "Object",
    "Pose",
    "Report",
    "Scene",
    "State",
    "Table",
    "World",
    "Writer",
    "__version__",
    "fabrics",
    "grid_mesh",
    "read_mesh",
    "sphere_mesh",
    "study",
    "version",
    "write_mesh",
]
