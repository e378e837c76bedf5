"""No sound is there for nothing: every line of the game's tables of sounds is played somewhere and has its file, every file its line."""

import re
import sys

import sources

TABLES = {"game/sim/game.h": ("GAME_SOUNDS", "GAME_SOUND_"), "game/front/audio.h": ("AUDIO_SOUNDS", "AUDIO_")}
LINE = re.compile(r'\bX\((\w+), "(\w+)"\)')


def table(text, name):
    """(NAME, file stem) of the lines of a table."""
    begin = text.find(f"#define {name}(X)")
    return LINE.findall(text[begin:re.search(r"[^\\]\n", text[begin:]).end() + begin]) if begin >= 0 else []


def check(rows, code, stems):
    """rows: (identifier, stem); code: the sources together; stems: of the files in assets/sounds."""
    problems = []
    named = set()
    for identifier, stem in rows:
        named.add(stem)
        if not re.search(rf"\b{identifier}\b", code):
            problems.append(f"{identifier}: never played")
        if not any(re.fullmatch(rf"{stem}(_\d+)?", file) for file in stems):
            problems.append(f"{identifier}: assets/sounds has no {stem}.wav")
    unknown = [file for file in stems if file not in named and re.sub(r"_\d+$", "", file) not in named]
    return problems + [f"assets/sounds/{file}.wav: in no table of sounds" for file in sorted(unknown)]


def own_test():
    rows = table('#define S(X) \\\n    X(A, "a") \\\n    X(B, "b")\nX(C, "c")\n', "S")
    sources.self_test([
        ("the table", [] if rows == [("A", "a"), ("B", "b")] else ["wrong"], None),
        ("all is well", check([("S_A", "a")], "play(S_A);", ["a_1", "a_2"]), None),
        ("never played", check([("S_A", "a")], "play(S_AB);", ["a"]), "S_A: never played"),
        ("no file", check([("S_A", "a")], "S_A", ["ab"]), "S_A: assets/sounds has no a.wav"),
        ("no line", check([("S_A", "a")], "S_A", ["a", "b_1"]), "b_1.wav: in no table"),
    ])


def main():
    if "--self-test" in sys.argv:
        own_test()
    names = sources.files()
    rows = [(prefix + name, stem)
            for path, (macro, prefix) in TABLES.items() for name, stem in table(sources.read(path), macro)]
    code = "\n".join(sources.read(name) for name in names if re.match(r"game/.*\.c$", name))
    stems = [re.sub(r".*/|\.wav$", "", name) for name in names if re.match(r"assets/sounds/.*\.wav$", name)]
    sources.finish(check(rows, code, stems) if rows and stems else ["the tables of sounds are not where they were"], "sounds")


main()
