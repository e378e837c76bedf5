"""Sizes that keep the code readable, with no list of exceptions: function, file, parameters. Also what the engine must
not call, left-over markers, and tests that no suite line names."""

import os
import re
import sys

import sources

MAX_FUNCTION_LINES = 80
MAX_FILE_LINES = 600
MAX_PARAMETERS = 6
FOLDERS = ["engine", "game", "tools", "tests"]

# A name and an opening parenthesis outside of braces: a function's head, if "{" or ";" follows the closing one.
HEAD = re.compile(r"([A-Za-z_]\w*)\s*\(")
NOT_HEADS = {"if", "for", "while", "switch", "return", "sizeof", "__attribute__", "_Static_assert", "static_assert",
             "defined", "alignas", "_Alignas", "decltype", "noexcept"}
MARKERS = re.compile(r"\b(TODO|FIXME|XXX|HACK)\b")
FORBIDDEN = re.compile(r"\b(exit|_exit|abort|assert|sin|cos|tan|atan2|pow|exp|log|rand|gets|strtok)\s*\(")
HEAP = re.compile(r"\b(malloc|calloc|realloc|free)\s*\(")


def closing(text, start, opener, closer):
    """The index of the closer that matches the opener at start, or -1."""
    depth = 0
    for index in range(start, len(text)):
        if text[index] == opener:
            depth += 1
        elif text[index] == closer:
            depth -= 1
            if depth == 0:
                return index
    return -1


def count_parameters(text):
    """The named parameters: the "..." of a variadic function is none."""
    text = re.sub(r",\s*\.\.\.\s*$", "", text)
    if text.strip() in ("", "void"):
        return 0
    depth, count = 0, 1
    for letter in text:
        depth += (letter in "([{") - (letter in ")]}")
        count += letter == "," and depth == 0
    return count


def outer_braces(text):
    """Opens the braces of extern "C" and namespaces, so that what they hold counts as top level."""
    for match in reversed(list(re.finditer(r'(extern\s*"[^"]*"|namespace\s*\w*)\s*\{', text))):
        end = closing(text, match.end() - 1, "{", "}")
        text = text[:match.start()] + " " * (match.end() - match.start()) + text[match.end():]
        if end >= 0:
            text = text[:end] + " " + text[end + 1:]
    return text


def functions(text):
    """(name, line of the head, lines or 0 for a prototype, parameters) of what stands at top level."""
    text = outer_braces(sources.without_directives(sources.blank(text)))
    found, index, start = [], 0, 0
    while index < len(text):
        letter = text[index]
        if letter == "{":
            end = closing(text, index, "{", "}")
            index = start = len(text) if end < 0 else end + 1
            continue
        if letter in ";}":
            start = index + 1
        match = HEAD.match(text, index) if letter.isalpha() or letter == "_" else None
        if not match:
            index += 1
            continue
        close = closing(text, match.end() - 1, "(", ")")
        if match.group(1) in NOT_HEADS or close < 0:
            index = match.end() if close < 0 else close + 1
            continue
        after = re.compile(r"(?:\s|const\b|noexcept\b|override\b|__attribute__\s*\(\(.*?\)\))*").match(text, close + 1)
        follower = text[after.end():after.end() + 1]
        if follower in ("{", ";") and text[start:match.start()].strip() and "typedef" not in text[start:match.start()]:
            head = start + len(text[start:]) - len(text[start:].lstrip())
            end = closing(text, after.end(), "{", "}") if follower == "{" else -1
            lines = text.count("\n", head, end) + 1 if end > 0 else 0
            parameters = count_parameters(text[match.end():close])
            found.append((match.group(1), text.count("\n", 0, head) + 1, lines, parameters))
        index = after.end() if follower == "{" else close + 1
    return found


def check_sizes(name, text):
    problems = []
    lines = text.count("\n") + (not text.endswith("\n"))
    if lines > MAX_FILE_LINES:
        problems.append(f"{name}: {lines} lines, at most {MAX_FILE_LINES}")
    for function, line, length, parameters in functions(text):
        if length > MAX_FUNCTION_LINES:
            problems.append(f"{name}:{line}: {function} has {length} lines, at most {MAX_FUNCTION_LINES}")
        if parameters > MAX_PARAMETERS:
            problems.append(f"{name}:{line}: {function} has {parameters} parameters, at most {MAX_PARAMETERS}")
    return problems


