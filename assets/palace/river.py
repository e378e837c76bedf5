"""The guided tour, a river in Galyean's sense: a closed way through the best rooms, how it carries the visitor along each stretch
(current, spring, damping, thrust), and what there is to see."""

from geometry import depth_inside, length, lerp, sub
from tour import resample, smooth_path, way_points

ROUTE = """
EntranceHall Courtyard MarbleSaloon RedSalon GreenSalon AudienceChamber GreenSalon Chapel Rotunda Library ReadingCabinet
NorthStaircase NorthLanding GlobeRoom UpperLibrary Belvedere UpperSaloon RoseBedchamber BlueBedchamber PrivyDiningRoom
KingsBedchamber HallGallery UpperKneeRoom UpperWingLobby PictureGallery WinterGarden PictureGallery UpperWingLobby UpperKneeRoom
MinstrelsGallery UpperStaircase GrandStaircase Antechamber GreatHall EastAisle KneeRoom PetitionRoom Antechamber GrandStaircase
EntranceHall
""".split()
START, END = (0.0, -13.5, 0.0), (0.0, -14.5, 0.0)
VIA = {  # way-points inside a room, for its visits in order
    "Courtyard": [[(0.0, -5.5), (4.0, -2.5), (4.0, 2.5), (0.0, 5.5)]],
    "MarbleSaloon": [[(0.0, 11.5)]],
    "AudienceChamber": [[(-18.0, 11.5), (-18.0, 12.0), (-17.5, 12.0)]],
    "Chapel": [[(-12.0, 17.625), (-9.0, 18.25), (-9.0, 23.5)]],
    "UpperLibrary": [[(17.75, 24.75), (9.0, 24.75)]],
    "WinterGarden": [[(51.0, -24.5), (51.75, -22.5), (49.5, -21.5)]],
    "GreatHall": [[(19.0, -6.5), (19.0, 0.0)]],
}

# metres a second; 1/s2; 1/s; m/s2.  An eye that is steered strays from its anchor by thrust / spring at most.
NARROW = (1.25, 14.0, 6.0, 1.5)  # doors, stairs, lobbies: 0.1 m
ROOM = (0.95, 6.0, 4.5, 3.6)  # 0.6 m
HALL = (0.8, 2.5, 3.0, 4.5)  # 1.8 m
CURRENTS = {
    **dict.fromkeys(["Courtyard", "GreatHall", "Rotunda", "Belvedere", "Chapel", "Library", "PictureGallery", "WinterGarden"], HALL),
    **dict.fromkeys(["NorthStaircase", "NorthLanding", "UpperStaircase", "GrandStaircase", "UpperWingLobby", "ReadingCabinet"], NARROW),
}
SIGHTS = {  # what to look at in a room, for its visits in order: a point in the world
    "EntranceHall": [(0.0, 0.0, 2.0), (-4.5, -13.0, 2.0)],
    "Courtyard": [(0.0, 0.0, 2.2)],
    "MarbleSaloon": [(-3.5, 13.5, 1.8)],
    "AudienceChamber": [(-22.0, 13.0, 1.6)],
    "Chapel": [(-20.0, 21.0, 3.0)],
    "Rotunda": [(0.0, 25.5, 7.0)],
    "Library": [(12.0, 22.4, 2.4)],
    "GlobeRoom": [(22.0, 22.5, 6.2)],
    "UpperLibrary": [(13.5, 21.5, 3.5)],
    "Belvedere": [(0.0, 25.0, 3.5)],
    "HallGallery": [(19.0, 0.0, 4.0)],
    "PictureGallery": [(43.5, -17.5, 6.8), (40.0, -20.0, 6.8)],
    "WinterGarden": [(52.5, -24.2, 6.4)],
    "MinstrelsGallery": [(19.0, 0.0, 5.5)],
    "GreatHall": [(15.0, 0.0, 3.5)],
}
STEP = 0.5  # metres between points of the file
AHEAD = 8  # points: what is looked at where nothing else is
TURN_OVER = 2.5  # metres from a door over which the look goes from the way to the sight


def stretches(rooms, points):
    """(room, visit, indices) of each unbroken stretch of points inside one room."""
    result, visits = [], {}
    for i, p in enumerate(points):
        room = next(
            (r.name for r in rooms.values() if r.floor - 0.6 <= p[2] < r.ceiling and depth_inside(r.footprint, p[:2]) > -0.3), None
        )
        if not result or room != result[-1][0]:
            visits[room] = visits.get(room, -1) + 1
            result.append((room, visits[room], []))
        result[-1][2].append(i)
    return result


def current(rooms, name):
    if name in CURRENTS:
        return CURRENTS[name]
    return ROOM if name in rooms else NARROW


def rows(rooms, portals, eye):
    """Rows of the file, in the plan's axes: eye, current, look."""
    corners = way_points(rooms, portals, ROUTE, VIA, START, END)
    points = resample(smooth_path(corners), STEP)
    for name, visit, inside in stretches(rooms, points):
        sights = SIGHTS.get(name, [])
        sight = sights[visit] if visit < len(sights) else None
        for k, i in enumerate(inside):
            way = points[(i + AHEAD) % len(points)]
            look = (*way[:2], way[2] + eye)
            to_door = min(k, len(inside) - 1 - k) * STEP
            share = min(1.0, to_door / TURN_OVER)
            share *= share * (3.0 - 2.0 * share)
            if sight and length(sub(sight, points[i])) > 1.0:
                look = lerp(look, sight, share)
            own, narrow = current(rooms, name), NARROW
            yield points[i], [a + (b - a) * share for a, b in zip(narrow, own)], look


def write(path, rooms, portals, eye):
    """In glTF's axes."""
    with open(path, "w", encoding="ascii", newline="\n") as file:
        file.write("x,y,z,speed,spring,damping,thrust,look_x,look_y,look_z\n")
        for (x, y, z), values, look in rows(rooms, portals, eye):
            text = ",".join(f"{v:.3f}" for v in (x, z + eye, -y, *values, look[0], look[2], -look[1]))
            file.write(text.replace("-0.000", "0.000") + "\n")
