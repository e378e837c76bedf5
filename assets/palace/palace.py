"""Authors the palace and writes it as a .glb:

    blender -b -P assets/palace/palace.py -- --output assets/palace/palace.glb
"""

import argparse
import sys
from pathlib import Path

import bpy

sys.path.insert(0, str(Path(__file__).resolve().parent))

import building  # noqa: E402  (Blender runs this file alone; its neighbours need the path above)
import furnish  # noqa: E402
import life  # noqa: E402
import openings  # noqa: E402
import plan  # noqa: E402
import river  # noqa: E402
import tour  # noqa: E402
import trim  # noqa: E402
from scene import Scene  # noqa: E402

EYE = 1.7


def parse_arguments():
    parser = argparse.ArgumentParser(prog="palace.py", description="Builds the palace in Blender and exports it.")
    parser.add_argument("--output", required=True, help="the .glb to write")
    parser.add_argument("--tour", help="the .csv of the walk; by default tour.csv in maps/palace")
    parser.add_argument("--blend", help="also save the Blender file here")
    return parser.parse_args(sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else [])


def build_shells(scene, rooms, portals):
    for room in rooms.values():
        scene.room(room)
        own = [p for p in portals if room.name in (p.source, p.target)]
        scene.local_mesh(room.name, f"{room.name}_shell", building.shell_mesh(building.build(room, own)))
        mouldings = trim.trim_mesh(room)
        if mouldings.faces:
            scene.local_mesh(room.name, f"{room.name}_trim", mouldings)
    for number, portal in enumerate(portals):
        scene.portal(portal, number)


def main():
    arguments = parse_arguments()
    rooms = {room.name: room for room in plan.rooms()}
    portals = openings.resolve(rooms)
    scene = Scene()
    build_shells(scene, rooms, portals)
    feet = tour.walk(rooms, portals)
    movers = sum(furnish.furnish(scene, room, feet) for room in rooms.values())
    movers += life.populate(scene, rooms, portals)
    print(f"{movers} things move")
    scene.spawn("EntranceHall", (0.0, -15.0, 0.0), 0.0, EYE)
    tour.write(arguments.tour or Path(__file__).resolve().parents[2] / "maps" / "palace" / "tour.csv", feet)
    river.write(Path(__file__).resolve().parents[2] / "maps" / "palace" / "river.csv", rooms, portals, EYE)
    save(arguments)
    scene.export(str(Path(arguments.output).resolve()))


def save(arguments):
    if arguments.blend:
        bpy.ops.wm.save_as_mainfile(filepath=str(Path(arguments.blend).resolve()))


if __name__ == "__main__":
    main()
