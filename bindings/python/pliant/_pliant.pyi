# Made by scripts/python stubs; do not edit.
"""The compiled part of pliant. Use the names of the package pliant."""

from collections.abc import Iterator, Sequence
import os
import types
from typing import Any, IO

import pliant._scene
import pliant._types


def version() -> str:
    """The version of the library."""

class Description:
    """A scene that was read and checked: what a World is made from."""

    @property
    def frame_time(self) -> float:
        """Duration of a frame [s]."""

    @property
    def frames(self) -> int:
        """Default number of frames of a run."""

    @property
    def repairs(self) -> list[str]:
        """Repairs of meshes, doubts about robots."""

    @property
    def left_out(self) -> list[str]:
        """What fills left out."""

    @property
    def objects(self) -> list[str]:
        """Names of the objects."""

    def describe(self) -> str:
        """What the scene holds, in lines."""

    def check(self, seconds: float = 0.0) -> list[pliant._types.Finding]:
        """Findings of the scene, and of trial runs of about `seconds` [s]."""

def describe(text: str, name: str, folder: str, meshes: dict[str, Any], tetrahedra: dict[str, Any], points: dict[str, Any], allow_outside: bool) -> Description:
    """Reads a scene from JSON text and arrays."""

def fabrics() -> dict[str, dict[str, Any]]:
    """
    The built-in fabrics by name: their properties in SI units, and `source`, where the numbers come from.
    """

def scene_schema() -> str:
    """The JSON Schema (2020-12) of the scene format as text."""

def grid_mesh(columns: int, rows: int, width: float, depth: float) -> pliant._types.Mesh:
    """
    A flat rectangle of columns x rows vertices, width x depth [m], in the xz-plane about the origin, as (vertices, triangles).

    Vertex (row r, column c) has the index r * columns + c. Raises Error unless columns and rows are at least 2 and the sizes positive.
    """

def sphere_mesh(subdivisions: int) -> pliant._types.Mesh:
    """
    A closed unit sphere about the origin as (vertices, triangles): an icosahedron whose faces are split `subdivisions` times (0 to 7).
    """

def read_mesh(path: str) -> pliant._types.Mesh:
    """
    Reads an .obj, .ply or .stl file as (vertices [m], triangles). Polygons are triangulated; vertices with equal positions are merged. Raises Error with file and line if the file cannot be read.
    """

def write_mesh(path: str, mesh: pliant._types.MeshLike) -> None:
    """
    Writes (vertices, triangles) as .obj or .ply. Raises Error if that fails; an existing file then stays unchanged.
    """

class State:
    """
    All of a World that changes with time, as a value. Restore it, and the next step gives the same bits. It can be pickled.

    World.state() returns one; World.restore() takes it.
    """

    @property
    def time(self) -> float:
        """Simulated time [s]."""

    @property
    def frame(self) -> int:
        """Number of complete frames."""

    @property
    def particles(self) -> int:
        """Number of particles of all objects."""

    def hash(self) -> str:
        """The SHA-256 hash as 64 hexadecimal digits."""

    def __eq__(self, other: object, /) -> bool:
        """True if both have the same bits."""

    def __hash__(self) -> int:
        """The hash of hash()."""

    def __copy__(self) -> State:
        """A copy."""

    def __deepcopy__(self, memo: object) -> State:
        """A copy."""

    def __getstate__(self) -> bytes:
        """The bytes of the save format."""

    def __setstate__(self, bytes: bytes) -> None:
        """Reads the bytes of the save format."""

    def __repr__(self) -> str: ...

