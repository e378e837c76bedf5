"""libenf_core.a names nothing from outside but the C library and libm: symbols.txt lists what it may name."""

import os
import subprocess
import sys

import sources


def allowed_names():
    path = os.path.join(os.path.dirname(os.path.abspath(__file__)), "symbols.txt")
    with open(path, encoding="utf-8") as file:
        lines = [line.split("#")[0] for line in file]
    return {name for line in lines for name in line.split()}


def foreign(nm_output):
    """From the output of nm -A -P: {undefined name: the first object that names it}, less what the archive defines."""
    undefined, defined = {}, set()
    for line in nm_output.splitlines():
        fields = line.split()
        if len(fields) < 3:
            continue
        where, name, kind = fields[0].rstrip(":"), fields[1], fields[2]
        if kind in "Uw":
            undefined.setdefault(name, where)
        else:
            defined.add(name)
    return {name: where for name, where in undefined.items() if name not in defined}


def check(nm_output, allowed):
    return [f"{where}: {name} is not on the list" for name, where in sorted(foreign(nm_output).items())
            if name not in allowed]


def own_test():
    allowed = {"memcpy", "sqrt"}
    sources.self_test([
        ("listed names", check("l.a[a.o]: memcpy U\nl.a[a.o]: sqrt U\n", allowed), None),
        ("defined elsewhere in the archive", check("l.a[a.o]: enf_x U\nl.a[b.o]: enf_x T 0 1\n", allowed), None),
        ("an unlisted name", check("l.a[a.o]: glClear U\n", allowed), "glClear is not on the list"),
        ("leaving the process", check("l.a[a.o]: abort U\n", allowed_names()), "abort"),
        ("a clock", check("l.a[a.o]: clock_gettime U\n", allowed_names()), "clock_gettime"),
        ("a library's sine", check("l.a[a.o]: sin U\n", allowed_names()), "sin"),
    ])


def main():
    if "--self-test" in sys.argv:
        own_test()
    nm, archive = sys.argv[1], sys.argv[2]
    run = subprocess.run([nm, "-A", "-P", archive], capture_output=True, text=True, check=True)
    sources.finish(check(run.stdout, allowed_names()), "symbols")


main()
