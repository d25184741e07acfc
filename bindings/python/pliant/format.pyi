# Made by scripts/python stubs; do not edit.
"""Types of the scene format (docs/reference/scene-format.md): what the dicts of a Scene hold.

They are for editors and type checkers: `scene: pliant.format.Scene = {...}`. At run time each is dict.
"""

from typing import Any, Literal, Sequence, TypedDict

from typing_extensions import Required

from ._types import AnyArray, MeshLike

class Scene(TypedDict, total=False):
    """The root object of a scene file."""

    description: str
    """What the scene shows; Pliant ignores it. Default: none."""
    gravity: Sequence[float] | AnyArray
    """Gravitational acceleration. [m/s^2] Default: [0, -9.81, 0]."""
    wind: Wind
    """Moving air. Default: no air."""
    frame_time: float
    """Duration of a frame. [s] Default: 0.016666668."""
    frames: int
    """Default number of frames of a run. Default: 120."""
    settings: Settings
    """Solver settings. Default: the defaults."""
    objects: Required[Sequence[Object]]
    """The objects, which move."""
    colliders: Sequence[Collider]
    """The colliders, which objects cannot push. Default: none."""
    pairs: Sequence[Pair]
    """Contact properties of single pairs of objects. Default: none."""
    gauges: Sequence[Gauge]
    """Measurements of liquids; they change nothing. Default: none."""
    camera: Camera
    """From where pictures show it. Default: shows the whole scene."""

class Wind(TypedDict, total=False):
    """Moving air that pushes triangles by drag and lift, and bodies that are one capsule, as segments of rods are, by
    drag."""

    velocity: Required[Sequence[float] | AnyArray]
    """Mean velocity. [m/s]"""
    air_density: Required[float]
    """Density of the air: 1.2 at sea level; 0: no air. [kg/m^3]"""
    gust: float
    """Amplitude of the gust as a share of the wind. Default: 0."""
    gust_period: float
    """Period of the gusts. [s] Default: 2."""

class Settings(TypedDict, total=False):
    """How constraints are solved. `threads`, `isa` and the measuring options do not change the result."""

    substeps: int
    """Substeps per frame; 0: they follow strain and motion where chains solve an object; 5 for objects that
    `multigrid` solves, 10 if they can touch surfaces, are in wind or a force field, or have pins that move or lie
    together; 80 to 160 for volumes that chains solve; 20 for all others. Default: 0."""
    iterations: int
    """Iterations per substep. Default: 1."""
    tolerance: float
    """A substep ends its iterations when the root mean square error of its distance constraints falls below this; 0:
    never. [m] Default: 0."""
    threads: int
    """Number of threads; 0: all hardware threads. Default: 0."""
    sweep: Literal['automatic', 'tiled', 'sequential', 'symmetric', 'jacobi', 'natural', 'chains', 'multigrid', 'tethered_chains']
    """The method that projects constraints (docs/internals/sweeps.md), unless an object has its own. `automatic`
    chooses for each object of 32 particles or more: `tethered_chains` for regular cloth and rope that hang from
    pins, `chains` for others that can touch others or themselves, `multigrid` for irregular ones that can meet no
    collider, and `tiled` for volumes at a pressure that their edges resist, PBD stiffness, or several iterations.
    `sequential` is the slow scalar reference with the bits of `tiled`. Default: automatic."""
    sweep_options: SweepOptions
    """Options of sweeps. Default: the defaults."""
    contact_filter: bool
    """Truncate steps so that colliding surfaces never cross (docs/guide/contact.md). Without it only contacts keep
    them apart. Default: true."""
    most_substeps: int
    """Maximum number of substeps of a frame: where they follow the State (in multiples of four), and where a mesh
    collider moves fast (docs/guide/contact.md). Default: 100 (ropes 200) where substeps follow the State, or what a
    volume that they can meet needs; else eight times `substeps`."""
    least_substeps: int
    """Minimum number of substeps of a frame where they follow the State, rounded up to a multiple of four. Default:
    12; 8 for cloth that only hangs by `tethered_chains`."""
    integrator: Literal['pbd', 'energy']
    """How elastic constraints move matter: `pbd` by their forces at the substep's end, which takes (omega h)^2 / 2 of
    the amplitude of a mode in a substep; `energy` by a mean of forces of three times, which takes 1/200 of that
    (docs/guide/choosing_settings.md). Default: pbd."""
    initial_intersections: Literal['leave', 'untangle', 'refuse']
    """Treatment of surfaces that intersect at the start: leave them, move them apart, or refuse the scene. Default:
    leave."""
    untangling_speed: float
    """Speed limit of depenetration. [m/s] Default: 0.5."""
    sleep: Sleep
    """When rigid bodies and grains sleep. Default: off."""
    measure: bool
    """Measure residuals and stretch each frame. Default: false."""
    record_residuals: bool
    """Measure both residuals after every iteration of each frame's last substep; slow. Default: false."""
    record_multipliers: bool
    """Store multipliers for reading even if the solver does not need them. Default: false."""
    isa: Literal['x86-64-v2', 'x86-64-v3', 'x86-64-v4', 'generic', 'sequential']
    """Forces an instruction set that the build holds (PLIANT_LEVELS): the same bits at another speed. Default: the
    best that the machine supports."""

class SweepOptions(TypedDict, total=False):
    """Options of sweeps; docs/internals/sweeps.md says when each helps."""

    relaxation: float
    """Factor of every correction, below 2; above 1 is over-relaxation. Default: 1."""
    sharing: Literal['split', 'average']
    """For `jacobi`: `split` divides a particle's mass among its constraints, which conserves momentum; `average` takes
    the mean of the corrections, which does not. Default: split."""
    acceleration: Literal['none', 'chebyshev']
    """Chebyshev semi-iteration, useful from about 20 iterations per substep; rejected with `natural`. Default: none."""
    plain_iterations: int
    """Iterations of a substep before acceleration starts; at least 2 if the spectral radius is estimated. A substep
    with no more iterations than these is not accelerated. Default: 10."""
    spectral_radius: float
    """Spectral radius of the sweep, below 1; 0: estimated in every substep. Default: 0."""
    tethers: bool
    """Limit every particle's distance from the pins to that along the mesh (long-range attachments). Default: false."""
    tether_slack: float
    """Share by which tether lengths may be exceeded, for cloth that is meant to stretch. Default: 0."""
    chain_softness: float
    """For `chains`: regularises straight rows between two pins; a link stretches by about this times g h^2. Default:
    0.1."""
    most_overstretch: float
    """For `chains` and `multigrid`: the greatest share by which a distance may stay longer than its force explains; 0:
    no limit. Default: 0.05."""
    multigrid_cycles: int
    """For `multigrid`: W-cycles per substep, each a conjugate gradient step. Default: 2."""

class Sleep(TypedDict, total=False):
    """When rigid bodies sleep (docs/guide/bodies.md). They do if `on` is true."""

    on: bool
    """Islands of bodies that have been slow for `time` sleep. Default: false."""
    speed: float
    """Slow: the centre of mass moves by less than this. [m/s] Default: 0.02."""
    spin: float
    """Slow: the body turns by less than this, too. [rad/s] Default: 0.04."""
    time: float
    """For how long all bodies of an island have to be slow. [s] Default: 0.5."""

class Object(TypedDict, total=False):
    """A cloth, a soft body, a rope, a rod, a liquid, a gas, tracers, grains, particles with constraints, rigid bodies,
    or a robot."""

    name: str
    """Unique name, used in messages and files. Default: the kind, with a number if it is taken."""
    cloth: Cloth
    """A cloth, garment or balloon."""
    soft_body: SoftBody
    """An elastic solid."""
    rope: Rope
    """A rope."""
    rod: Rod
    """An elastic rod: a wire, a cable, a spring."""
    liquid: Liquid
    """A liquid."""
    grains: Grains
    """Sand or gravel."""
    gas: Gas
    """A gas."""
    tracers: Tracers
    """Points that gases carry along, as smoke."""
    particles: Particles
    """Particles with constraints."""
    bodies: Sequence[Body]
    """Rigid bodies: one, a pile, or the parts of a mechanism."""
    urdf: Urdf
    """A robot description."""
    joints: Sequence[Joint]
    """Joints between its bodies. Default: none."""
    parts: Sequence[Part]
    """Ropes, rods, cloth and soft bodies that are tied to its bodies. Their particles follow those of the bodies.
    Default: none."""
    velocity: Sequence[float] | AnyArray
    """Initial velocity of all its particles. [m/s] Default: [0, 0, 0]."""
    clusters: Sequence[Cluster]
    """Groups of its particles that keep their shape. Default: none."""
    pins: Sequence[Pin]
    """Kinematic particles. A body whose particle has a pin turns with it, if a keyframe has a rotation; else it is
    free to turn, and a load tips it (`kinematic` of a body). Default: none."""
    attachments: Sequence[Attachment]
    """Particles tied to targets. Default: none."""
    stitches: Sequence[Stitch]
    """Threads that sew its particles together. Default: none."""
    tearing: Tearing
    """Cloth, ropes, rods and soft bodies: at which stretch they tear. Default: none."""
    cuts: Sequence[PlaneCut]
    """Cuts that are made during the simulation. Default: none."""
    absorbency: Absorbency
    """Its triangles take up liquid. Default: none."""
    thickness: float
    """Distance kept from colliders; two surfaces keep the sum of both. [m] Default: the material's; 0.005 for a rope,
    half the spacing for a liquid or gas, the radius of grains, else 0.001."""
    self_collision: bool
    """The surface does not pass through itself; without triangles, the links do not (docs/guide/contact.md). Bodies do
    not pass through each other. Default: false; true for rods and bodies."""
    collides: bool
    """The object does not pass through other objects with `collides`. Mesh colliders always collide. Default: false;
    true for soft bodies, rods, bodies, liquids, gases and grains."""
    groups: Sequence[int] | AnyArray
    """Indices of its groups, 0 to 31. Two objects collide if the `mask` of each contains a group of the other.
    Default: [0]."""
    mask: Sequence[int] | AnyArray
    """Indices of the groups that it collides with; [] for none. Default: all."""
    static_friction: float
    """Coefficient of static friction. Default: the material's; 0 for a liquid or gas, that of grains, else 0.4."""
    kinetic_friction: float
    """Coefficient of kinetic friction, at most the static one. Default: the material's; 0 for a liquid or gas, that of
    grains, else 0.3; at most the static one."""
    restitution: float
    """Coefficient of restitution: the share of the normal speed kept in a bounce. Soft bodies rebound by their
    elasticity instead. Default: 0."""
    rolling_friction: float
    """Of bodies: greatest torque against rolling, per normal force. [m] Default: 0."""
    spinning_friction: float
    """Of bodies: greatest torque about the contact normal, per normal force, in addition to that of friction. [m]
    Default: 0."""
    sweep: Literal['automatic', 'tiled', 'sequential', 'symmetric', 'jacobi', 'natural', 'chains', 'multigrid', 'tethered_chains']
    """The sweep that solves its constraints. `automatic`: the sweep of `settings`, or if that is automatic too, the
    one that measured best on such objects. Default: automatic."""
    drag: float
    """Drag coefficient of a triangle, or of a body that is one capsule, perpendicular to the wind. Default: 1.2."""
    lift: float
    """Lift coefficient. Default: 0.8."""
    damping: float
    """Velocity damping: in a second a share of 1 - exp(-damping) is lost. [1/s] Default: 0."""
    colour: Sequence[float] | AnyArray
    """Colour as linear red, green and blue. Default: [0.75, 0.35, 0.3]."""
    clarity: float
    """In pictures of solids, clusters and closed surfaces: the way in them that leaves a third of the light that is
    not of their colour. Jelly 0.05. 0: opaque. [m] Default: 0."""