class Report:
    """
    What a step did. Values are attributes, and also items as of a dict: report["contacts"]. Names of objects are those at the time of the step.
    """

    @property
    def frame(self) -> int:
        """Number of complete frames."""

    @property
    def time(self) -> float:
        """Simulated time [s]."""

    @property
    def milliseconds(self) -> float:
        """Time that the step took [ms]."""

    @property
    def substeps(self) -> int:
        """Substeps of this frame; the most of any object."""

    @property
    def contacts(self) -> int:
        """Contacts with colliders and rigid bodies in the last substep."""

    @property
    def pairs(self) -> dict[str, Any]:
        """
        Contact between surfaces: candidates, contacts, truncated, unresolvable, initially_intersecting, rebuilds, inside, deepest [m].
        """

    @property
    def residuals(self) -> list[dict[str, Any]]:
        """
        Residuals by type of constraint: type, rms, largest. Filled if settings.measure is set.
        """

    @property
    def stretch(self) -> dict[str, float] | None:
        """
        Length over rest length: mean, p99, largest [-]. None unless settings.measure is set.
        """

    @property
    def iterations(self) -> dict[str, float]:
        """Iterations a substep: smallest, largest, mean."""

    @property
    def overstretch(self) -> dict[str, Any] | None:
        """
        By how much lengths exceed what their force explains: p99, largest [-], object, particles, constraints. None if the frame was not completed.
        """

    @property
    def worst_overstretch(self) -> dict[str, Any]:
        """
        The same for the worst frames since the World was made or a State restored.
        """

    @property
    def compression(self) -> dict[str, float]:
        """
        How much denser than at rest liquids are: mean, largest [-], crowded (particles).
        """

    @property
    def flow(self) -> dict[str, int]:
        """Particles that came and went: emitted, drained, expired, ..."""

    @property
    def lost_momentum(self) -> dict[str, float]:
        """Momentum that filter, guards and sleep took from objects [kg m/s]."""

    @property
    def sleeping_bodies(self) -> int:
        """Rigid bodies that sleep."""

    @property
    def sleeping_grains(self) -> int:
        """Grains that sleep."""

    @property
    def torn(self) -> list[dict[str, Any]]:
        """
        Objects that tore or were cut: object, new_particles, lost_constraints.
        """

    @property
    def broken_joints(self) -> list[dict[str, Any]]:
        """Joints that broke in this step: object, joint (index), name."""

    @property
    def nonfinite(self) -> dict[str, Any] | None:
        """
        Where the first value that is not finite arose: object, element, frame, substep; else None.
        """

    @property
    def stopped(self) -> bool:
        """True if Ctrl-C or World.stop() ended the step within the frame."""

    @property
    def warnings(self) -> list[str]:
        """Warnings, one sentence each."""

    @property
    def estimates(self) -> dict[str, dict[str, Any]]:
        """
        How far from converged the solve of stretching, bending, ... is, as docs/internals/convergence.md explains.
        """

    @property
    def phases(self) -> dict[str, float]:
        """Time of each phase [ms]."""

    @property
    def ok(self) -> bool:
        """False if a value was not finite."""

    def explain(self) -> str:
        """Problems and warnings as text."""

    def describe(self) -> str:
        """
        Frame, time, cost, contacts, the worst overstretch, and all that explain() says, for people to read.
        """

    def as_dict(self) -> dict[str, Any]:
        """All values as a dict that JSON can hold."""

    def keys(self) -> list[str]:
        """The names of all values."""

    def __getitem__(self, key: str, /) -> Any:
        """A value by name."""

    def __iter__(self) -> Iterator[str]:
        """Iterates over the names of all values."""

    def __len__(self) -> int:
        """The number of values."""

    def __repr__(self) -> str: ...

