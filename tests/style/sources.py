"""What the lints share: the project's files, C text without comments, and one way to report."""

import os
import re
import subprocess
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
SKIPPED = 77  # CTest's SKIP_RETURN_CODE
CODE = (".c", ".h", ".cpp", ".inl")


def files(root=ROOT):
    """Paths, relative to root and sorted: what git tracks or would track; without git, every file but build/."""
    command = ["git", "-C", root, "ls-files", "-z", "--cached", "--others", "--exclude-standard"]
    listed = subprocess.run(command, capture_output=True, check=False)
    if listed.returncode == 0:
        names = {name for name in listed.stdout.decode().split("\0") if name}
    else:
        names = set()
        for folder, folders, plain in os.walk(root):
            folders[:] = [name for name in folders if name not in ("build", ".git", "__pycache__")]
            names.update(os.path.relpath(os.path.join(folder, name), root) for name in plain)
    return sorted(name for name in names if os.path.isfile(os.path.join(root, name)))


def code_files(folders, endings=CODE, root=ROOT):
    starts = tuple(folder + "/" for folder in folders)
    return [name for name in files(root) if name.startswith(starts) and name.endswith(endings)]


def read(name, root=ROOT):
    with open(os.path.join(root, name), encoding="utf-8", errors="replace") as file:
        return file.read()


TOKENS = re.compile(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])*\'', re.DOTALL)


def blank(text):
    """The text with comments and the insides of strings as spaces; lines stay where they are."""

    def spaces(match):
        token = match.group(0)
        if token[0] in "\"'":
            return token[0] + " " * (len(token) - 2) + token[-1]
        return re.sub(r"[^\n]", " ", token)

    return TOKENS.sub(spaces, text)


def without_directives(text):
    """Blanked text with preprocessor lines (and their continuations) emptied."""
    lines, inside = [], False
    for line in text.split("\n"):
        directive = inside or line.lstrip().startswith("#")
        inside = directive and line.rstrip().endswith("\\")
        lines.append("" if directive else line)
    return "\n".join(lines)


def finish(problems, what):
    """Prints the problems and leaves with the exit status of a test."""
    for problem in problems:
        print(problem)
    print(f"{what}: {len(problems)} problem(s)")
    sys.exit(1 if problems else 0)


def self_test(cases):
    """Each case is (name, problems found, needle or None): needle must be found, or nothing at all."""
    wrong = 0
    for name, problems, needle in cases:
        good = not problems if needle is None else any(needle in problem for problem in problems)
        print(f"{'ok' if good else 'NOT OK'}  {name}")
        if not good:
            wrong += 1
            print(f"    wanted {needle!r}, got {problems}")
    sys.exit(1 if wrong else 0)