class Cloth(TypedDict, total=False):
    """A surface that resists stretching and bending; with `volume`, a balloon."""

    mesh: Required[Mesh | MeshLike]
    """The surface, flat or curved, which is also the rest shape. Any triangle mesh; edges with three or more triangles
    get no bending constraint."""
    material: Literal['cotton', 'silk', 'denim', 'wool', 'leather', 'rubber sheet'] | Fabric
    """The material: the name of a built-in fabric, or a fabric. Default: the defaults of fabric."""
    stretch: Literal['rigid'] | Stiffness
    """Stiffness of every edge; overrides the material's. Default: from the material."""
    bending: Literal['rigid'] | Stiffness
    """Stiffness of every inner edge; overrides the material's. Default: from the material."""
    bending_model: Literal['none', 'dihedral', 'isometric']
    """Bending by dihedral angles, or by the isometric bending energy. Default: dihedral."""
    stretch_model: Literal['springs', 'woven']
    """What resists stretching: edges, alike in all directions, or triangles, by warp, weft and shear of the material.
    Default: springs."""
    warp: Sequence[float] | AnyArray
    """Of woven cloth: direction of the warp in the rest shape; each triangle has its projection. Default: [0, 0, 1]."""
    strain_limit: StrainLimit
    """How far its edges may stretch. Default: none."""
    bending_plasticity: Plasticity
    """Folds beyond an angle stay, as in paper or sheet metal; of dihedral bending only. Default: none."""
    volume: Volume
    """Makes the cloth a balloon; its surface must be closed. Default: none."""

class Mesh(TypedDict, total=False):
    """The source of a surface and its placement: fitted, then scaled, then rotated, then moved. The result is also the
    rest shape."""

    file: str
    """Path of an .obj, .ply or .stl file, relative to the folder of the scene. URLs, devices and pipes are refused."""
    array: str
    """Name of a mesh in memory that the program gives with the scene (SceneReadOptions::arrays)."""
    grid: Grid
    """A rectangle."""
    sphere: SphereMesh
    """A closed sphere."""
    tube: Tube
    """An open tube."""
    box: BoxMesh
    """A closed box."""
    heightfield: Heightfield
    """Terrain."""
    rabbit: Rabbit
    """A closed animal shape."""
    fit: float
    """Scales and moves the mesh so that its longest side has this length, its centre lies above the origin and its
    lowest point at y = 0. For meshes in unknown units. [m] Default: none."""
    scale: float | Sequence[float] | AnyArray
    """Scale factor, one for all axes or one per axis. Default: 1."""
    rotate: Rotation
    """Rotation about the origin. Default: none."""
    translate: Sequence[float] | AnyArray
    """Translation. [m] Default: [0, 0, 0]."""

class Grid(TypedDict, total=False):
    """A flat rectangle in the xz-plane about the origin, facing +y. Vertex (row r, column c) has index r * columns +
    c; columns run along x, rows along z."""

    columns: Required[int]
    """Vertices along x."""
    rows: Required[int]
    """Vertices along z."""
    width: Required[float]
    """Size along x. [m]"""
    depth: Required[float]
    """Size along z. [m]"""

class SphereMesh(TypedDict, total=False):
    """A closed sphere about the origin: a subdivided icosahedron."""

    subdivisions: Required[int]
    """How often each triangle is divided into four."""
    radius: float
    """Radius. [m] Default: 1."""

class Tube(TypedDict, total=False):
    """An open tube around the y-axis, its upper rim at y = 0 and its lower one at y = -length: a sleeve, a skirt.
    Vertex (row r, column c) has index r * columns + c, row 0 being the upper rim."""

    columns: Required[int]
    """Vertices around."""
    rows: Required[int]
    """Vertices along the length, both rims included."""
    length: Required[float]
    """Height. [m]"""
    top_radius: Required[float]
    """Radius of the upper rim. [m]"""
    bottom_radius: Required[float]
    """Radius of the lower rim. [m]"""
    folds: int
    """Waves around the tube; 0 for none. Default: 0."""
    fold_depth: float
    """Height of the waves at the lower rim as a share of its radius; it decreases linearly to 0 at the upper rim.
    Default: 0."""

class BoxMesh(TypedDict, total=False):
    """A closed box about the origin with sides along the axes."""

    size: Required[Sequence[float] | AnyArray]
    """Sizes along x, y and z. [m]"""
    segments: int
    """Squares along each edge; a square is two triangles. Default: 1."""

class Heightfield(TypedDict, total=False):
    """Terrain: a grid with a height at every vertex."""

    columns: Required[int]
    """Vertices along x."""
    rows: Required[int]
    """Vertices along z."""
    width: Required[float]
    """Size along x. [m]"""
    depth: Required[float]
    """Size along z. [m]"""
    heights: Sequence[float] | AnyArray
    """Height of each vertex, row after row: vertex (row r, column c) has index r * columns + c."""
    waves: Waves
    """Heights by a formula."""

class Waves(TypedDict, total=False):
    """Heights h = height sin(2 pi along_x x / width) sin(2 pi along_z z / depth)."""

    height: Required[float]
    """Amplitude of the waves. [m]"""
    along_x: float
    """Waves along x. Default: 1."""
    along_z: float
    """Waves along z. Default: 1."""

class Rabbit(TypedDict, total=False):
    """A closed animal shape to drape things over, sitting on y = 0 and looking along +z."""

    height: float
    """Height from the ground to the tips of the ears. [m] Default: 0.3."""
    cells: int
    """Resolution: grid cells along the height. Default: 40."""

class Rotation(TypedDict, total=False):
    """A rotation about an axis."""

    axis: Required[Sequence[float] | AnyArray]
    """Direction of the axis; any length but zero."""
    degrees: Required[float]
    """Angle, counter-clockwise seen against the axis. [degree]"""

class Fabric(TypedDict, total=False):
    """A fabric in SI units, independent of the mesh. Missing members come from `base`, or else from the defaults."""

    base: Literal['cotton', 'silk', 'denim', 'wool', 'leather', 'rubber sheet']
    """A built-in fabric to start from. Default: none."""
    name: str
    """Its name. Default: none."""
    source: str
    """Source of the numbers. Default: none."""
    area_density: float
    """Mass per area. [kg/m^2] Default: 0.15."""
    thickness: float
    """Thickness; also the distance kept from colliders. [m] Default: 4e-04."""
    stretch_stiffness: Literal['inextensible'] | float
    """Membrane stiffness: force per width and strain; of woven cloth along the warp. Default: 2000."""
    weft_stiffness: float
    """Of woven cloth across the warp. [N/m] Default: 0: that of `stretch_stiffness`."""
    shear_stiffness: float
    """Of woven cloth: shear force per width, over the shear angle in radians; 0: a hundredth of `stretch_stiffness`.
    [N/m] Default: 0."""
    bending_stiffness: float
    """Flexural rigidity per width. [N m] Default: 1e-05."""
    bending_damping: float
    """Fraction of critical damping of bending. Default: 0."""
    static_friction: float
    """Coefficient of static friction. Default: 0.4."""
    kinetic_friction: float
    """Coefficient of kinetic friction, at most the static one. Default: 0.3; at most the static one."""

class Stiffness(TypedDict, total=False):
    """How strongly constraints are enforced. Prefer `compliance`: its effect is independent of time step, substeps and
    iterations."""

    compliance: float
    """XPBD: the inverse stiffness alpha in the unit of the constraint's type; 0 is rigid. [inverse of stiffness; m/N
    for a distance]"""
    stiffness: float
    """PBD: the share k of the error that a step removes. The result depends on the time step and the masses."""
    damping: float
    """XPBD damping beta; only together with `compliance`. A damping time beta * compliance below a substep acts as
    one. [N s/m for a distance] Default: 0."""

class StrainLimit(TypedDict, total=False):
    """How far edges may become shorter or longer: the object yields freely until there, and hardly beyond."""

    least: float
    """Least length over that at rest. Default: 0."""
    most: float
    """Greatest length over that at rest. Default: 1.1."""

Plasticity = TypedDict(
    "Plasticity",
    {
        # Elastic deformation that does not become permanent.
        "yield": 'Required[float]',
        # How fast what is beyond `yield` flows: exp(-rate t) of it is left. 0: at once. With a `yield` of 0 it
        # creeps. [1/s] Default: 0.
        "rate": 'float',
        # Greatest permanent deformation; beyond it the matter is elastic again. Default: no limit.
        "most": 'float',
    },
    total=False,
)
"""How a deformation becomes permanent. It is a strain of tetrahedra and of rods at their surface, and an angle in
radians of hinges."""