class Object:
    """
    An object of a World, to read and control between steps: world["name"]. It keeps its World alive. All functions raise Error after it was removed, and while the World steps in another thread.
    """

    @property
    def name(self) -> str:
        """Its name."""

    @property
    def particles(self) -> int:
        """Number of its particles."""

    @property
    def substeps(self) -> int:
        """Substeps a frame; 0: they follow the state."""

    @property
    def constraints(self) -> dict[str, int]:
        """Number of its constraints of each type."""

    @property
    def exists(self) -> bool:
        """False after it was removed."""

    def __len__(self) -> int:
        """Number of its particles."""

    def __repr__(self) -> str: ...

    def positions(self, out: pliant._types.FloatArray | None = None) -> pliant._types.FloatArray:
        """
        Positions of the particles in the order of the mesh [m], shape (particles, 3).

        `out`: a C-contiguous float32 array to fill; other arrays raise Error.
        """

    def velocities(self, out: pliant._types.FloatArray | None = None) -> pliant._types.FloatArray:
        """
        Velocities of the particles in the order of the mesh [m/s], shape (particles, 3). `out` as in positions().
        """

    def records(self) -> pliant._types.FloatArray:
        """
        A read-only view, without a copy, of x, y, z [m] and inverse mass [1/kg] of each particle in storage order: record i is particle storage_order()[i]. It keeps its World alive, and shows another state after each step. While it lives, nothing can be added to, removed from, edited or restored in the World. Indices from `particles` on are targets of attachments.
        """

    def velocity_records(self) -> pliant._types.FloatArray:
        """The same for velocities [m/s]; the fourth number is zero."""

    def storage_order(self) -> pliant._types.IntArray:
        """The particle of each record."""

    def mesh(self) -> pliant._types.Mesh:
        """The surface at its present positions: (vertices [m], triangles)."""

    def orientations(self) -> pliant._types.FloatArray:
        """
        Orientations of bodies and rods as unit quaternions (x, y, z, w), shape (frames, 4).
        """

    def angular_velocities(self) -> pliant._types.FloatArray:
        """Their angular velocities in world axes [rad/s], shape (frames, 3)."""

    def channel(self, name: str) -> pliant._types.FloatArray:
        """
        A value for each particle, as "temperature" [K] of a gas. Raises Error if there is none of that name.
        """

    def present(self) -> pliant._types.IntArray:
        """
        The particles that are there: all, unless particles of the object are emitted, drained or expire.
        """

    def enclosed_volume(self) -> float:
        """Volume that its triangles enclose [m^3]."""

    def multipliers(self, type: str) -> pliant._types.FloatArray:
        """
        Multipliers of the last substep of the constraints of a type, as "distance", in the order of their groups. Those of distances with compliance are always stored, others if settings.record_multipliers is set; what is not stored gives an empty array. A multiplier over the square of the substep [s^2] is the force along the gradient. Raises Error if it has no constraints of the type: `constraints` lists them.
        """

    def pose(self, body: int | str = 0) -> pliant._types.Pose:
        """
        Pose of a rigid body, by index or name: position [m] and rotation (x, y, z, w) of the frame in which it was described.
        """

    def body_is_asleep(self, body: int) -> bool:
        """True if the rigid body of this index sleeps."""

    def joint_state(self, joint: int | str) -> pliant._types.JointState:
        """
        Angles, displacements and speeds of a joint, by index or name, as they are now.
        """

    def joint_load(self, joint: int | str) -> pliant._types.Load:
        """
        (force [N], torque [N m]) that a joint carried in the last substep, in world axes; zero if it is broken. It oscillates from substep to substep: see mean_joint_load().
        """

    def mean_joint_load(self, joint: int | str) -> pliant._types.Load:
        """
        Its mean over the last frame. Raises Error unless World.record_joint_loads() is on.
        """

    def joint_is_broken(self, joint: int | str) -> bool:
        """True if a joint has broken."""

    def set_targets(self, particles: pliant._types.IntsLike, positions: pliant._types.VectorsLike) -> None:
        """
        Moves pinned particles at constant velocity to `positions` [m], which they reach at the end of the next step.
        """

    def set_attachment_targets(self, attachments: pliant._types.IntsLike, positions: pliant._types.VectorsLike) -> None:
        """Moves the targets of attachments, by index, in the same way [m]."""

    def set_velocities(self, velocities: pliant._types.VectorsLike) -> None:
        """
        Sets the velocity of each particle [m/s], shape (particles, 3); pinned ones are skipped.
        """

    def add_impulses(self, impulses: pliant._types.VectorsLike) -> None:
        """
        Adds an impulse to each particle [N s], shape (particles, 3): velocity += impulse / mass.
        """

    def set_forces(self, forces: pliant._types.VectorsLike) -> None:
        """
        Applies a constant force to each particle during the next step [N], shape (particles, 3). Replaces those of an earlier call.
        """

    def teleport(self, position: pliant._types.VectorLike = (0, 0, 0), rotation: pliant._types.VectorLike = (0, 0, 0, 1)) -> None:
        """
        Moves the whole object at once: each point is rotated about the origin by `rotation` (x, y, z, w), then moved by `position` [m]. Raises Error if a pin or attachment with keyframes would stay behind.
        """

    def set_pose(self, body: int | str, position: pliant._types.VectorLike, rotation: pliant._types.VectorLike = (0, 0, 0, 1)) -> None:
        """
        Moves a kinematic body, by index or name, to a pose that it reaches at the end of the next step [m].
        """

    def set_surface_velocity(self, body: int | str, velocity: pliant._types.VectorLike) -> None:
        """
        Gives the surface of a body a velocity along itself, as a conveyor belt has, in the body's frame [m/s].
        """

    def set_motor(self, joint: int | str, target: float, most: float | None = None, motor: str = '') -> None:
        """
        Gives the motor of a joint a new target: an angle [rad], displacement [m] or speed [rad/s or m/s], as its kind says. `most`: greatest torque [N m] or force [N]; None: as before. `motor`: its name if the joint has several.
        """

    def set_rest_factor(self, group: int, factor: float) -> None:
        """
        Multiplies rest lengths or volumes of a group of constraints by a factor >= 0, as a muscle's activation does.
        """

