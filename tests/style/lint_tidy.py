"""clang-tidy (.clang-tidy) over what the compilation database of a build folder holds of engine/ and tools/."""

import concurrent.futures
import json
import os
import shutil
import subprocess
import sys
import tempfile

import sources


def check(tool, build, path, root):
    """The findings of one file, as clang-tidy words them. Headers of others and flags that only gcc knows are no findings."""
    command = [tool, "--quiet", "-p", build, "--extra-arg=-Wno-unknown-warning-option", path]
    run = subprocess.run(command, cwd=root, capture_output=True, text=True, check=False)
    own = os.path.realpath(root) + os.sep
    return [line for line in run.stdout.splitlines()
            if (": warning:" in line or ": error:" in line) and os.path.realpath(line.split(":")[0]).startswith(own)]


def database_files(build, root):
    with open(os.path.join(build, "compile_commands.json"), encoding="utf-8") as file:
        paths = {os.path.realpath(os.path.join(entry["directory"], entry["file"])) for entry in json.load(file)}
    starts = tuple(os.path.join(os.path.realpath(root), folder) + os.sep for folder in ("engine", "tools", "game"))
    return sorted(path for path in paths if path.startswith(starts))


def own_test(tool):
    with tempfile.TemporaryDirectory() as folder:
        shutil.copy(os.path.join(sources.ROOT, ".clang-tidy"), folder)
        texts = {"good.c": "int f(int a);\nint f(int a) {\n    return a + 1;\n}\n",
                 "bad.c": "int f(int a);\nint f(int a) {\n    if (a)\n        return sizeof(sizeof(a));\n    return a / 0;\n}\n"}
        entries = []
        for name, text in texts.items():
            with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
                file.write(text)
            entries.append({"directory": folder, "file": name, "command": f"cc -std=c11 -c {name}"})
        with open(os.path.join(folder, "compile_commands.json"), "w", encoding="utf-8") as file:
            json.dump(entries, file)
        sources.self_test([
            ("clean", check(tool, folder, os.path.join(folder, "good.c"), folder), None),
            ("a finding", check(tool, folder, os.path.join(folder, "bad.c"), folder), "bad.c"),
        ])


def main():
    tool = shutil.which("clang-tidy-14") or shutil.which("clang-tidy")
    if not tool:
        print("clang-tidy is not there: skipped")
        sys.exit(sources.SKIPPED)
    if "--self-test" in sys.argv:
        own_test(tool)
    build = sys.argv[1]
    paths = database_files(build, sources.ROOT)
    with concurrent.futures.ThreadPoolExecutor(max_workers=len(os.sched_getaffinity(0))) as pool:
        found = pool.map(lambda path: check(tool, build, path, sources.ROOT), paths)
    problems = sorted({line for lines in found for line in lines})
    sources.finish(problems, f"tidy, {len(paths)} files")


main()