class Volume(TypedDict, total=False):
    """A volume constraint: holds the volume inside a closed surface, as in a balloon."""

    pressure: float
    """Rest volume over the volume of the given mesh: above 1 inflates, below 1 deflates. Default: 1."""
    stiffness: Literal['rigid'] | Stiffness
    """Compliance of the constraint on six times the volume, in m^5/N. Default: "rigid"."""
    lift: float
    """By how much the air outside is denser than the gas inside, which bears the surface up by this times g times the
    volume: 1.04 for helium. [kg/m^3] Default: 0."""
    keyframes: Sequence[PressureKeyframe]
    """The pressure follows them instead of `pressure`, linear between. Default: none."""
    leak: float
    """The share of what the pressure is above 1 that leaks out in a second: exp(-leak t) of it is left. [1/s] Default:
    0."""

class PressureKeyframe(TypedDict, total=False):
    """The pressure of a volume at a time."""

    time: Required[float]
    """Time; times increase. [s]"""
    pressure: Required[float]
    """The pressure then."""

class SoftBody(TypedDict, total=False):
    """An elastic solid of tetrahedra. Its border is its surface."""

    tetrahedra: Tetrahedra | MeshLike
    """Its tetrahedra."""
    mesh: Mesh | MeshLike
    """A closed surface, which is filled with tetrahedra of edges of `size`."""
    size: float
    """Only for a mesh: length of the edges of tetrahedra. [m] Default: an eighth of the longest side, less if it is
    thin."""
    material: Literal['gelatine', 'rubber', 'foam', 'muscle'] | ElasticSolid
    """The material: the name of a built-in elastic solid, or an elastic solid. Default: the defaults of elastic solid."""
    fibres: Fibres
    """Fibres in it: a muscle. Default: none."""
    strain_limit: StrainLimit
    """How far the edges of its tetrahedra may stretch. Default: none."""
    skin: bool | Mesh | MeshLike
    """A surface that moves with it, which pictures and files show instead of its border: true for the `mesh` that is
    filled, or another mesh. Default: false."""

class Tetrahedra(TypedDict, total=False):
    """The source of tetrahedra and their placement: fitted, then scaled, then rotated, then moved. The result is also
    the rest shape."""

    file: str
    """Path of a tetrahedral mesh, relative to the folder of the scene: TetGen .node or .ele, Gmsh .msh, VTK .vtk or
    .vtu, Medit .mesh or .meshb, or .t (docs/guide/soft_bodies.md)."""
    array: str
    """Name of tetrahedra in memory that the program gives with the scene."""
    box: BoxOfTetrahedra
    """A box."""
    fit: float
    """Scales and moves the mesh so that its longest side has this length, its centre lies above the origin and its
    lowest point at y = 0. [m] Default: none."""
    scale: float | Sequence[float] | AnyArray
    """Scale factor, one for all axes or one per axis. Default: 1."""
    rotate: Rotation
    """Rotation about the origin. Default: none."""
    translate: Sequence[float] | AnyArray
    """Translation. [m] Default: [0, 0, 0]."""

class BoxOfTetrahedra(TypedDict, total=False):
    """A box about the origin, of cubes that are cut into six tetrahedra each."""

    size: Required[Sequence[float] | AnyArray]
    """Sizes along x, y and z. [m]"""
    cells: Required[Sequence[int] | AnyArray]
    """Number of cubes along x, y and z."""
    cut: Literal['alike', 'mirrored']
    """Whether all cubes are cut along the same diagonal, or those on both sides of the middle as mirror images, so
    that what is dropped level bounces up and not aside. Give even numbers of cubes then. Default: alike."""

class ElasticSolid(TypedDict, total=False):
    """An elastic solid in SI units, independent of the mesh. Missing members come from `base`, or else from the
    defaults."""

    base: Literal['gelatine', 'rubber', 'foam', 'muscle']
    """A built-in elastic solid to start from. Default: none."""
    name: str
    """Its name. Default: none."""
    source: str
    """Source of the numbers. Default: none."""
    density: float
    """Mass per volume. [kg/m^3] Default: 1000."""
    youngs_modulus: float
    """Young's modulus: stress per strain of a bar that is pulled. [Pa] Default: 50000."""
    poisson_ratio: float
    """Poisson's ratio: how much narrower the bar becomes per strain. Default: 0.45."""
    model: Literal['neo_hookean', 'corotational', 'st_venant_kirchhoff']
    """How its energy grows with the strain: all follow Hooke's law at small strain. Default: neo_hookean."""
    damping: float
    """Viscous stress over the elastic modulus times the rate of strain. [s] Default: 0."""
    static_friction: float
    """Coefficient of static friction. Default: 0.6."""
    kinetic_friction: float
    """Coefficient of kinetic friction, at most the static one. Default: 0.5; at most the static one."""
    plasticity: Plasticity
    """Strain beyond which it keeps the new shape, at constant volume. Default: none."""

class Fibres(TypedDict, total=False):
    """Fibres along one direction, which stiffen the solid, and shorten where it is a muscle."""

    direction: Sequence[float] | AnyArray
    """Their direction in the rest shape, of any length but 0. Default: [1, 0, 0]."""
    modulus: float
    """Stress per strain along the fibre, besides that of the solid. [Pa] Default: 1e+05."""
    stretch: Sequence[RestKeyframe]
    """The length that fibres want over their length at rest: 0.6 where a muscle contracts by 40 %. Linear between
    times. Default: 1 at all times."""

class RestKeyframe(TypedDict, total=False):
    """A factor of rest data at a time."""

    time: Required[float]
    """Time; times increase. [s]"""
    factor: Required[float]
    """What rest data are multiplied by then."""

class Rope(TypedDict, total=False):
    """A line of particles at fixed distances."""

    points: Sequence[Sequence[float] | AnyArray] | AnyArray
    """Positions of the particles."""
    line: Line
    """Positions in a straight line."""
    linear_density: float
    """Mass per length. [kg/m] Default: 0.05."""
    stretch: Literal['rigid'] | Stiffness
    """Stiffness of the distances between neighbours. Default: "rigid"."""
    bending: Literal['rigid'] | Stiffness
    """Stiffness of the distances between second neighbours. Default: none."""

Line = TypedDict(
    "Line",
    {
        # First point. [m]
        "from": 'Required[Sequence[float] | AnyArray]',
        # Last point. [m]
        "to": 'Required[Sequence[float] | AnyArray]',
        # Number of points, including both ends.
        "points": 'Required[int]',
    },
    total=False,
)
"""Points in a straight line, evenly spaced."""

class Rod(TypedDict, total=False):
    """An elastic rod, which stretches, shears, bends and twists. Each segment between two points is a rigid body."""

    name: str
    """Its segments are called NAME 0, NAME 1, ... Default: the object's; of a part "rod", with a number if it is
    taken."""
    points: Sequence[Sequence[float] | AnyArray] | AnyArray
    """Places along it."""
    line: Line
    """Places in a straight line."""
    helix: Helix
    """A coil."""
    translate: Sequence[float] | AnyArray
    """Moves the points, after `rotate`. [m] Default: [0, 0, 0]."""
    rotate: Rotation
    """Turns the points about the origin. Default: none."""
    radius: float
    """Radius of its cross-section. [m] Default: 0.005."""
    end_radius: float
    """Radius at the last point, if the rod tapers. [m] Default: as `radius`."""
    material: Literal['steel wire', 'copper wire', 'nylon line', 'hair', 'rubber cord', 'bamboo', 'rope'] | RodMaterial
    """The name of a built-in material, or a material. Default: the defaults of rod material."""
    stiffness: RodStiffness
    """Stiffness of a flat, hollow or stranded cross-section. Default: that of a round section."""
    across: Sequence[float] | AnyArray
    """Direction across the rod about which `bending` acts at its start. Default: any."""
    straight: bool
    """True: the rest shape is straight, whatever the points. False: the points are the rest shape. Default: false."""
    start: RodEnd
    """What holds the first point. Default: free."""
    end: RodEnd
    """What holds the last point. Default: free."""
    repeat: RodRepeat
    """Makes copies of the rod. Default: one rod."""
    break_force: float
    """It breaks where it carries a greater force. [N] Default: unlimited."""
    break_torque: float
    """It breaks where it carries a greater torque. [N m] Default: unlimited."""

class Helix(TypedDict, total=False):
    """Points of a helix about the y-axis, from y = 0 upwards."""

    radius: Required[float]
    """Of the helix, to the middle of the rod. [m]"""
    height: Required[float]
    """From the first point to the last. [m]"""
    turns: Required[float]
    """Number of turns; below 0: left-handed."""
    segments: Required[int]
    """Number of segments of the rod."""

class RodMaterial(TypedDict, total=False):
    """What a rod is made of. Missing members come from `base`, or else from the defaults."""

    base: Literal['steel wire', 'copper wire', 'nylon line', 'hair', 'rubber cord', 'bamboo', 'rope']
    """A built-in material to start from. Default: none."""
    name: str
    """Its name. Default: none."""
    source: str
    """Source of the numbers. Default: none."""
    density: float
    """Mass per volume. [kg/m^3] Default: 1000."""
    youngs_modulus: float
    """Stress per strain of stretching and bending. [Pa] Default: 1e+07."""
    shear_modulus: float
    """Stress per strain of twisting and shearing. [Pa] Default: 3500000."""
    damping: float
    """Stress over elastic modulus and rate of strain. [s] Default: 0."""
    static_friction: float
    """Coefficient of static friction. Default: 0.4."""
    kinetic_friction: float
    """Coefficient of kinetic friction, at most the static one. Default: 0.3; at most the static one."""
    plasticity: Plasticity
    """Strain at the surface beyond which it stays bent or twisted. Default: none."""
    bending_share: float
    """Resistance to bending and twisting over that of a solid rod: less in a rope, whose strands slide. Default: 1."""