class Collider:
    """
    A primitive collider of a World, to read and move between steps: world.collider("name").
    """

    @property
    def name(self) -> str:
        """Its name."""

    @property
    def exists(self) -> bool:
        """False after it was removed."""

    def set_pose(self, position: pliant._types.VectorLike, rotation: pliant._types.VectorLike = (0, 0, 0, 1)) -> None:
        """
        Moves it to a pose that it reaches at the end of the next step: position [m] at constant velocity, rotation (x, y, z, w) along the shorter arc. After that it stays.
        """

    def teleport(self, position: pliant._types.VectorLike = (0, 0, 0), rotation: pliant._types.VectorLike = (0, 0, 0, 1)) -> None:
        """
        Moves it at once, rotated about the origin and then moved [m]; what it touches gets no velocity.
        """

    def set_surface_velocity(self, velocity: pliant._types.VectorLike) -> None:
        """
        Gives its surface a velocity along itself in its own frame, as a conveyor belt has [m/s].
        """

    def pose(self) -> pliant._types.Pose:
        """Its pose: position [m] and rotation (x, y, z, w)."""

    def __repr__(self) -> str: ...

class MeshCollider:
    """
    A mesh collider of a World, to read and move between steps: world.mesh_collider("name"). Poses move its vertices from where the scene places them: at the start its pose is the identity.
    """

    @property
    def name(self) -> str:
        """Its name."""

    @property
    def exists(self) -> bool:
        """False after it was removed."""

    def set_pose(self, position: pliant._types.VectorLike, rotation: pliant._types.VectorLike = (0, 0, 0, 1)) -> None:
        """
        Moves it to a pose that it reaches at the end of the next step: position [m] at constant velocity, rotation (x, y, z, w) along the shorter arc. After that it stays.
        """

    def teleport(self, position: pliant._types.VectorLike = (0, 0, 0), rotation: pliant._types.VectorLike = (0, 0, 0, 1)) -> None:
        """
        Moves it at once, rotated about the origin and then moved [m]; what it touches gets no velocity.
        """

    def set_surface_velocity(self, velocity: pliant._types.VectorLike) -> None:
        """
        Gives its surface a velocity along itself in its own frame, as a conveyor belt has [m/s].
        """

    def positions(self, out: pliant._types.FloatArray | None = None) -> pliant._types.FloatArray:
        """
        Positions of its vertices [m], shape (vertices, 3). `out` as in Object.positions().
        """

    def set_positions(self, positions: pliant._types.VectorsLike) -> None:
        """
        Moves its vertices to positions that they reach at the end of the next step [m]; only where it collides as triangles.
        """

    def __repr__(self) -> str: ...

