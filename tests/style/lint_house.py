"""The house in order: each room has its README.md, and no path of anybody's machine is committed."""

import re
import sys

import sources

# Folders where people keep work; /usr, /etc, /tmp, /dev and /proc are the same on every machine.
MACHINE_PATH = re.compile(r"(?<![\w./<>{}$%-])/(?:home|root|work|Users|mnt|media|srv|opt)/[\w.-]+|\b[A-Z]:\\\\?Users\b")
TEXT = (".c", ".h", ".cpp", ".inl", ".py", ".md", ".txt", ".cmake", ".in", ".sh", ".yml", ".yaml", ".csv", ".svg",
        ".glsl", ".vert", ".frag")
ALSO_TEXT = re.compile(r"(^|/)(run|CMakeLists\.txt|CMakePresets\.json|[^/]*\.json|\.[^/]+)$")


def check_paths(name, text):
    return [f"{name}:{number}: a path of one machine: {match.group(0)}"
            for number, line in enumerate(text.split("\n"), 1)
            for match in [MACHINE_PATH.search(line)] if match]


def check_rooms(names):
    """A folder of engine/ or tools/ with sources in it has a README.md, and so have the folders of the top level."""
    rooms = set()
    for name in names:
        parts = name.split("/")
        if len(parts) >= 3 and parts[0] in ("engine", "tools") and parts[1] != "include":
            rooms.add("/".join(parts[:2]))
        if len(parts) >= 2 and parts[0] in ("engine", "game", "tools", "tests", "maps", "assets"):
            rooms.add(parts[0])
    return [f"{room}: no README.md" for room in sorted(rooms) if room + "/README.md" not in names]


def own_test():
    sources.self_test([
        ("a home folder", check_paths("a.md", "see /ho" + "me/anna/x.glb\n"), "path of one machine"),
        ("root's folder", check_paths("a.c", '"/ro' + 'ot/x"\n'), "path of one machine"),
        ("a system folder", check_paths("a.md", "in /usr/include and /tmp/x\n"), None),
        ("a relative path", check_paths("a.md", "../shared/data, docs/work/x\n"), None),
        ("an address", check_paths("a.md", "https://example.org/home/x\n"), None),
        ("a room without a README", check_rooms(["engine/README.md", "engine/kd/kd.c"]), "engine/kd: no README.md"),
        ("a room with one", check_rooms(["engine/README.md", "engine/kd/kd.c", "engine/kd/README.md"]), None),
        ("the public headers", check_rooms(["engine/README.md", "engine/include/enfilade/kd.h"]), None),
    ])


def main():
    if "--self-test" in sys.argv:
        own_test()
    names = sources.files()
    problems = check_rooms(set(names))
    for name in names:
        if name.endswith(TEXT) or ALSO_TEXT.search(name):
            problems += check_paths(name, sources.read(name))
    sources.finish(problems, "house")


main()