class RodStiffness(TypedDict, total=False):
    """Stiffness of a cross-section."""

    stretch: Required[float]
    """E A: force per strain. [N]"""
    shear: Required[float]
    """Force per angle of shear. [N]"""
    bending: Required[float]
    """E I: moment per curvature, about `across`. [N m^2]"""
    bending_2: float
    """About the direction perpendicular to `across` and to the rod. [N m^2] Default: as `bending`."""
    twist: Required[float]
    """G J: torque per rate of twist. [N m^2]"""

class RodEnd(TypedDict, total=False):
    """What holds an end of a rod: a body of the object, or "world"."""

    clamped: str
    """Holds its place and its direction; it does not twist there."""
    ball: str
    """Holds its place; it turns freely."""

class RodRepeat(TypedDict, total=False):
    """Copies of a rod, called NAME_0, NAME_1, ..."""

    grid: RodGrid
    """A field of rods."""
    cap: Cap
    """Rods on a sphere."""

class RodGrid(TypedDict, total=False):
    """Copies at the points of a level grid whose first point is the rod's own place: grass."""

    counts: Required[Sequence[int] | AnyArray]
    """Numbers of copies along x and z."""
    spacing: Required[Sequence[float] | AnyArray]
    """Distances between neighbours along x and z."""

class Cap(TypedDict, total=False):
    """Copies spread evenly over a part of a sphere about +y: hair. The rod's points are described at the origin; each
    copy's y-axis points outward."""

    count: Required[int]
    """Number of copies."""
    centre: Sequence[float] | AnyArray
    """Centre of the sphere. [m] Default: [0, 0, 0]."""
    radius: Required[float]
    """Radius of the sphere. [m]"""
    degrees: float
    """How far from +y copies go; 180: all round. [degrees] Default: 90."""

class Liquid(TypedDict, total=False):
    """A liquid of particles. Liquids with the same spacing, speed of sound, groups and mask mix; others touch as
    spheres do."""

    fill: Fill
    """The box or mesh that it fills at the start. Default: none."""
    positions: Sequence[Sequence[float] | AnyArray] | AnyArray | Points | AnyArray
    """Instead of `fill`: positions of the particles at the start, about a spacing apart. Default: none."""
    spacing: float
    """Distance of particles at rest. [m] Default: 0.02."""
    kind: Literal['water', 'oil', 'glycerine', 'honey']
    """A real liquid, whose density and viscosity are the defaults. Default: none."""
    density: float
    """Density at rest. [kg/m^3] Default: that of `kind`, else 1000."""
    speed_of_sound: float
    """By which it yields to a pressure p: by p / (density c^2). 0: it does not yield. [m/s] Default: 0."""
    viscosity: float
    """Dynamic viscosity: water 0.001, honey 10. 0: none. A liquid with viscosity does not slip along colliders and
    bodies. [Pa s] Default: that of `kind`, else 0."""
    surface_tension: float
    """Surface tension towards air: water 0.072, oil 0.03. 0: none. It needs substeps of at most about 0.05
    sqrt(density spacing^3 / surface_tension). [N/m] Default: 0."""
    contact_angle: float
    """Contact angle on colliders and rigid bodies, if there is surface tension. 180: no adhesion. [degrees] Default:
    180."""
    vorticity: float
    """Vorticity confinement: accelerates by this times N x omega, so that swirls last. 0: none. [m/s] Default: 0."""
    clarity: float
    """In pictures: the way in the liquid that leaves a third of the light that is not of its colour. Water some
    metres, honey 0.02. [m] Default: by the size of the picture."""
    capacity: int
    """Most particles that are there at a time. Default: those at the start."""
    emitters: Sequence[Emitter]
    """What adds particles; needs a `capacity`. Default: none."""
    drains: Sequence[Drain]
    """Solids that take particles away, as each frame begins. Default: none."""
    lifetime: float
    """How long each particle stays. [s] Default: for ever."""

class Fill(TypedDict, total=False):
    """Particles on a cubic lattice that fills an axis-aligned box, from `min` to `max`, or a closed mesh."""

    min: Sequence[float] | AnyArray
    """Corner of the box with the smallest coordinates. [m]"""
    mesh: Mesh | MeshLike
    """A closed mesh, with its placement."""
    max: Sequence[float] | AnyArray
    """Corner of the box with the largest coordinates; only with `min`, which needs it. [m] Default: none."""
    clearance: float
    """Only for a mesh: distance of particles from its surface. Half the spacing if it is a vessel's wall. [m] Default:
    0."""
    jitter: float
    """Displaces each particle along each axis by a random length up to this many spacings, and widens the lattice by
    twice as much, so that none overlap. 0.05 lets grains that fall mix; a block that stands by itself needs 0.2 to
    collapse. Default: 0."""
    seed: int
    """Of the jitter: the same seed gives the same places. Default: 0."""
    leave_out_solids: bool
    """Leaves out particles that would overlap colliders, rigid bodies, soft bodies or other closed surfaces of the
    scene. A closed surface that encloses the whole fill is its vessel. Default: true."""

class Points(TypedDict, total=False):
    """Points in memory."""

    array: Required[str]
    """Name of points that the program gives with the scene (SceneReadOptions::arrays)."""

class Emitter(TypedDict, total=False):
    """Emits layers of particles through a flat opening. It holds two layers behind the opening, where there must be
    room."""

    name: str
    """Name. Default: emitter."""
    position: Sequence[float] | AnyArray
    """Centre of the opening. [m] Default: [0, 0, 0]."""
    direction: Sequence[float] | AnyArray
    """Of what it emits; any length but zero. Default: [0, -1, 0]."""
    across: Sequence[float] | AnyArray
    """Along the width of a rectangle. Default: level."""
    radius: float
    """Radius of a round opening. [m]"""
    size: Sequence[float] | AnyArray
    """Width and height of a rectangle."""
    speed: float
    """Speed through the opening. Give it or `flow`. [m/s] Default: that of `flow`."""
    flow: float
    """Volume of particles a second. [m^3/s] Default: that of `speed`."""
    start: float
    """When it begins. [s] Default: 0."""
    end: float
    """When it ends. [s] Default: never."""
    motion: Motion
    """Motion of the opening; its velocity adds to the speed. Default: none."""

class Motion(TypedDict, total=False):
    """A rigid motion by keyframes: linear between them, constant before the first and after the last."""

    keyframes: Required[Sequence[Keyframe]]
    """The poses."""
    pivot: Sequence[float] | AnyArray
    """Centre of rotation. [m] Default: [0, 0, 0]."""
    repeat: bool
    """Restart after the last keyframe. Default: false."""

class Keyframe(TypedDict, total=False):
    """A rigid pose at a time."""

    time: Required[float]
    """Time of the pose; increases along the list. [s]"""
    position: Sequence[float] | AnyArray
    """Translation from the rest position. [m] Default: [0, 0, 0]."""
    rotation: Rotation
    """Rotation about the motion's `pivot`. From one keyframe to the next about the same axis it turns by all the
    degrees between them, so 0 to 720 are two turns; about another one by the shorter arc. Default: none."""

class Drain(TypedDict, total=False):
    """A solid that takes away the particles of its own object whose centre is in it when a frame begins."""

    name: str
    """Name. Default: drain."""
    plane: Plane
    """A half-space."""
    sphere: Sphere
    """A ball."""
    capsule: Capsule
    """A capsule."""
    box: Box
    """A box."""
    position: Sequence[float] | AnyArray
    """Position of its frame. [m] Default: [0, 0, 0]."""
    rotation: Rotation
    """Rotation of its frame. Default: none."""

class Plane(TypedDict, total=False):
    """The half-space y <= 0 of its frame is solid."""


class Sphere(TypedDict, total=False):
    """A ball."""

    radius: float
    """Radius. [m] Default: 0.5."""

class Capsule(TypedDict, total=False):
    """A cylinder along the y-axis of its frame with half a ball on either end."""

    radius: float
    """Radius. [m] Default: 0.25."""
    half_length: float
    """Half the length of the cylinder, without the caps. [m] Default: 0.5."""

class Box(TypedDict, total=False):
    """A box about the origin of its frame."""

    half_extents: Sequence[float] | AnyArray
    """Half the sizes along x, y and z. [m] Default: [0.5, 0.5, 0.5]."""

class Grains(TypedDict, total=False):
    """Sand or gravel: spheres with friction, which do not turn. Those whose objects meet by groups and masks touch."""

    fill: Fill
    """The box or mesh that it fills at the start, a diameter apart. Default: none."""
    positions: Sequence[Sequence[float] | AnyArray] | AnyArray | Points | AnyArray
    """Instead of `fill`: centres of the grains at the start, a diameter or more apart. Default: none."""
    radius: float
    """Radius of each grain. [m] Default: 0.01."""
    kind: Literal['dry sand', 'wet sand', 'gravel']
    """A real material, whose density, friction and cohesion are the defaults. Default: none."""
    density: float
    """Density of the solid, not of the bulk with its voids. [kg/m^3] Default: that of `kind`, else 2650."""
    friction: float
    """Coefficient of friction of the bulk: tangent of the angle of repose. It is also the default friction with
    colliders. Default: that of `kind`, else 0.6."""
    cohesion: float
    """Tensile stress at which the bulk parts: each contact of two grains bears a pull of 0.87 diameter^2 times this.
    [Pa] Default: that of `kind`, else 0."""
    mass_scaling: float
    """In contacts with others, a grain counts as lighter by exp(-mass_scaling * height): high piles need fewer
    substeps, but momentum is lost. [1/m] Default: 0."""
    capacity: int
    """Most particles that are there at a time. Default: those at the start."""
    emitters: Sequence[Emitter]
    """What adds particles; needs a `capacity`. Default: none."""
    drains: Sequence[Drain]
    """Solids that take particles away, as each frame begins. Default: none."""
    lifetime: float
    """How long each particle stays. [s] Default: for ever."""

