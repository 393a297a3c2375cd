#!/usr/bin/env python3
"""Holds the sentences of the lab and of the grader to the one file in which they can be read through, prose.txt: a sentence that is
new or changed is read there, by its author and in review, before it is a user's.
  project_prose_test.py [--fix]     --fix writes the file"""
import pathlib
import re
import sys

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
FOLDERS = ("app/view", "studies/grade")
WORDS = 6  # from so many on it is a sentence
MOST_WORDS = 30  # more must be read twice

LITERALS = re.compile(r'(?:"(?:[^"\\\n]|\\.)*"\s*)+')
LITERAL = re.compile(r'"((?:[^"\\\n]|\\.)*)"')


def sentences(source):
    """The text literals of a C++ file, those side by side joined as the compiler joins them."""
    text = re.sub(r"^\s*(//|#include).*", "", source, flags=re.MULTILINE)
    joined = ("".join(LITERAL.findall(found.group(0))) for found in LITERALS.finditer(text))
    return [text for text in joined if len(text.split()) >= WORDS and "<" not in text]


def prose():
    parts = []
    for folder in FOLDERS:
        for path in sorted((ROOT / folder).rglob("*.cpp")):
            if found := sentences(path.read_text(encoding="utf-8")):
                parts.append(f"{path.relative_to(ROOT)}\n" + "".join(f"  {text}\n" for text in found))
    return "\n".join(parts)


def main():
    golden, now = HERE / "prose.txt", prose()
    if "--fix" in sys.argv[1:]:
        golden.write_text(now, encoding="utf-8")
    problems = [] if golden.read_text(encoding="utf-8") == now else ["prose.txt differs: read what is new, then --fix"]
    for line in now.splitlines():
        for sentence in re.split(r"[.:;] ", line):
            if len(sentence.split()) > MOST_WORDS:
                problems.append(f"more than {MOST_WORDS} words: {sentence.strip()}")
    print("\n".join(problems) or "fine")
    return 1 if problems else 0


sys.exit(main())
