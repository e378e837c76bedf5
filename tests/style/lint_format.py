"""Every source as clang-format 14 would write it (.clang-format). Another version formats otherwise: then skipped."""

import os
import shutil
import subprocess
import sys
import tempfile

import sources

VERSION = 14


def find_tool():
    for name in (f"clang-format-{VERSION}", "clang-format"):
        path = shutil.which(name)
        if path:
            said = subprocess.run([path, "--version"], capture_output=True, text=True, check=False).stdout
            if f"version {VERSION}." in said:
                return path
    return None


def check(tool, paths, root):
    run = subprocess.run([tool, "--style=file", "--dry-run"] + paths, cwd=root, capture_output=True, text=True,
                         check=False)
    return [line for line in run.stderr.splitlines() if ": warning:" in line or ": error:" in line]


def own_test(tool):
    with tempfile.TemporaryDirectory() as folder:
        shutil.copy(os.path.join(sources.ROOT, ".clang-format"), folder)
        texts = {"good.c": "int f(int a) {\n    return a;\n}\n", "bad.c": "int f( int a )\n{ return a;}\n"}
        for name, text in texts.items():
            with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
                file.write(text)
        sources.self_test([
            ("formatted", check(tool, ["good.c"], folder), None),
            ("not formatted", check(tool, ["bad.c"], folder), "bad.c"),
        ])


def main():
    tool = find_tool()
    if not tool:
        print(f"clang-format {VERSION} is not there: skipped")
        sys.exit(sources.SKIPPED)
    if "--self-test" in sys.argv:
        own_test(tool)
    names = sources.code_files(["engine", "game", "tools", "tests"], (".c", ".h", ".cpp"))
    sources.finish(check(tool, names, sources.ROOT), "format")


main()