class Gas(TypedDict, total=False):
    """A gas of particles, surrounded by air that bears it up. Gases with the same spacing, speed of sound, groups and
    mask mix."""

    fill: Fill
    """The box that it fills at the start."""
    positions: Sequence[Sequence[float] | AnyArray] | AnyArray | Points | AnyArray
    """Positions of the particles at the start, about a spacing apart."""
    preset: Literal['air', 'smoke', 'helium']
    """Density and diffusivity of a gas, surrounded by air; smoke is air at 400 K. Default: none."""
    spacing: float
    """Distance of particles at rest. [m] Default: 0.05."""
    density: float
    """Density at rest, at the ambient temperature. [kg/m^3] Default: that of the preset, else 1.2."""
    speed_of_sound: float
    """By which it yields to a pressure p: by p / (density c^2). 0: it does not yield. [m/s] Default: 0."""
    temperature: float
    """Temperature at the start. [K] Default: that of the preset, else 293.15."""
    ambient_temperature: float
    """Temperature of the air around. [K] Default: 293.15."""
    ambient_density: float
    """Density of the air around: the gas is accelerated by -g (ambient_density / density T / ambient_temperature - 1).
    [kg/m^3] Default: 1.204 with a preset, else 1.2."""
    cooling_time: float
    """Time constant with which it cools to the ambient temperature; 0: it does not. [s] Default: 0."""
    diffusivity: float
    """Diffusivity of heat. [m^2/s] Default: that of the preset, else 0."""
    drag: float
    """Rate at which the wind's velocity is taken by particles without neighbours; others in proportion to the density
    that is missing. [1/s] Default: 0."""
    vorticity: float
    """Coefficient of vorticity confinement. [m/s] Default: 0."""
    heaters: Sequence[Heater]
    """Regions in which it is heated. Default: none."""

class Heater(TypedDict, total=False):
    """Heats or cools the gas in a region: dT/dt = rate (temperature - T)."""

    region: Required[Region]
    """Where it heats."""
    temperature: Required[float]
    """What the gas is heated to. [K]"""
    rate: float
    """How fast. [1/s] Default: 10."""

class Region(TypedDict, total=False):
    """A part of space."""

    box: RegionBox
    """An axis-aligned box."""
    ball: Ball
    """A ball."""

class RegionBox(TypedDict, total=False):
    """An axis-aligned box in space."""

    min: Required[Sequence[float] | AnyArray]
    """Its low corner. [m]"""
    max: Required[Sequence[float] | AnyArray]
    """Its high corner. [m]"""

class Ball(TypedDict, total=False):
    """A ball in space."""

    centre: Required[Sequence[float] | AnyArray]
    """Its centre. [m]"""
    radius: Required[float]
    """Its radius. [m]"""

class Tracers(TypedDict, total=False):
    """Points without weight that gases carry along. They are emitted from a region, and vanish after a lifetime."""

    source: Required[Region]
    """Where they are emitted."""
    capacity: int
    """Most tracers at a time; a new one then replaces the oldest. Default: 10000."""
    rate: float
    """Tracers emitted in a second. [1/s] Default: 1000."""
    lifetime: float
    """After which each vanishes. [s] Default: 4."""
    start: float
    """Time of the first one. [s] Default: 0."""
    end: float
    """Time of the last one; 0: never. [s] Default: 0."""
    radius: float
    """Of a puff in pictures. [m] Default: 0.03."""
    opacity: float
    """Of a puff in pictures: how much of the light through its middle it takes. Default: 0.5."""

class Particles(TypedDict, total=False):
    """Particles with constraints of any type."""

    positions: Required[Sequence[Sequence[float] | AnyArray] | AnyArray | Points | AnyArray]
    """Positions at the start, which are also the rest shape."""
    masses: Required[float | Sequence[float | Literal['fixed']]]
    """One mass for all particles, or one per particle; "fixed" for a particle that never moves."""
    velocities: Sequence[Sequence[float] | AnyArray] | AnyArray
    """One velocity per particle. Default: at rest."""
    frames: Sequence[Frame]
    """Orientations that constraints connect with the particles. Default: none."""
    constraints: Sequence[Constraints]
    """Constraints between the particles. Default: none."""
    triangles: Sequence[Sequence[int] | AnyArray]
    """The surface for air, volume and pictures, counter-clockwise seen from outside. Default: none."""
    volume: Volume
    """Pressure inside the surface, which must be closed. Default: none."""

class Frame(TypedDict, total=False):
    """An orientation with inertia, for constraints that have frame slots: a rigid body is a particle and a frame."""

    orientation: Rotation
    """Rotation of the principal axes at the start. Default: none."""
    angular_velocity: Sequence[float] | AnyArray
    """Angular velocity at the start, in world axes. [rad/s] Default: [0, 0, 0]."""
    inertia: Required[Sequence[float] | AnyArray | Literal['fixed']]
    """Moments of inertia about the principal axes, above 0; "fixed" for a frame that never rotates."""

class Constraints(TypedDict, total=False):
    """Constraints of one type, built-in or registered. constraints.md lists the particles and rest data of each type."""

    type: Required[Literal['distance', 'dihedral_bending', 'isometric_bending', 'fibre', 'tetrahedron_shear', 'tetrahedron_volume', 'triangle_shear', 'triangle_stretch', 'distance_limit', 'volume_around_edge', 'corotational_strain', 'green_strain', 'green_trace', 'joint_angle_motor', 'joint_offset_motor', 'joint_angle', 'joint_offset', 'joint_swing', 'joint_distance', 'pulley_joint', 'gear_joint', 'rack_joint', 'planar_joint', 'cylindrical_joint', 'universal_joint', 'slider_joint', 'ball_joint', 'hinge_joint', 'rod_joint', 'fixed_joint', 'body_anchor', 'point_on_triangle', 'point_in_tetrahedron']]
    """The constraint type."""
    particles: Required[Sequence[Sequence[int] | AnyArray]]
    """The particles of each constraint; for a frame slot, the index of a frame."""
    rest: Sequence[Sequence[float] | AnyArray] | AnyArray
    """Rest data of each constraint. Default: measured from the positions."""
    stiffness: Literal['rigid'] | Stiffness
    """Stiffness of all of these constraints. Default: "rigid"."""
    compliances: Sequence[float] | AnyArray
    """One compliance per constraint; overrides the one in `stiffness`. Default: none."""
    plasticity: Plasticity
    """Deformation that becomes permanent, of tetrahedron_shear, corotational_strain, green_strain, green_trace,
    dihedral_bending and rod_joint. Default: none."""
    keyframes: Sequence[RestKeyframe]
    """Factors of the rest data of distance, distance_limit, tetrahedron_volume or fibre, linear between. Default:
    none."""
    break_force: float
    """Force at which one of them breaks, of distance, distance_limit, point_on_triangle and point_in_tetrahedron with
    a compliance; 0: they hold. [N] Default: 0."""

class Body(TypedDict, total=False):
    """A rigid body. Its position and rotation are those of the frame in which its solids are described; its particle
    is its centre of mass."""

    name: str
    """Unique in the object, used in messages and files. Default: "body", with a number if it is taken."""
    solids: Required[Sequence[Solid]]
    """Its solids, which may overlap: each counts with its own mass."""
    position: Sequence[float] | AnyArray
    """Position at the start. [m] Default: [0, 0, 0]."""
    rotation: Rotation
    """Rotation at the start. Default: none."""
    velocity: Sequence[float] | AnyArray
    """Velocity of its centre of mass at the start. [m/s] Default: the object's."""
    angular_velocity: Sequence[float] | AnyArray
    """Angular velocity at the start, in world axes. [rad/s] Default: [0, 0, 0]."""
    mass: float | Literal['fixed']
    """Replaces the mass that the densities give; "fixed" for a body that never moves. Default: from the densities."""
    kinematic: bool
    """True: infinite mass. Nothing pushes or turns the body; it carries what lies on it, and follows `motion`, or the
    poses that a program sets. Default: false."""
    motion: Motion
    """Motion of a kinematic body from that pose; as everywhere about a `pivot` in the world. Copies share it. Default:
    none."""
    surface_velocity: Sequence[float] | AnyArray
    """Velocity in the body's frame with which its surface moves along itself, as that of a belt or track: friction
    takes along what it touches, or drives the body. [m/s] Default: [0, 0, 0]."""
    repeat: Repeat
    """Makes copies of the body. Default: one body."""

class Solid(TypedDict, total=False):
    """A solid of a rigid body."""

    sphere: Sphere
    """A ball."""
    capsule: Capsule
    """A capsule."""
    box: Box
    """A box."""
    cylinder: Cylinder
    """A cylinder."""
    cone: Cone
    """A cone."""
    hull: Hull
    """A convex hull."""
    concave: Concave
    """A concave solid; a hull takes less time."""
    position: Sequence[float] | AnyArray
    """Position of the solid's frame in that of the body. [m] Default: [0, 0, 0]."""
    rotation: Rotation
    """Rotation of the solid's frame in that of the body. Default: none."""
    density: float
    """Density. [kg/m^3] Default: 1000."""

class Cylinder(TypedDict, total=False):
    """A cylinder along the y-axis of its frame, about its middle."""

    radius: float
    """Radius. [m] Default: 0.25."""
    half_length: float
    """Half the length. [m] Default: 0.5."""

class Cone(TypedDict, total=False):
    """A cone along the y-axis of its frame: its base at -half_length, its apex at half_length."""

    radius: float
    """Radius of the base. [m] Default: 0.25."""
    half_length: float
    """Half the height. [m] Default: 0.5."""

class Hull(TypedDict, total=False):
    """The convex hull of points, or of the vertices of a mesh."""

    points: Sequence[Sequence[float] | AnyArray] | AnyArray
    """Points that do not lie in one plane."""
    mesh: Mesh | MeshLike
    """The mesh; its hollows are filled."""
    margin: float
    """Distance by which the hull is grown; it has no mass. [m] Default: 0."""

class Concave(TypedDict, total=False):
    """What a closed mesh encloses, divided into convex pieces."""

    mesh: Required[Mesh | MeshLike]
    """The mesh."""
    tolerance: float
    """By how much pieces may fill hollows of the mesh. [m] Default: 2 % of the mesh's longest side."""
    most_pieces: int
    """Greatest number of pieces; where more would be needed, hollows are filled further. Default: 32."""
    most_corners: int
    """Greatest number of a piece's corners. Default: 64."""

class Repeat(TypedDict, total=False):
    """Copies of a body, named NAME_0, NAME_1, ..."""

    grid: BodyGrid
    """A grid, tower, row or heap."""
    pyramid: Pyramid
    """A pyramid."""
    spiral: Spiral
    """A spiral."""

