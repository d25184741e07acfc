"""Arrays in, arrays out: a flag of one's own mesh, and where it is in each frame."""

import numpy as np

import pliant

vertices, triangles = pliant.grid_mesh(41, 27, 1.5, 1.0)
vertices = vertices[:, [0, 2, 1]]  # upright: the grid's depth becomes height

scene = pliant.Scene(frame_time=1 / 60, wind={"velocity": [6, 0, 2], "gust": 0.3, "air_density": 1.2})
pole = np.flatnonzero(vertices[:, 0] == vertices[:, 0].min())
scene.add(cloth={"mesh": (vertices, triangles), "material": "silk"}, name="flag", pins=[{"particles": pole}])

world = pliant.World(scene, threads=2)
x = np.empty((len(vertices), 3), np.float32)
for report in world.frames(60):
    world["flag"].positions(out=x)
    print(f"{world.time:.3f} s: the lowest point is at {x[:, 1].min():.3f} m")
