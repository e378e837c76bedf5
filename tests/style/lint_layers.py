"""Every #include in engine/, tools/, game/ and tests/scenes/ against the table of rooms (layers.json)."""

import json
import os
import re
import sys

import sources

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]', re.MULTILINE)


def load_table():
    with open(os.path.join(os.path.dirname(os.path.abspath(__file__)), "layers.json"), encoding="utf-8") as file:
        return json.load(file)


def reach(table, room, seen=None):
    """The rooms whose public headers `room` may include: itself, what it names, and what those may include."""
    seen = set(table["everywhere"]) if seen is None else seen
    seen.add(room)
    for other in table["rooms"][room]["includes"]:
        if other not in seen:
            reach(table, other, seen)
    return seen


def room_of(table, name):
    """The room of a file, or None: public headers belong to the room that they are named after."""
    if name.startswith("engine/include/enfilade/"):
        stem = os.path.splitext(os.path.basename(name))[0]
        return table["header_rooms"].get(stem, stem)
    for room, entry in table["rooms"].items():
        if name.startswith(entry["folder"] + "/"):
            return room
    return None


def room_of_folder(table, folder):
    for room, entry in table["rooms"].items():
        if os.path.basename(entry["folder"]) == folder:
            return room
    return None


def external_allowed(table, room, header):
    groups = ["always"] + table["rooms"][room].get("external", [])
    for group in groups:
        for prefix in table["external"][group]:
            if header == prefix or (prefix[-1] in "/_" or prefix == "stb_image") and header.startswith(prefix):
                return True
    return False


def judge(table, name, room, mark, header):
    """None, or what is wrong with one #include."""
    if header.startswith("enfilade/"):
        stem = os.path.splitext(os.path.basename(header))[0]
        target = table["header_rooms"].get(stem, stem)
        if target not in reach(table, room):
            return f"{room} may not include {target}"
        return None
    if mark == "<":
        return None if external_allowed(table, room, header) else f"{room} may not use <{header}>"
    folder = header.split("/")[0] if "/" in header else None
    target = room_of_folder(table, folder) if folder else room
    if target is None:
        return f'"{header}" is in no room'
    if target == room:
        return None
    if name.startswith("engine/include/"):
        return f'a public header includes the private "{header}"'
    if not table["rooms"][target].get("shared"):
        return f'"{header}" is private to {target}'
    if target not in reach(table, room):
        return f"{room} may not include {target}"
    return None


def check(table, name, text):
    room = room_of(table, name)
    if room is None or room not in table["rooms"]:
        return [f"{name}: in no room of layers.json"]
    problems = []
    blanked = re.sub(r"/\*.*?\*/", lambda match: re.sub(r"[^\n]", " ", match.group(0)), text, flags=re.DOTALL)
    for match in INCLUDE.finditer(blanked):
        wrong = judge(table, name, room, match.group(1), match.group(2))
        if wrong:
            line = blanked.count("\n", 0, match.start(2)) + 1
            problems.append(f"{name}:{line}: {wrong}")
    return problems


def own_test(table):
    def case(name, path, text, needle):
        return (name, check(table, path, text), needle)

    sources.self_test([
        case("a room above", "engine/vis/a.c", "#include <enfilade/map.h>\n", None),
        case("base is for all", "engine/geom/a.c", "#include <enfilade/base.h>\n", None),
        case("a room below", "engine/map/a.c", "#include <enfilade/vis.h>\n", "map may not include vis"),
        case("compile sees no gl", "tools/compile/a.c", "#include <enfilade/gl.h>\n", "compile may not include gl"),
        case("the run time sees no compiler", "engine/map/a.c", '#include "compile/layout.h"\n', "may not include"),
        case("own private header", "engine/map/a.c", '#include "map/map_internal.h"\n', None),
        case("another's private header", "engine/vis/a.c", '#include "map/map_internal.h"\n', "private to map"),
        case("private in public", "engine/include/enfilade/vis.h", '#include "map/map_internal.h"\n', "public header"),
        case("public header's room", "engine/include/enfilade/map.h", "#include <enfilade/vis.h>\n", "may not include"),
        case("intrinsics in simd", "engine/simd/a.c", "#include <immintrin.h>\n", None),
        case("intrinsics elsewhere", "engine/kd/a.c", "#include <immintrin.h>\n", "may not use"),
        case("OpenGL elsewhere", "engine/draw/a.c", "#include <GL/gl.h>\n", "may not use"),
        case("tinygltf in compile", "tools/compile/a.cpp", "#include <tiny_gltf.h>\n", None),
        case("tinygltf in a program", "tools/enfc/a.c", "#include <tiny_gltf.h>\n", "may not use"),
        case("a comment is no include", "engine/map/a.c", "/*\n#include <enfilade/vis.h>\n*/\n", None),
        case("no room", "engine/attic/a.c", "", "in no room"),
    ])


def main():
    table = load_table()
    if "--self-test" in sys.argv:
        own_test(table)
    problems = []
    for name in sources.code_files(["engine", "tools", "game", "tests/scenes"]):
        problems += check(table, name, sources.read(name))
    sources.finish(problems, "layers")


main()
