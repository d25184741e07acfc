"""A scene as a dict, changed, checked, controlled and saved: a door that a motor opens."""

import math
import sys

import pliant

scene = pliant.Scene(
    objects=[
        {
            "name": "house",
            "bodies": [
                {"name": "post", "solids": [{"box": {"half_extents": [0.1, 1, 0.1]}}], "kinematic": True},
                {"name": "door", "solids": [{"box": {"half_extents": [0.4, 0.9, 0.02]}}], "position": [0.6, 0, 0]},
            ],
            "joints": [
                {
                    "name": "hinge",
                    "between": ["post", "door"],
                    "hinge": {"anchor": [0.15, 0, 0], "axis": [0, 1, 0], "motor": {"position": 0, "most": 200}},
                }
            ],
        }
    ]
)
scene["objects"][0]["bodies"][1]["mass"] = 20  # the dict of the format; checked when a World is made
for grave, message, advice in scene.check():
    print("wrong:" if grave else "doubtful:", message, advice)

world = pliant.World(scene)
house = world["house"]
with world.writer("door.glb") as out:
    house.set_motor("hinge", target=math.pi / 2)
    for report in world.frames(120):
        out.add()
        if not report.ok:
            sys.exit(report.explain())

turned = 2 * math.asin(house.pose("door").rotation[1])
print(f"the door is open by {math.degrees(turned):.0f} degrees")
print("its hinge bears", house.joint_load(0).force, "N")
world.save("end.world")
again = pliant.World.load("end.world")
assert again.state_hash() == world.state_hash()