class Edit:
    """
    Changes of an object of a World, made together by apply() or at the end of a `with` block: World.edit() returns one. Particles keep position and velocity exactly, and the object its name and id. Indices are those after earlier calls.
    """

    @property
    def name(self) -> str:
        """Name of the object."""

    @property
    def particles(self) -> int:
        """Number of particles now."""

    @property
    def origins(self) -> pliant._types.IntArray:
        """For each particle now, the particle of the World from which it comes."""

    @property
    def triangles(self) -> pliant._types.IntArray:
        """The triangles now, shape (n, 3)."""

    @property
    def tetrahedra(self) -> pliant._types.IntArray:
        """The tetrahedra of a soft body now, shape (n, 4)."""

    @property
    def pins(self) -> pliant._types.IntArray:
        """The pinned particles now."""

    @property
    def attachments(self) -> pliant._types.IntArray:
        """The particle of each attachment now."""

    @property
    def masses(self) -> pliant._types.FloatArray:
        """Masses now [kg], without what pins do."""

    def pin(self, particles: pliant._types.IntsLike) -> None:
        """
        Pins particles where they are: they become kinematic, and Object.set_targets() moves them. Those that are pinned stay so.
        """

    def unpin(self, particles: pliant._types.IntsLike | None = None) -> None:
        """
        Lets pinned particles go; None: all. Raises Error if one is not pinned.
        """

    def attach(self, particles: pliant._types.IntsLike, targets: pliant._types.VectorsLike, compliance: float = 0, damping: float = 0) -> None:
        """
        Attaches particles to targets [m], shape (n, 3), by springs of a compliance [m/N]; 0: rigidly. `damping` [N s/m] is of a spring. The new attachments follow those that there are; Object.set_attachment_targets() moves the targets.
        """

    def detach(self, particles: pliant._types.IntsLike | None = None) -> None:
        """
        Removes the attachments of particles; None: all. Raises Error if one has none.
        """

    def cut(self, path: pliant._types.IntsLike) -> None:
        """
        Cuts a surface along a path of particles, each joined to the next by an edge. Particles inside the path and at ends on the border are split; the copies follow all others. Mass and momentum are conserved.
        """

    def remove_triangles(self, triangles: pliant._types.IntsLike) -> None:
        """
        Removes triangles of a surface, by index, and the constraints that only they had.
        """

    def part_triangles(self, part: pliant._types.IntsLike) -> None:
        """
        Parts a surface along edges: triangles of different `part` come apart, one number for each triangle.
        """

    def remove_tetrahedra(self, tetrahedra: pliant._types.IntsLike) -> None:
        """Removes tetrahedra of a soft body, by index, with their mass."""

    def part_tetrahedra(self, part: pliant._types.IntsLike) -> None:
        """
        Parts a soft body along faces: tetrahedra of different `part` come apart, one number for each.
        """

    def scale_stiffness(self, type: str, factor: float) -> None:
        """
        Multiplies the stiffness of all constraints of a type, as "distance" (Object.constraints lists them), by a factor > 0. What is rigid stays rigid.
        """

    def set_compliance(self, type: str, compliance: float, damping: float | None = None) -> None:
        """
        Gives all constraints of a type one compliance >= 0, in the unit that docs/reference/constraints.md has for the type; 0: rigid. `damping`: None: as before.
        """

    def set_masses(self, masses: pliant._types.VectorLike) -> None:
        """
        Sets the mass of each particle, > 0 [kg]; infinity: fixed. Velocities stay.
        """

    def describe(self, **members: Any) -> None:
        """
        Replaces the description by one as of Scene.add(), with another material, thickness or pins, for example. It must have as many particles in the same order: each keeps position and velocity. What earlier calls changed is replaced.
        """

    def apply(self) -> pliant._types.IntArray:
        """
        Makes the changes in the World, once. Returns for each old particle its first new index, or -1 where it is gone. If the description cannot be simulated, or the object was edited or torn since World.edit(), raises Error and changes nothing. The end of a `with` block calls it.
        """

    def __enter__(self) -> Edit:
        """Itself."""

    def __exit__(self, type: type[BaseException] | None, value: BaseException | None, trace: types.TracebackType | None) -> None:
        """
        Applies the changes, unless an exception ended the block or apply() was called.
        """

    def __repr__(self) -> str: ...

class Gauges:
    """
    Reads the gauges of a World's scene ("gauges" of the scene format): World.gauges() returns it. Flow and force are means since the last read().
    """

    def read(self) -> dict[str, float]:
        """
        The value of each gauge by name. Call it once for the initial state and once after each step. A value is nan where there is none: flow and force in the first call.
        """

    @property
    def units(self) -> dict[str, str]:
        """The unit of each gauge by name: "m", "m^3/s" or "N"."""

    def __repr__(self) -> str: ...

