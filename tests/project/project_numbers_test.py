#!/usr/bin/env python3
"""Holds the numbers that documents repeat to the one place that makes them: the confusion matrix of docs/labels.md, which a test
of the program writes, says how many causes there are and of how many pixels how many are confused."""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
NAMES = "zero one two three four five six seven eight nine ten eleven twelve thirteen fourteen fifteen sixteen".split()


def matrix():
    """Columns, pixels counted and pixels confused of the confusion matrix."""
    text = (ROOT / "docs/labels.md").read_text(encoding="utf-8")
    part = text.split("<!-- confusion matrix -->")[1].split("<!-- end of the confusion matrix -->")[0]
    rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in part.splitlines() if line.startswith("|")]
    counts = [[int(cell.strip("*")) for cell in row[2:] if cell] for row in rows[2:]]
    right = sum(int(cell.strip("*")) for row in rows[2:] for cell in row[2:] if cell.startswith("**"))
    total = sum(map(sum, counts))
    said = tuple(map(int, re.search(r"(\d+) of (\d+) pixels are confused", part).groups()))
    return len(rows[0]) - 2, total, total - right, said


def main():
    causes, pixels, confused, said = matrix()
    faults = []
    if said != (confused, pixels):
        faults.append(f"docs/labels.md: its rows have {confused} confused pixels of {pixels}, its sentence {said[0]} of {said[1]}")
    named = ["acne", "peter-panning", "a light leak", "aliasing"]
    wanted = {
        "README.md": f"{', '.join(named)} or one of {NAMES[causes - len(named)]} other causes",
        "docs/accuracy-of-figures.md": f"{confused} of {pixels:,} pixels is confused, over {NAMES[causes]} causes",
    }
    for place, sentence in wanted.items():
        text = " ".join((ROOT / place).read_text(encoding="utf-8").split())
        if sentence not in text:
            faults.append(f"{place}: not there: {sentence}")
    print("\n".join(faults) or "fine")
    return 1 if faults else 0


sys.exit(main())
