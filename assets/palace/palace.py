"""Authors the palace and writes it as a .glb:

    blender -b -P assets/palace/palace.py -- --output assets/palace/palace.glb
"""

import argparse
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

import building  # noqa: E402  (Blender runs this file alone; its neighbours need the path above)
import openings  # noqa: E402
import plan  # noqa: E402
import tour  # noqa: E402
from scene import Scene  # noqa: E402
from shell import centre_of  # noqa: E402

EYE = 1.7


def parse_arguments():
    parser = argparse.ArgumentParser(prog="palace.py", description="Builds the palace in Blender and exports it.")
    parser.add_argument("--output", required=True, help="the .glb to write")
    parser.add_argument("--tour", help="the .csv of the walk; by default tour.csv in maps/palace")
    parser.add_argument("--blend", help="also save the Blender file here")
    return parser.parse_args(sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else [])


def build_shells(scene, rooms, portals):
    for room in rooms.values():
        scene.room(room)
        own = [p for p in portals if room.name in (p.source, p.target)]
        scene.local_mesh(room.name, f"{room.name}_shell", building.shell_mesh(building.build(room, own)))
    for number, portal in enumerate(portals):
        scene.portal(portal, number)


def light_rooms(scene, rooms):
    for room in rooms.values():
        x, y = centre_of(room.footprint)
        scene.light(room.name, 0, (x, y, room.floor + 0.72 * (room.ceiling - room.floor)), 40.0, (1.0, 0.86, 0.66), 14.0)


def main():
    arguments = parse_arguments()
    rooms = {room.name: room for room in plan.rooms()}
    portals = openings.resolve(rooms)
    scene = Scene({})
    build_shells(scene, rooms, portals)
    light_rooms(scene, rooms)
    scene.spawn("EntranceHall", (0.0, -15.0, 0.0), 0.0, EYE)
    tour.write(arguments.tour or Path(__file__).resolve().parents[2] / "maps" / "palace" / "tour.csv",
               tour.walk(rooms, portals))
    scene.export(str(Path(arguments.output).resolve()))


if __name__ == "__main__":
    main()