class World:
    """
    A simulation to step, read and control: a scene that was compiled, and its State.

    World(scene) takes a Scene, a dict of the scene format, or the path of a scene file, and raises Error if it cannot be simulated. `threads`: 0 for all of the machine; None: as the scene says. The bits do not depend on it. `forces`: a function of ForceArrays, called once for each object and substep, or a dict of functions by name of object. A World without forces can be pickled.
    """

    def __init__(self, scene: pliant._scene.SceneLike, threads: int | None = None, forces: pliant._types.Forces | None = None) -> None:
        """Makes a World."""

    def step(self, dt: float | None = None) -> Report:
        """
        Advances by one frame of `dt` seconds; None: the scene's frame_time. Does not raise for values that are not finite: see Report.ok. Raises Error if dt is too short for its substeps, and what a force function raises: then the World is back at the State before this step, as by restore(). Keep dt constant. Other Python threads run meanwhile. Ctrl-C ends a long step within a substep; the frame then does not count.
        """

    def run(self, frames: int | None = None) -> Report:
        """
        Runs frames, the scene's own number if None, and returns the last Report. Ends early where Report.ok is false.
        """

    def frames(self, count: int | None = None) -> Iterator[Report]:
        """
        Iterates over frames: each steps once and gives its Report. None: the scene's own number. Ends after a Report that is not ok.
        """

    def stop(self) -> None:
        """
        Ends a step that runs in another thread within a substep: its Report has `stopped`. If none runs, the next one ends before it begins. A Report that has `stopped` ends the effect.
        """

    def forget_forces(self) -> None:
        """
        Forgets the functions of `forces`; later steps are without them. The World still cannot be pickled, copied or saved: make another, and give it this one's state().
        """

    def state(self) -> State:
        """A copy of the State."""

    def restore(self, state: State) -> None:
        """Restores a State of this World. Raises Error if it does not fit."""

    def state_hash(self) -> str:
        """
        The SHA-256 hash of the State: the same on every machine and by any number of threads.
        """

    def __getitem__(self, name: str, /) -> Object:
        """The object of that name. Raises KeyError if there is none."""

    def __contains__(self, name: object, /) -> bool:
        """True if there is an object of that name."""

    def __iter__(self) -> Iterator[str]:
        """Iterates over the names of the objects."""

    def __len__(self) -> int:
        """Number of objects."""

    @property
    def objects(self) -> list[Object]:
        """The objects, by slot."""

    @property
    def colliders(self) -> list[Collider]:
        """The primitive colliders."""

    @property
    def mesh_colliders(self) -> list[MeshCollider]:
        """The mesh colliders."""

    def collider(self, name: str) -> Collider:
        """The primitive collider of that name. Raises KeyError if there is none."""

    def mesh_collider(self, name: str) -> MeshCollider:
        """The mesh collider of that name. Raises KeyError if there is none."""

    def add(self, **members: Any) -> Object:
        """
        Adds an object at the present time, described as in Scene.add(). Raises Error if it cannot be simulated.
        """

    def add_collider(self, **members: Any) -> Collider | MeshCollider:
        """Adds a collider, described as in Scene.add_collider()."""

    def remove(self, thing: Object | Collider | MeshCollider | str) -> None:
        """Removes an object or collider; a name is that of an object."""

    def record_contact_events(self, on: bool = True) -> None:
        """Starts or ends the recording of contact events; off at first."""

    def contact_events(self) -> list[pliant._types.ContactEvent]:
        """
        The contact events of the last step. Raises Error unless record_contact_events() is on.
        """

    def body_touches(self) -> list[pliant._types.BodyTouch]:
        """
        What each rigid body touched in the last step, and how hard. Raises Error unless record_contact_events() is on.
        """

    def record_joint_loads(self, on: bool = True) -> None:
        """
        Starts or ends the recording of mean loads of joints, for Object.mean_joint_load(); off at first.
        """

    def describe(self) -> str:
        """
        Time, sweep, substeps, threads and a line for each object, for people to read.
        """

    @property
    def time(self) -> float:
        """Simulated time [s]."""

    @property
    def frame(self) -> int:
        """Number of complete frames."""

    @property
    def frame_time(self) -> float:
        """Duration of a frame [s]."""

    @property
    def threads(self) -> int:
        """Number of threads."""

    @property
    def isa(self) -> str:
        """Instruction set in use, as "x86-64-v4"; it changes no bits."""

    def kinetic_energy(self) -> float:
        """Kinetic energy of all dynamic particles [J]."""

    def potential_energy(self) -> float:
        """
        Gravitational energy of all dynamic particles [J]; heights are relative to the origin.
        """

    def advice(self, report: Report) -> str:
        """
        Where the solve of a frame fell short, by how much, and what to do; empty if it did not.
        """

    def __repr__(self) -> str: ...

    def edit(self, object: Object | str) -> Edit:
        """
        An Edit of an object, which changes nothing yet: pins, attachments, cuts, stiffness, masses or the whole description. Raises KeyError if there is no object of that name.
        """

    def gauges(self) -> Gauges:
        """
        A reader of the scene's gauges. Starts the recording of contact events where a gauge measures a force. Raises Error if the scene has no gauges, or what one measures was removed. Gauges are not in a saved or pickled World.
        """

    def save(self, path: str | os.PathLike[str]) -> None:
        """
        Saves the World as one file: description, settings and State. Forces and targets that wait for the next step, and what is recorded, are not saved. Raises Error if writing fails; an existing file then stays unchanged.
        """

    @staticmethod
    def load(path: str | os.PathLike[str]) -> World:
        """
        Loads a World that save() wrote; its next step gives the same bits as without saving, if nothing was set for it.
        """

    def __getstate__(self) -> bytes:
        """
        The bytes of the save format: a World can be pickled, unless it has forces. What save() leaves out is left out.
        """

    def __setstate__(self, bytes: bytes) -> None:
        """Reads the bytes of the save format."""

    def writer(self, path: str | os.PathLike[str] | IO[bytes] | None = None, liquid_surfaces: bool = False, *, format: str | None = None) -> Writer:
        """
        A Writer of frames. The suffix of `path` is the format: .obj, .ply, .glb, .usda, .pc2 or .pvd. The present state is the first frame. `liquid_surfaces`: surfaces of liquids instead of points. In memory: without a path, `format` such as 'glb' says what Writer.files will hold; a `path` that is a file object gets the bytes of format 'glb' or 'usda' at finish(). Raises Error if the format is unknown or cannot show the World.
        """