def check_words(name, text):
    problems = []
    blanked = sources.without_directives(sources.blank(text))
    for number, line in enumerate(text.split("\n"), 1):
        if MARKERS.search(line):
            problems.append(f"{name}:{number}: a left-over marker")
    if name.startswith("engine/"):
        for number, line in enumerate(blanked.split("\n"), 1):
            call = FORBIDDEN.search(line) or (not name.startswith("engine/base/") and HEAP.search(line))
            if call:
                problems.append(f"{name}:{number}: the engine does not call {call.group(1)}")
    return problems


def check_suites(names, suites):
    """Every tests/<folder>/test_<name>.c has its line in suites.inl."""
    listed = set(re.findall(r"^ENF_SUITE\((\w+), *(\w+),", suites, re.MULTILINE))
    problems = []
    for name in names:
        match = re.fullmatch(r"tests/(\w+)/test_(\w+)\.c", name)
        if match and (match.group(2), match.group(1)) not in listed:
            problems.append(f"{name}: no line in tests/suites.inl")
    return problems


def own_test():
    body = "    x++;\n"
    long_function = "static int f(int x) {\n" + body * 79 + "}\n"
    sources.self_test([
        ("80 lines", check_sizes("a.c", "static int f(int x) {\n" + body * 78 + "}\n"), None),
        ("81 lines", check_sizes("a.c", long_function), "f has 81 lines"),
        ("in extern C", check_sizes("a.h", 'extern "C" {\n' + long_function + "}\n"), "f has 81 lines"),
        ("600 lines", check_sizes("a.c", "\n" * 600), None),
        ("601 lines", check_sizes("a.c", "\n" * 601), "601 lines"),
        ("6 parameters", check_sizes("a.h", "void f(int a, int b, int c, int d, int e, int (*g)(int, int));\n"), None),
        ("7 parameters", check_sizes("a.h", "void f(int a, int b, int c, int d, int e, int g, int h);\n"),
         "f has 7 parameters"),
        ("6 and more to print", check_sizes("a.h", "void f(int a, int b, int c, int d, int e, char *g, ...);\n"), None),
        ("7 parameters of a body", check_sizes("a.c", "int\nf(int a, int b, int c, int d, int e, int g, int h) {\n}\n"),
         "f has 7 parameters"),
        ("a call is no head", check_sizes("a.c", "void f(void) {\n    g(1, 2, 3, 4, 5, 6, 7);\n}\n"), None),
        ("braces in text", check_sizes("a.c", 'void f(void) {\n    g("}");\n    g(\'{\');\n}\n' + body * 90), None),
        ("a marker", check_words("tools/a.c", "/* TO" + "DO */\n"), "marker"),
        ("the engine exits", check_words("engine/map/a.c", "void f(void) {\n    exit(1);\n}\n"), "does not call exit"),
        ("named in a comment", check_words("engine/map/a.c", "/* exit(1) */\n"), None),
        ("own sine", check_words("engine/map/a.c", "double x = enf_sin(y);\n"), None),
        ("heap outside base", check_words("engine/map/a.c", "void *p = malloc(3);\n"), "does not call malloc"),
        ("heap in base", check_words("engine/base/a.c", "void *p = malloc(3);\n"), None),
        ("an unlisted suite", check_suites(["tests/unit/test_a.c"], "ENF_SUITE(b, unit, core)\n"), "no line"),
        ("a listed suite", check_suites(["tests/unit/test_a.c"], "ENF_SUITE(a, unit, core)\n"), None),
    ])


def main():
    if "--self-test" in sys.argv:
        own_test()
    problems = []
    for name in sources.code_files(FOLDERS):
        text = sources.read(name)
        problems += check_sizes(name, text) + check_words(name, text)
    problems += check_suites(sources.files(), sources.read(os.path.join("tests", "suites.inl")))
    sources.finish(problems, "sizes")


main()
