#!/usr/bin/env python3
"""Holds the threat model of docs/reliability.md to the tests: each of its lines names some, and all that it names are there."""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
HEADING = "\n## Who is trusted with what\n"


def lines_of(page):
    """The cells of the table's rows, without its head."""
    part = page[page.index(HEADING) + len(HEADING):].split("\n## ")[0]
    rows = [line.strip("|").split("|") for line in part.splitlines() if line.startswith("|")]
    return [[cell.strip() for cell in row] for row in rows[2:]]


def problems_of(rows, programs, suites):
    for who, _, _, tests in rows[1:]:  # the first is the user, who may do anything
        names = re.findall(r"`([^`]+)`", tests)
        if not names and tests != "the same":
            yield f"{who}: no test"
        for name in names:
            wanted, known = (name[:-2].split(".")[0], suites) if name.endswith(".*") else (name, programs)
            pattern = re.compile(re.escape(wanted).replace(r"\*", ".*"))
            if not any(pattern.fullmatch(one) for one in known) and not any(one.endswith("." + wanted) for one in suites):
                yield f"{who}: no such test: {name}"


def main():
    builds = "".join(path.read_text(encoding="utf-8") for path in [*ROOT.glob("tests/**/*.cmake"), ROOT / "tests/CMakeLists.txt"])
    programs = set(re.findall(r"(?:gnomon_test|gnomon_node_test|gnomon_fuzz_target)\((\w+)|add_test\(NAME (\w+)", builds))
    programs = {name for pair in programs for name in pair if name}
    programs |= set(re.findall(r"\b(\w+_test)\b", " ".join(re.findall(r"foreach\(\w+ (.*)\)", builds))))
    programs |= {f"fuzz_replay_{path.stem[5:]}" for path in ROOT.glob("tests/fuzz/fuzz_*.cpp")}
    sources = "".join(path.read_text(encoding="utf-8") for path in ROOT.glob("tests/**/*_test.cpp"))
    tests = re.findall(r"^TEST(?:_[FP])?\((\w+), (\w+)\)", sources, re.MULTILINE)
    suites = {suite for suite, _ in tests} | {f"{suite}.{name}" for suite, name in tests}
    rows = lines_of((ROOT / "docs/reliability.md").read_text(encoding="utf-8"))
    assert list(problems_of([rows[0], ["a", "", "", "`no_such_test`"], ["b", "", "", ""]], programs, suites)), "it finds nothing"
    problems = list(problems_of(rows, programs, suites))
    print("\n".join(problems) or "fine")
    return 1 if problems or len(rows) < 10 else 0


sys.exit(main())