class Writer:
    """
    Writes frames of a World to files or into memory: a context manager that World.writer() returns.
    """

    def add(self) -> None:
        """Adds the present state as the next frame."""

    def finish(self) -> None:
        """Completes the files; the end of a `with` block calls it."""

    @property
    def written(self) -> list[str]:
        """
        Paths of the files that are written, or their names in memory; after finish() all.
        """

    @property
    def files(self) -> dict[str, bytes]:
        """
        The files of a Writer that World.writer(format=...) made, by name: 'frames.glb' and 'frames.usda' after finish(); 'frames_0000.obj' and .ply, and 'frames/OBJECT_0000.vtp' of 'frames.pvd', after each add(); 'frames.pc2' with 'frames.obj'. It is always the same dict: remove what you no longer need. Raises Error if the files are on disk or in a file object.
        """

    def __enter__(self) -> Writer:
        """Itself."""

    def __exit__(self, type: type[BaseException] | None, value: BaseException | None, trace: types.TracebackType | None) -> None:
        """Completes the files, unless an exception ended the block."""

class BatchObject:
    """
    The objects of one name in all worlds of a Batch: batch["name"]. Arrays have the shape (worlds, n, 3). What is not finite or of a wrong shape raises Error, and changes no world.
    """

    @property
    def name(self) -> str:
        """Their name."""

    @property
    def particles(self) -> int:
        """Number of particles of each."""

    def __len__(self) -> int:
        """Number of worlds."""

    def positions(self, out: pliant._types.FloatArray | None = None) -> pliant._types.FloatArray:
        """
        Positions in all worlds [m], shape (worlds, particles, 3). `out`: a C-contiguous float32 array to fill.
        """

    def velocities(self, out: pliant._types.FloatArray | None = None) -> pliant._types.FloatArray:
        """Velocities in all worlds [m/s], shape (worlds, particles, 3)."""

    def set_velocities(self, velocities: pliant._types.AnyArray) -> None:
        """As Object.set_velocities() [m/s]."""

    def add_impulses(self, impulses: pliant._types.AnyArray) -> None:
        """As Object.add_impulses() [N s]."""

    def set_forces(self, forces: pliant._types.AnyArray) -> None:
        """As Object.set_forces() [N]."""

    def set_targets(self, particles: pliant._types.IntsLike, positions: pliant._types.AnyArray) -> None:
        """
        As Object.set_targets(): the same particles in all worlds, positions of shape (worlds, n, 3) [m].
        """

    def set_attachment_targets(self, attachments: pliant._types.IntsLike, positions: pliant._types.AnyArray) -> None:
        """
        As Object.set_attachment_targets(), positions of shape (worlds, n, 3) [m].
        """

    def __repr__(self) -> str: ...

    def poses(self, body: int | str | Sequence[int | str] = 0) -> tuple[pliant._types.FloatArray, pliant._types.FloatArray]:
        """
        Poses of a rigid body: positions [m], shape (worlds, 3), and rotations (x, y, z, w), shape (worlds, 4). Of a list of k bodies: (worlds, k, 3) and (worlds, k, 4).
        """

    def set_pose(self, body: int | str, positions: pliant._types.VectorLike | pliant._types.VectorsLike, rotations: pliant._types.VectorLike | pliant._types.VectorsLike = (0, 0, 0, 1)) -> None:
        """
        As Object.set_pose(): positions of shape (worlds, 3) [m] and rotations of shape (worlds, 4), or one for all worlds.
        """

    def set_motor(self, joint: str | Sequence[str], targets: float | pliant._types.VectorLike | pliant._types.VectorsLike, most: float | pliant._types.VectorLike | pliant._types.VectorsLike | None = None, motor: str = '') -> None:
        """
        As Object.set_motor(), with a target for each world, shape (worlds,), or one for all. Of a list of k joints: shape (worlds, k), or one for all. `most` likewise.
        """

    def joint_states(self, joint: int | str | Sequence[int | str]) -> pliant._types.JointStates:
        """
        Object.joint_state() in all worlds: arrays of shape (worlds, 3), or (worlds, k, 3) of a list of k joints.
        """

    def joint_loads(self, joint: int | str | Sequence[int | str]) -> pliant._types.Loads:
        """
        Object.joint_load() in all worlds: arrays of shape (worlds, 3), or (worlds, k, 3) of a list of k joints.
        """

    def mean_joint_loads(self, joint: int | str | Sequence[int | str]) -> pliant._types.Loads:
        """
        Object.mean_joint_load() likewise. Raises Error unless Batch.record_joint_loads() is on.
        """