class BodyGrid(TypedDict, total=False):
    """Copies at the points of a grid; a tower is a grid of counts [1, n, 1]. Copy (x, y, z) has index (z counts[1] +
    y) counts[0] + x."""

    counts: Required[Sequence[int] | AnyArray]
    """Numbers of copies along x, y and z."""
    spacing: Required[Sequence[float] | AnyArray]
    """Distances between neighbours along x, y and z. [m]"""
    jitter: float
    """Largest random displacement along each axis. [m] Default: 0."""
    tumbled: bool
    """Gives each copy a random rotation. Default: false."""
    seed: int
    """Seed of jitter and rotations: the same seed gives the same bodies. Default: 0."""

class Pyramid(TypedDict, total=False):
    """Copies in rows along x, each with one fewer than the row below and over its gaps."""

    base: Required[int]
    """Number of copies in the lowest row; also the number of rows."""
    spacing: Required[float]
    """Distance between the centres of neighbours in a row. [m]"""
    rise: Required[float]
    """Distance between rows along y. [m]"""
    square: bool
    """Layers of base x base copies along x and z instead of rows. Default: false."""

class Spiral(TypedDict, total=False):
    """Copies on a circle or spiral about the y-axis through the body's position; the -z axis of each points along the
    line."""

    count: Required[int]
    """Number of copies."""
    radius: Required[float]
    """Radius at the first copy, which lies on the +x side of the axis. [m]"""
    spacing: Required[float]
    """Distance between neighbours along the line. [m]"""
    pitch: float
    """Growth of the radius in each turn; 0: a circle. [m] Default: 0."""

class Urdf(TypedDict, total=False):
    """Rigid bodies and joints from a robot description in URDF. `pliant check` names what the reader ignores."""

    file: Required[str]
    """Path of the .urdf file, relative to the folder of the scene."""
    position: Sequence[float] | AnyArray
    """Position of the root link. [m] Default: [0, 0, 0]."""
    rotation: Rotation
    """Rotation of the root link. Default: none."""
    z_up: bool
    """The file's z-axis points up. Default: true."""
    fixed_base: bool
    """Joins a root link with mass to the world. Default: false."""
    motors: bool
    """Joints with an effort limit hold their position. Default: false."""
    targets: Sequence[JointTarget]
    """Positions to which motors move joints. Default: none."""

class JointTarget(TypedDict, total=False):
    """Where the motor of a joint moves it."""

    joint: Required[str]
    """Name of a joint in the file."""
    angle: float
    """Angle of a revolute or continuous joint. [degree]"""
    displacement: float
    """Displacement of a prismatic joint. [m]"""

class Joint(TypedDict, total=False):
    """A joint between two bodies of the object, or a body and the world. The two do not collide with each other."""

    name: str
    """Name, used in messages and reports. Default: the kind, with its number."""
    between: Required[Sequence[str]]
    """Names of the two bodies; "world" as the first one for the world."""
    ball: BallJoint
    """A shared point."""
    fixed: FixedJoint
    """No freedom."""
    hinge: HingeJoint
    """Rotation about an axis."""
    slider: SliderJoint
    """Displacement along an axis."""
    cylindrical: CylindricalJoint
    """Both."""
    universal: UniversalJoint
    """Rotation about two axes."""
    planar: PlanarJoint
    """Motion in a plane."""
    distance: DistanceJoint
    """A rod or a rope."""
    spring: SpringJoint
    """A spring with a damper."""
    pulley: PulleyJoint
    """A rope over two pulleys."""
    gear: GearJoint
    """A ratio of two rotations."""
    rack: RackJoint
    """A ratio of a rotation and a displacement."""
    six_axis: SixAxisJoint
    """Freedom chosen for each axis."""
    carrier: str
    """Only for pulley, gear and rack: the body that has the pulleys or axes. Default: the world."""
    compliance: float
    """Compliance of locked directions; 0: rigid. [m/N and rad/(N m)] Default: 0."""
    damping: float
    """Damping of locked directions; only together with `compliance`. [N s/m and N m s/rad] Default: 0."""
    break_force: float
    """The joint breaks when it carries a greater force. [N] Default: unbreakable."""
    break_torque: float
    """The joint breaks when it carries a greater torque. [N m] Default: unbreakable."""
    repeat: JointCopies
    """Makes copies of the joint. Default: one joint."""

class BallJoint(TypedDict, total=False):
    """The two bodies share a point and rotate freely about it."""

    anchor: Required[Sequence[float] | AnyArray]
    """The point that both bodies share, in the world at the start. [m]"""
    axis: Sequence[float] | AnyArray
    """An axis of both bodies: its angle between them is the swing. Default: [1, 0, 0]."""
    most_swing: float
    """Greatest swing. [degree] Default: no limit."""
    twist: AngleRange
    """Range of the rotation about the axis. Default: no limit."""
    friction: float
    """Greatest torque of friction about each axis. [N m] Default: 0."""

class AngleRange(TypedDict, total=False):
    """Stops of an angle. At the start, the angle is 0."""

    low: Required[float]
    """Lower end. [degree]"""
    high: Required[float]
    """Upper end, at most a turn above the lower one. [degree]"""
    compliance: float
    """Compliance of the stops; 0: rigid. [rad/(N m)] Default: 0."""

class FixedJoint(TypedDict, total=False):
    """The two bodies move as one."""

    anchor: Required[Sequence[float] | AnyArray]
    """The point that both bodies share, in the world at the start. [m]"""

class HingeJoint(TypedDict, total=False):
    """The second body rotates about one axis of the first."""

    anchor: Required[Sequence[float] | AnyArray]
    """The point that both bodies share, in the world at the start. [m]"""
    axis: Sequence[float] | AnyArray
    """The axis, in the world at the start. Default: [0, 0, 1]."""
    limit: AngleRange
    """Range of the angle. Default: no limit."""
    motor: RotaryMotor
    """Drives the angle. Default: none."""
    friction: float
    """Greatest torque of friction. [N m] Default: 0."""
    damping: float
    """Torque over angular velocity. [N m s/rad] Default: 0."""
    spring: RotarySpring
    """Pulls the angle towards its rest. Default: none."""

class RotaryMotor(TypedDict, total=False):
    """Drives an angle, at a speed, to a position, or by a torque."""

    speed: float
    """Speed to keep. [degree/s]"""
    position: float
    """Angle to move to, at the remaining angle times `rate`. [degree]"""
    torque: float
    """Torque. [N m]"""
    keyframes: Sequence[KeyframeOfARotaryMotor]
    """The target by time, instead of the one above. Default: none."""
    most: float
    """Greatest torque, without `torque`. [N m] Default: 1."""
    rate: float
    """Only with `position`: speed over remaining angle. [1/s] Default: 10."""
    most_speed: float
    """Only with `position`: greatest speed. [degree/s] Default: no limit."""

class KeyframeOfARotaryMotor(TypedDict, total=False):
    """The target of a motor at a time: linear between keyframes, constant outside."""

    time: Required[float]
    """Time, after that of the keyframe before. [s]"""
    target: Required[float]
    """Target. [degree, degree/s or N m]"""

class RotarySpring(TypedDict, total=False):
    """Pulls an angle towards its rest."""

    rest: float
    """Angle at which it has no torque. [degree] Default: 0."""
    stiffness: Required[float]
    """Torque over angle. [N m/rad]"""
    damping: float
    """Torque over angular velocity. [N m s/rad] Default: 0."""

class SliderJoint(TypedDict, total=False):
    """The second body slides along one axis of the first."""

    anchor: Required[Sequence[float] | AnyArray]
    """The point that both bodies share, in the world at the start. [m]"""
    axis: Sequence[float] | AnyArray
    """The axis, in the world at the start. Default: [1, 0, 0]."""
    limit: DisplacementRange
    """Range of the displacement. Default: no limit."""
    motor: LinearMotor
    """Drives the displacement. Default: none."""
    friction: float
    """Greatest force of friction. [N] Default: 0."""
    damping: float
    """Force over speed. [N s/m] Default: 0."""
    spring: LinearSpring
    """Pulls the displacement. Default: none."""

class DisplacementRange(TypedDict, total=False):
    """Stops of a displacement. At the start, the displacement is 0."""

    low: Required[float]
    """Lower end. [m]"""
    high: Required[float]
    """Upper end. [m]"""
    compliance: float
    """Compliance of the stops; 0: rigid. [m/N] Default: 0."""

class LinearMotor(TypedDict, total=False):
    """Drives a displacement, at a speed, to a position, or by a force."""

    speed: float
    """Speed to keep. [m/s]"""
    position: float
    """Displacement to move to, at the remaining displacement times `rate`. [m]"""
    force: float
    """Force. [N]"""
    keyframes: Sequence[KeyframeOfALinearMotor]
    """The target by time, instead of the one above. Default: none."""
    most: float
    """Greatest force, without `force`. [N] Default: 1."""
    rate: float
    """Only with `position`: speed over remaining displacement. [1/s] Default: 10."""
    most_speed: float
    """Only with `position`: greatest speed. [m/s] Default: no limit."""

class KeyframeOfALinearMotor(TypedDict, total=False):
    """The target of a motor at a time: linear between keyframes, constant outside."""

    time: Required[float]
    """Time, after that of the keyframe before. [s]"""
    target: Required[float]
    """Target. [m, m/s or N]"""

class LinearSpring(TypedDict, total=False):
    """Pulls a displacement towards its rest."""

    rest: float
    """Displacement without force. [m] Default: 0."""
    stiffness: Required[float]
    """Force over displacement. [N/m]"""
    damping: float
    """Force over speed. [N s/m] Default: 0."""

