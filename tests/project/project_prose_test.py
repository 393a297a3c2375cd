#!/usr/bin/env python3
"""Holds the sentences of the lab and of the grader to the one file in which they can be read through, prose.txt: a sentence that is
new or changed is read there, by its author and in review, before it is a user's. Holds them, the sentences in comments of what is no
test, and those in Markdown pages to a length that is understood at once.
  project_prose_test.py [--fix]     --fix writes the file"""
import pathlib
import re
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
FOLDERS = ("lab/view", "grade")
WORDS = 6  # from so many on it is a sentence
MOST_WORDS = 30  # more must be read twice; a sign of a formula is no word
NO_ROOMS = ("tests",)
ENDINGS = ("h", "cpp", "ts", "js", "mjs", "glsl", "vert", "frag", "comp")

LITERALS = re.compile(r'(?:"(?:[^"\\\n]|\\.)*"\s*)+')
LITERAL = re.compile(r'"((?:[^"\\\n]|\\.)*)"')
# What stands before a comment, the comment's slashes, its text with the blanks in front.
COMMENT = re.compile(r"""((?:'(?:[^'\\]|\\.)'|"(?:[^"\\]|\\.)*"|[^"/]|/(?!/))*)(//[/!]?<?)(.*)""")
# After a full stop or a semicolon, unless it ends an abbreviation; between the columns of a table.
SENTENCE_END = re.compile(r"(?<!\bal\.)(?<!\beq\.)(?<!\be\.g\.)(?<!\bi\.e\.)(?<=[.;!?])\s+|(?<=[.!?][)\"'`])\s+|\s{3,}")


def sentences(source):
    """The text literals of a C++ file, those side by side joined as the compiler joins them."""
    text = re.sub(r"^\s*(//|#include).*", "", source, flags=re.MULTILINE)
    joined = ("".join(LITERAL.findall(found.group(0))) for found in LITERALS.finditer(text))
    return [text for text in joined if len(text.split()) >= WORDS and "<" not in text]


def prose():
    parts = []
    for folder in FOLDERS:
        for path in sorted((ROOT / folder).rglob("*.cpp")):
            # Help is held by the manual that is made of it; its examples are no sentences.
            if path.parent.name != "commands" and (found := sentences(path.read_text(encoding="utf-8"))):
                parts.append(f"{path.relative_to(ROOT)}\n" + "".join(f"  {text}\n" for text in found))
    return "\n".join(parts)


def comment_parts(source):
    """Paragraphs, items of lists, and indented lines of formulas and tables, each with the line where it begins. Deeper lines go on
    with an item, lines as deep with a paragraph."""
    parts, marks, depth, deeper = [], None, 0, False
    for number, line in enumerate(source.split("\n"), 1):
        found = COMMENT.fullmatch(line)
        code, slashes, text = found.groups() if found else ("", None, "")
        indent, text = len(text) - len(text.lstrip()), text.strip()
        goes_on = not code.strip() and slashes == marks and not text.startswith("- ")
        if text and goes_on and (indent > depth if deeper else indent == depth):
            parts[-1][1] += " " + text
        elif text:
            parts.append([number, text])
            depth, deeper = indent, text.startswith("- ") or indent > 1
        marks = slashes if text else None
    return parts


def word_count(sentence):
    return sum(any(c.isalnum() for c in word) for word in sentence.split())


def tracked(*patterns):
    said = subprocess.run(["git", "-C", ROOT, "ls-files", *patterns], capture_output=True, text=True, check=True).stdout
    return [name for name in said.split() if (ROOT / name).exists()]


def sources():
    """But the mistakes of the grader, whose comments are lists."""
    names = tracked(*(f"*.{ending}" for ending in ENDINGS))
    return [ROOT / name for name in names if name.split("/")[0] not in NO_ROOMS and "/mistakes/" not in name]


def page_parts(text):
    """Paragraphs, items of lists and cells of tables of a Markdown page, each with the line where it begins. Code and headings are
    left out, and of a link its address."""
    part, begin, in_code = [], 0, False
    for number, line in enumerate([*text.split("\n"), ""], 1):
        is_formula = not part and line.startswith("    ")
        line = line.strip()
        in_code ^= line.startswith("```")
        item = re.fullmatch(r"(?:[-*]|\d+\.) (.*)", line)
        stands_alone = in_code or is_formula or not line or line.startswith(("|", "#", "<", "!", "```"))
        if part and (item or stands_alone):
            yield begin, re.sub(r"\]\([^)]*\)", "]", " ".join(part))
            part = []
        if line.startswith("|") and not in_code:
            yield from ((number, re.sub(r"\]\([^)]*\)", "]", cell.strip())) for cell in line.strip("|").split("|"))
        elif not stands_alone:
            begin = begin if part else number
            part.append(item.group(1) if item else line)


def pages():
    return [ROOT / name for name in tracked("*.md")]


def long_sentences():
    files = [(path, comment_parts) for path in sources()] + [(path, page_parts) for path in pages()]
    for path, parts_of in files:
        for line, part in parts_of(path.read_text(encoding="utf-8")):
            for sentence in SENTENCE_END.split(part):
                if word_count(sentence) > MOST_WORDS:
                    yield f"{path.relative_to(ROOT)}:{line}: {word_count(sentence)} words: {sentence}"


def main():
    golden, now = HERE / "prose.txt", prose()
    if "--fix" in sys.argv[1:]:
        golden.write_text(now, encoding="utf-8")
    problems = [] if golden.read_text(encoding="utf-8") == now else ["prose.txt differs: read what is new, then --fix"]
    for line in now.splitlines():
        for sentence in re.split(r"[.:;] ", line):
            if word_count(sentence) > MOST_WORDS:
                problems.append(f"more than {MOST_WORDS} words: {sentence.strip()}")
    problems += long_sentences()
    print("\n".join(problems) or "fine")
    return 1 if problems else 0


sys.exit(main())