class Batch:
    """
    Many worlds of a scene that step side by side, each on one thread, with the bits that it has alone.

    Batch(scene, n) makes n equal worlds. `vary`: values of members that differ, {JSON pointer: n values}, or a function (scene, i) that changes a copy of the scene for world i and returns nothing. `threads`: how many worlds step at once; 0: as many as the machine has threads.
    """

    def __init__(self, scene: pliant._scene.SceneLike, n: int, vary: pliant._scene.Vary | None = None, threads: int = 0) -> None:
        """Makes the worlds, side by side."""

    def step(self, dt: float | None = None) -> list[Report]:
        """
        Advances all worlds by one frame of `dt` seconds; None: the scene's. Returns the Report of each. After Ctrl-C the worlds may be at different frames: restore states() that you kept.
        """

    def run(self, frames: int | None = None) -> list[Report]:
        """
        Runs frames in all worlds, the scene's own number if None, and returns the last Report of each. A world ends early where its Report is not ok.
        """

    def states(self) -> list[State]:
        """The State of each world."""

    def restore(self, state: State | list[State]) -> None:
        """
        Restores one State in all worlds, or a list of one for each. If one does not fit, raises Error, and all have the State that they had; forces, targets and poses that were set for the next step may then be gone.
        """

    def state_hashes(self) -> list[str]:
        """World.state_hash() of each world."""

    @property
    def worlds(self) -> list[World]:
        """The worlds, to read and control one by one."""

    def record_joint_loads(self, on: bool = True) -> None:
        """
        World.record_joint_loads() of each world, for BatchObject.mean_joint_loads().
        """

    def record_contact_events(self, on: bool = True) -> None:
        """
        World.record_contact_events() of each world; batch.worlds have the events.
        """

    def __getitem__(self, name: str, /) -> BatchObject:
        """
        The objects of that name in all worlds. Raises KeyError if a world has none, Error if their numbers of particles differ.
        """

    def __len__(self) -> int:
        """Number of worlds."""

    def __repr__(self) -> str: ...