class CylindricalJoint(TypedDict, total=False):
    """The second body slides along one axis of the first, and rotates about it."""

    anchor: Required[Sequence[float] | AnyArray]
    """The point that both bodies share, in the world at the start. [m]"""
    axis: Sequence[float] | AnyArray
    """The axis, in the world at the start. Default: [1, 0, 0]."""
    slide_limit: DisplacementRange
    """Range of the displacement. Default: no limit."""
    turn_limit: AngleRange
    """Range of the angle. Default: no limit."""
    slide_motor: LinearMotor
    """Drives the displacement. Default: none."""
    turn_motor: RotaryMotor
    """Drives the angle. Default: none."""
    slide_friction: float
    """Greatest force of friction. [N] Default: 0."""
    turn_friction: float
    """Greatest torque of friction. [N m] Default: 0."""
    slide_spring: LinearSpring
    """Pulls the displacement towards its rest. Default: none."""
    turn_spring: RotarySpring
    """Pulls the angle towards its rest. Default: none."""

class UniversalJoint(TypedDict, total=False):
    """Two axes, one of each body, that cross at the anchor and stay perpendicular."""

    anchor: Required[Sequence[float] | AnyArray]
    """The point that both bodies share, in the world at the start. [m]"""
    axis_a: Sequence[float] | AnyArray
    """The axis fixed in the first body. Default: [1, 0, 0]."""
    axis_b: Sequence[float] | AnyArray
    """The axis fixed in the second body. Default: [0, 1, 0]."""
    limit_a: AngleRange
    """Range of the angle about axis_a. Default: no limit."""
    limit_b: AngleRange
    """Range of the angle about axis_b. Default: no limit."""
    motor_a: RotaryMotor
    """Drives the angle about axis_a. Default: none."""
    motor_b: RotaryMotor
    """Drives the angle about axis_b. Default: none."""
    friction_a: float
    """Greatest torque of friction about axis_a. [N m] Default: 0."""
    friction_b: float
    """Greatest torque of friction about axis_b. [N m] Default: 0."""
    spring_a: RotarySpring
    """Pulls the angle about axis_a towards its rest. Default: none."""
    spring_b: RotarySpring
    """Pulls the angle about axis_b towards its rest. Default: none."""

class PlanarJoint(TypedDict, total=False):
    """The second body slides in a plane of the first, and rotates about its normal."""

    anchor: Required[Sequence[float] | AnyArray]
    """The point that both bodies share, in the world at the start. [m]"""
    normal: Sequence[float] | AnyArray
    """Normal of the plane. Default: [0, 1, 0]."""
    axis_x: Sequence[float] | AnyArray
    """Direction x in the plane; y is the normal times x. Needed for limits, motors and springs of displacements.
    Default: none."""
    x_limit: DisplacementRange
    """Range of the displacement along x. Default: no limit."""
    y_limit: DisplacementRange
    """Range of the displacement along y. Default: no limit."""
    turn_limit: AngleRange
    """Range of the angle about the normal. Default: no limit."""
    x_motor: LinearMotor
    """Drives the displacement along x. Default: none."""
    y_motor: LinearMotor
    """Drives the displacement along y. Default: none."""
    turn_motor: RotaryMotor
    """Drives the angle about the normal. Default: none."""
    slide_friction: float
    """Greatest force of friction along x, and along y. [N] Default: 0."""
    turn_friction: float
    """Greatest torque of friction. [N m] Default: 0."""
    x_spring: LinearSpring
    """Pulls the displacement along x. Default: none."""
    y_spring: LinearSpring
    """Pulls the displacement along y. Default: none."""
    turn_spring: RotarySpring
    """Pulls the angle about the normal. Default: none."""

class DistanceJoint(TypedDict, total=False):
    """Two points keep their distance, as with a rod, or stay in a range of distances, as with a rope."""

    anchors: Required[Sequence[Sequence[float] | AnyArray] | AnyArray]
    """A point of each body, in the world at the start."""
    least: float
    """Least distance. [m] Default: without `most` that at the start, else 0."""
    most: float
    """Greatest distance. [m] Default: without `least` that at the start, else no limit."""

class SpringJoint(TypedDict, total=False):
    """A spring between two points, with a damper beside it."""

    anchors: Required[Sequence[Sequence[float] | AnyArray] | AnyArray]
    """A point of each body, in the world at the start."""
    rest_length: float
    """Length at which it exerts no force. [m] Default: the distance at the start."""
    stiffness: float
    """Force over extension. [N/m] Default: 1000."""
    damping: float
    """Force over speed. [N s/m] Default: 0."""

class PulleyJoint(TypedDict, total=False):
    """A rope from the first body over two pulleys to the second one. Its length does not grow."""

    anchors: Required[Sequence[Sequence[float] | AnyArray] | AnyArray]
    """A point of each body, in the world at the start."""
    pulleys: Required[Sequence[Sequence[float] | AnyArray] | AnyArray]
    """The two pulleys, at the start."""
    ratio: float
    """Of a tackle: the force on the second body over that on the first. Default: 1."""

class GearJoint(TypedDict, total=False):
    """Two bodies rotate about axes fixed in a third, the carrier: one angle times its teeth plus the other times its
    teeth is constant. The hinges are joints of their own."""

    axes: Required[Sequence[Sequence[float] | AnyArray] | AnyArray]
    """The axis of each body, in the world at the start."""
    teeth: Required[Sequence[int] | AnyArray]
    """Number of teeth of each; different signs for an inner gear or a belt, which turn the second body like the first."""

class RackJoint(TypedDict, total=False):
    """A pinion, the first body, that rotates about an axis moves a rack, the second one. Hinge and slider are joints
    of their own."""

    axis: Sequence[float] | AnyArray
    """Axis of the pinion, in the world at the start. Default: [0, 0, 1]."""
    direction: Sequence[float] | AnyArray
    """Direction in which the rack moves as the angle grows. Default: [1, 0, 0]."""
    radius: float
    """Radius of the pinion. [m] Default: 0.1."""

class SixAxisJoint(TypedDict, total=False):
    """The freedom along, and about, each of three axes is chosen."""

    anchor: Required[Sequence[float] | AnyArray]
    """The point that both bodies share, in the world at the start. [m]"""
    rotation: Rotation
    """Rotation of the joint's axes at the start. Default: none."""
    linear: Required[Sequence[Literal['free', 'locked'] | DisplacementFreedom]]
    """Displacements along x, y and z."""
    angular: Required[Sequence[Literal['free', 'locked'] | AngleFreedom]]
    """Rotations about x, y and z."""

class DisplacementFreedom(TypedDict, total=False):
    """Freedom along one axis."""

    limit: DisplacementRange
    """Range of the displacement. Default: no limit."""
    motor: LinearMotor
    """Drives the displacement. Default: none."""
    friction: float
    """Greatest force of friction. [N] Default: 0."""
    spring: LinearSpring
    """Pulls the displacement. Default: none."""

class AngleFreedom(TypedDict, total=False):
    """Freedom about one axis."""

    limit: AngleRange
    """Range of the angle. Default: no limit."""
    motor: RotaryMotor
    """Drives the angle. Default: none."""
    friction: float
    """Greatest torque of friction. [N m] Default: 0."""
    spring: RotarySpring
    """Pulls the angle. Default: none."""

class JointCopies(TypedDict, total=False):
    """Copies of a joint along a row of bodies: in copy k, the numbers at the ends of the bodies' names are greater by
    k."""

    count: Required[int]
    """Number of joints, the first included."""
    step: Required[Sequence[float] | AnyArray]
    """Displacement of the anchors from copy to copy. [m]"""

class Part(TypedDict, total=False):
    """A rope, rod, cloth, soft body or particles that belong to an object of bodies, and are tied to them. Properties
    such as `thickness` and friction are those of the object."""

    cloth: Cloth
    """A cloth; not a balloon."""
    soft_body: SoftBody
    """A soft body."""
    rope: Rope
    """A rope."""
    rod: Rod
    """An elastic rod, which is tied by its `start` and `end` alone."""
    particles: Particles
    """Particles with constraints."""
    ties: Sequence[Tie]
    """What ties it to bodies. What is tied to a body does not touch it. Default: none."""
    pins: Sequence[Pin]
    """Kinematic particles; indices count from the part's first one. Default: none."""
    attachments: Sequence[Attachment]
    """Particles tied to targets. Default: none."""

class Tie(TypedDict, total=False):
    """Ties particles of a part to places of a body, where they are at the start."""

    particles: Required[Literal['all', 'corners', 'ends'] | Sequence[int] | AnyArray | Selection]
    """The particles: indices, a selection, or "all", "corners" (of a grid) or "ends" (the first and the last)."""
    body: Required[str]
    """Name of the body."""
    stiffness: Literal['rigid'] | Stiffness
    """Stiffness of the ties. Default: "rigid"."""

class Selection(TypedDict, total=False):
    """Particles selected by their rest positions."""

    box: BoxOfParticles
    """The particles inside a box."""
    nearest: Sequence[float] | AnyArray
    """The particle nearest to a point. [m]"""

class BoxOfParticles(TypedDict, total=False):
    """The particles inside an axis-aligned box or on its surface."""

    min: Required[Sequence[float] | AnyArray]
    """Corner with the smallest coordinates. [m]"""
    max: Required[Sequence[float] | AnyArray]
    """Corner with the largest coordinates. [m]"""

class Pin(TypedDict, total=False):
    """Kinematic particles, which stay in place or follow a motion."""

    particles: Required[Literal['all', 'corners', 'ends'] | Sequence[int] | AnyArray | Selection]
    """The particles: indices, a selection, or "all", "corners" (of a grid) or "ends" (the first and the last)."""
    motion: Motion
    """Motion of the particles from their rest positions. Default: none."""

class Attachment(TypedDict, total=False):
    """Ties particles to targets by distance constraints of rest length 0; targets may move."""

    particles: Required[Literal['all', 'corners', 'ends'] | Sequence[int] | AnyArray | Selection]
    """The particles: indices, a selection, or "all", "corners" (of a grid) or "ends" (the first and the last)."""
    target: Sequence[float] | AnyArray
    """Position of the target at time 0. [m] Default: each particle's position."""
    motion: Motion
    """Motion of the targets. Default: none."""
    stiffness: Literal['rigid'] | Stiffness
    """Stiffness of the attachment. Default: "rigid"."""

