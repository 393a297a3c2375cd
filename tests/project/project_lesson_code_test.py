#!/usr/bin/env python3
"""Holds the code that lessons show to the code that runs: each block stands below a mark that names the file and the lines,
  <!-- code: shaders/technique/hard.glsl from "float technique_visibility(" to "}" -->
from the one line of the file that begins so to the next one that begins with the other words. A brace is indented as far as the first line.
Every lesson has one.
  project_lesson_code_test.py [--fix]     --fix writes the blocks anew"""
import pathlib
import re
import sys
import textwrap

ROOT = pathlib.Path(__file__).resolve().parents[2]
MOST_LINES = 18  # more are not read from a page
LANGUAGES = {"glsl": "glsl", "frag": "glsl", "vert": "glsl", "cpp": "cpp", "h": "cpp"}
MARK = re.compile(r'^<!-- code: (\S+) from "([^\n]*)" to "([^\n]*)" -->\n(```\w*\n[\s\S]*?^```\n)?', re.MULTILINE)


class Fault(Exception):
    pass


def indent(line):
    return len(line) - len(line.lstrip())


def cut(path, first, last):
    """The lines of a file, moved to the left."""
    file = ROOT / path
    if not file.is_file():
        raise Fault(f"{path} is not there")
    lines = file.read_text(encoding="utf-8").splitlines()
    begins = [i for i, line in enumerate(lines) if line.lstrip().startswith(first)]
    if len(begins) != 1:
        raise Fault(f"{path} has {len(begins)} lines that begin with: {first}")
    begin = begins[0]

    def ends(line):
        return line.lstrip().startswith(last) and (not last.startswith("}") or indent(line) == indent(lines[begin]))

    end = next((i for i in range(begin, len(lines)) if ends(lines[i])), None)
    if end is None:
        raise Fault(f"{path} has no line behind that begins with: {last}")
    if end - begin >= MOST_LINES:
        raise Fault(f"{path}: {end - begin + 1} lines from: {first}")
    language = LANGUAGES[file.suffix[1:]]
    return f"```{language}\n" + textwrap.dedent("\n".join(lines[begin:end + 1])) + "\n```\n"


def main():
    faults = []
    for lesson in sorted((ROOT / "docs/lessons").glob("*.md")):
        text = lesson.read_text(encoding="utf-8")
        marks = list(MARK.finditer(text))
        if not marks and lesson.name != "README.md":
            faults.append(f"{lesson.name} shows no code")
        for mark in reversed(marks):
            path, first, last, shown = mark.groups()
            try:
                block = cut(path, first, last)
            except Fault as fault:
                faults.append(f"{lesson.name}: {fault}")
                continue
            if f"`{path}`" not in text:
                faults.append(f"{lesson.name} does not say where its code stands: `{path}`")
            if shown != block:
                faults.append(f"{lesson.name}: {path} has other lines from: {first}")
                text = text[:mark.start()] + mark.group(0)[:len(mark.group(0)) - len(shown or "")] + block + text[mark.end():]
        if "--fix" in sys.argv[1:]:
            lesson.write_text(text, encoding="utf-8")
    print("\n".join(faults) or "fine")
    return 1 if faults else 0


sys.exit(main())