class Cluster(TypedDict, total=False):
    """Particles that keep the shape in which they are at the start: shape matching."""

    particles: Literal['all', 'corners', 'ends'] | Sequence[int] | AnyArray | Selection
    """The particles: indices, a selection, or "all", "corners" (of a grid) or "ends" (the first and the last).
    Default: "all"."""
    size: float
    """Divides all particles into overlapping clusters of cells of this size, so that the whole bends; instead of
    `particles`. [m] Default: none."""
    mode: Literal['rigid', 'linear', 'quadratic']
    """What the shape may do to fit: move and turn; also stretch and shear; also bend and twist. Default: rigid."""
    share: float
    """Share of the deformation that `linear` and `quadratic` keep. Default: 0.8."""
    stiffness: Literal['rigid'] | Stiffness
    """Stiffness; the compliance is per mass, in s^2: particles swing at 1 / (2 pi sqrt(compliance)) Hz. Default:
    "rigid"."""
    plasticity: Plasticity
    """How strain becomes permanent: the shape takes on what it is stretched and sheared by. Needs a stiffness that
    yields. Default: none."""

class Stitch(TypedDict, total=False):
    """Threads between particles, each to the nearest of others: they become shorter until both meet, and never push."""

    particles: Required[Literal['all', 'corners', 'ends'] | Sequence[int] | AnyArray | Selection]
    """The particles: indices, a selection, or "all", "corners" (of a grid) or "ends" (the first and the last)."""
    to: Required[Literal['all', 'corners', 'ends'] | Sequence[int] | AnyArray | Selection]
    """The particles of the other side."""
    closing_time: float
    """Until when threads shorten from the distance at the start to nothing; 0: at once. [s] Default: 0."""
    stiffness: Literal['rigid'] | Stiffness
    """Stiffness of the threads. Default: "rigid"."""
    break_force: float
    """Force at which a thread breaks, which needs a compliance; 0: they hold. [N] Default: 0."""

class Tearing(TypedDict, total=False):
    """The object tears at edges, tetrahedra and joints of rods that become too long."""

    stretch: Required[float]
    """Greatest length over that at rest."""

class PlaneCut(TypedDict, total=False):
    """A cut along a plane of the object's rest shape, by a blade that passes through it. It follows faces of
    tetrahedra, edges of triangles, links of ropes and joints of rods."""

    start: float
    """When the blade enters the object. [s] Default: 0."""
    end: float
    """When the blade has passed. [s] Default: `start`: all at once."""
    point: Sequence[float] | AnyArray
    """A point of the plane, in the object's rest shape. [m] Default: [0, 0, 0]."""
    normal: Sequence[float] | AnyArray
    """Normal of the plane, of any length but 0. Default: [1, 0, 0]."""
    along: Sequence[float] | AnyArray
    """The way of the blade, not parallel to `normal`. Default: [0, -1, 0]."""

class Absorbency(TypedDict, total=False):
    """The surface takes up liquid that touches it, gets heavier, and drips (docs/guide/wet_cloth.md)."""

    capacity: float
    """Most liquid that it holds against gravity. [kg/m^2] Default: 0.5."""
    uptake: float
    """Speed at which liquid soaks in while it is not full. [m/s] Default: 0.1."""
    wicking: float
    """Diffusivity of the liquid along it. [m^2/s] Default: 1e-04."""
    rise: float
    """How high it draws liquid up against gravity. [m] Default: 0.3."""
    runoff: float
    """Speed at which what is more than `capacity` runs down it. [m/s] Default: 0.05."""
    seepage: float
    """Speed at which liquid that lies on it passes through where it is full. [m/s] Default: 0."""
    drag: float
    """Rate at which liquid that touches it takes on its velocity. [1/s] Default: 0."""

Collider = TypedDict(
    "Collider",
    {
        # Unique name. Default: the shape, with a number if it is taken.
        "name": 'str',
        # A half-space.
        "plane": 'Plane',
        # A ball.
        "sphere": 'Sphere',
        # A capsule.
        "capsule": 'Capsule',
        # A box.
        "box": 'Box',
        # A static or kinematic surface, closed or open, that collides on both sides. `position` and `rotation` apply
        # after the mesh's own placement.
        "mesh": 'Mesh | MeshLike',
        # Position of the collider's frame. [m] Default: [0, 0, 0].
        "position": 'Sequence[float] | AnyArray',
        # Rotation of the collider's frame. Default: none.
        "rotation": 'Rotation',
        # Motion from that pose. Default: none.
        "motion": 'Motion',
        # Added to the thickness of objects that touch it. [m] Default: 0.
        "thickness": 'float',
        # Coefficient of static friction; a pair has the geometric mean of both. Default: 0.4.
        "static_friction": 'float',
        # Coefficient of kinetic friction, at most the static one. Default: 0.3; at most the static one.
        "kinetic_friction": 'float',
        # Coefficient of restitution: the share of the normal speed kept in a bounce. A pair has the larger one.
        # Default: 0.
        "restitution": 'float',
        # For bodies: greatest torque against rolling, per normal force. A pair has the larger one. [m] Default: 0.
        "rolling_friction": 'float',
        # For bodies: greatest torque about the contact normal, per normal force, in addition to that of friction. A
        # pair has the larger one. [m] Default: 0.
        "spinning_friction": 'float',
        # Velocity in the collider's frame with which its surface moves along itself while its shape stays, as that of
        # a conveyor belt: friction takes along what touches it. [m/s] Default: [0, 0, 0].
        "surface_velocity": 'Sequence[float] | AnyArray',
        # Only for a mesh: its deformation, linear between frames; `motion` is applied after it. Default: none.
        "frames": 'Sequence[MeshFrame]',
        # Only for a mesh: restart after the last frame. Default: false.
        "repeat_frames": 'bool',
        # Only for a mesh: its collision geometry. Distance grids and heightfields are cheap and solid, and meet
        # bodies and particles, not edges of surfaces (docs/guide/contact.md). Default: triangles.
        "as": "Literal['triangles', 'distance_grid', 'heightfield']",
        # Only for a distance grid: the distance between its nodes. [m] Default: a 48th of the longest side.
        "grid_spacing": 'float',
        # Only for a mesh: indices of its groups, 0 to 31. Default: [0].
        "groups": 'Sequence[int] | AnyArray',
        # Only for a mesh: indices of the groups that it collides with. Default: all.
        "mask": 'Sequence[int] | AnyArray',
        # Colour as linear red, green and blue. Default: [0.45, 0.48, 0.52].
        "colour": 'Sequence[float] | AnyArray',
    },
    total=False,
)
"""A static solid, or a kinematic one that follows keyframes."""

class MeshFrame(TypedDict, total=False):
    """The vertices of a mesh at one time."""

    time: Required[float]
    """Time of the frame; increases along the list. [s]"""
    file: str
    """A mesh file with the same number and order of vertices, placed like `mesh`."""
    positions: Sequence[Sequence[float] | AnyArray] | AnyArray | Points | AnyArray
    """Vertex positions before the placement of `mesh`."""

class Pair(TypedDict, total=False):
    """Overrides contact properties of one pair."""

    between: Required[Sequence[str]]
    """Names of two objects, or of an object and a mesh collider. The same name twice: self-collision of that object."""
    thickness: float
    """Distance kept between the two. [m] Default: the sum of both."""
    static_friction: float
    """Coefficient of static friction. Default: the geometric mean of both."""
    kinetic_friction: float
    """Coefficient of kinetic friction, at most the static one. Default: the geometric mean of both; at most the static
    one."""
    restitution: float
    """Coefficient of restitution: the share of the normal speed kept in a bounce. Default: the larger of both."""

class Gauge(TypedDict, total=False):
    """A measurement of liquids, which `pliant run --gauges FILE` writes for each frame (docs/guide/liquids.md)."""

    name: Required[str]
    """Unique name: the heading of its column."""
    height: HeightGauge
    """The height over a footprint."""
    flow: FlowGauge
    """The volume per second through an opening."""
    front: FrontGauge
    """The front of a wave."""
    force: ForceGauge
    """The force on a collider or a body."""
    liquids: Sequence[str]
    """Names of the liquids that it measures. Default: all."""

class HeightGauge(TypedDict, total=False):
    """The volume of liquid inside an axis-aligned box, over the area of its base, in m."""

    min: Required[Sequence[float] | AnyArray]
    """Its low corner. [m]"""
    max: Required[Sequence[float] | AnyArray]
    """Its high corner, above `min` in each coordinate. [m]"""
    axis: Literal['x', 'y', 'z']
    """Up: the base is across this axis. Default: y."""

class FlowGauge(TypedDict, total=False):
    """The volume of liquid that passes through a parallelogram, in m^3/s, averaged over the frame."""

    corner: Required[Sequence[float] | AnyArray]
    """One of its corners. [m]"""
    side_a: Required[Sequence[float] | AnyArray]
    """A side from there. [m]"""
    side_b: Required[Sequence[float] | AnyArray]
    """The other side from there. Flow in the direction of `side_a` x `side_b` is positive. [m]"""

class FrontGauge(TypedDict, total=False):
    """The place along a direction that a share of the liquid is behind, in m from the origin."""

    direction: Sequence[float] | AnyArray
    """Any length but zero. Default: [1, 0, 0]."""
    share: float
    """Share of the volume, above 0 and below 1. Default: 0.99."""

class ForceGauge(TypedDict, total=False):
    """The force with which liquid presses on something, in N, averaged over the frame; without friction."""

    on: Required[str]
    """Name of a collider, or of an object that is no liquid."""
    direction: Sequence[float] | AnyArray
    """A force along it is positive. Default: [0, -1, 0]."""

class Camera(TypedDict, total=False):
    """From where pictures show the scene. What is absent is chosen so that the scene fills the picture; options of
    `pliant render` override it (docs/reference/command.md)."""

    look_at: Sequence[float] | AnyArray
    """The point in the middle of the picture. [m] Default: the middle of the scene."""
    distance: float
    """From the camera to that point. [m] Default: so that the scene fits."""
    azimuth: float
    """Angle about the vertical from the front, +z, to the right. [degree] Default: 28."""
    elevation: float
    """Angle above the horizon. [degree] Default: 18."""
    position: Sequence[float] | AnyArray
    """Of the camera, instead of `distance`, `azimuth` and `elevation`. [m] Default: none."""
    fov: float
    """Vertical angle of view. [degree] Default: 30."""
