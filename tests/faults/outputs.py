"""Whether two runs wrote the same, but for what differs by nature: times, and what depends on them.

Held byte by byte: models, shaders, pages without times, and of pictures and channels all but dates and commands in their
headers. JSON is held key by key, without the keys of times; CSV by its other columns. A page with times, whose sentences speak
of them, is held by its sections, the pictures in it and its end; text for people by its size and its end. JSON whose subject is
time (of bench, of tune, of --trace) is held by its keys alone.
"""
import csv
import hashlib
import io
import json
import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "tools"))
from same_results import differing_keys, exr_parts, png_parts  # noqa: E402

ABOUT_TIME = re.compile(r"(^|/)(bench|also|trace|tune)\.json$|_times\.jsonl$")
SEAL = re.compile(rb',"checksum":"([0-9a-f]+)"}$')
TIMED_COLUMN = re.compile(r"_ms(_|$)|^(derived|load)$")


def keys_of(value):
    """The shape of a JSON value: its keys, and of lists the shapes that occur."""
    if isinstance(value, dict):
        return {key: keys_of(part) for key, part in value.items()}
    if isinstance(value, list):
        return sorted({json.dumps(keys_of(part), sort_keys=True) for part in value})
    return type(value).__name__ if isinstance(value, (bool, str)) else "number"


def json_differs(name, base, new):
    base, new = json.loads(base), json.loads(new)
    if ABOUT_TIME.search(name):
        return keys_of(base) != keys_of(new)
    return any(True for _ in differing_keys(base, new))


def is_sealed(line):
    """A sweep's line ends with the checksum of what stands before, which is another where fewer threads could be started."""
    seal = SEAL.search(line)
    return seal is None or hashlib.sha256(line[:seal.start() + 1]).hexdigest()[:16].encode() == seal[1]


def lines_differ(name, base, new):
    base, new = base.splitlines(), new.splitlines()
    if len(base) != len(new) or not all(map(is_sealed, new)):
        return True
    return any(json_differs(name, SEAL.sub(b"}", a), SEAL.sub(b"}", b)) for a, b in zip(base, new))


def table_of(data):
    rows = list(csv.reader(io.StringIO(data.decode())))
    kept = [i for i, name in enumerate(rows[0]) if not TIMED_COLUMN.search(name)]
    return [[row[i] for i in kept] for row in rows]


def page_of(data):
    return re.findall(rb'id="[^"#]*"', data), re.findall(rb"data:image/[^\"']*", data), data[-32:]


def text_differs(base, new):
    """Of text for people: it may say more or less where a time is another, but not a quarter of it, and the end is its end."""
    return not len(base) / 4 < len(new) < 4 * len(base) or base[-1:] != new[-1:]


def differs(name, base, new):
    """Whether a file of this name differs from what it should be."""
    suffix = pathlib.PurePath(name).suffix
    if base == new:
        return False
    try:
        if suffix == ".json" or (suffix == "" and base[:1] == b"{"):
            return json_differs(name, base, new)
        if suffix == ".jsonl":
            return lines_differ(name, base, new)
        parts = {".exr": exr_parts, ".png": png_parts, ".csv": table_of, ".html": page_of}.get(suffix)
        if parts is not None:
            return parts(base) != parts(new)
    except (ValueError, IndexError, KeyError):
        return True
    return suffix not in ("", ".md") or text_differs(base, new)


def files_below(folder):
    """Every file's bytes and every empty folder (ending in "/"), by their names from there."""
    found = {}
    for path in folder.rglob("*"):
        name = str(path.relative_to(folder))
        if path.is_symlink() or path.is_file():
            found[name] = path.read_bytes()
        elif not any(path.iterdir()):
            found[name + "/"] = b""
    return found


def same(base, new):
    """Names of what is missing, too much or different."""
    wrong = [name for name in base if name not in new or differs(name, base[name], new[name])]
    return sorted(wrong + [name for name in new if name not in base])


OWN_DRAWING = re.compile(r"/cells/cell-\d+\.png$")


def same_but_drawn_anew(base, new):
    """The same of a sweep that was taken up again. A cell whose drawing came from the cell before it has none of its own; where
    it is the first that is made again it has, and the page shows it."""
    anew = [name for name in new if name not in base and OWN_DRAWING.search(name)]
    pages = [name for name in base if anew and name.endswith("/report.html") and name in new]
    wrong = [name for name in same(base, new) if name not in anew + pages]
    return wrong + [name for name in pages if not holds_pictures_of(base[name], new[name])]


def holds_pictures_of(base, new):
    (sections, pictures, end), (new_sections, new_pictures, new_end) = page_of(base), page_of(new)
    return set(sections) <= set(new_sections) and set(pictures) <= set(new_pictures) and end == new_end


def same_but_ungraded(base, new):
    """The same of a class of which somebody could not be graded, as grade says for each of them: nobody who has points has
    others, and who could not be graded has none, not 0."""
    rows = {name: {row[0]: row for row in csv.reader(io.StringIO(data.decode()))}
            for name, data in (("base", base["out/grades.csv"]), ("new", new.get("out/grades.csv", b"")))}
    ungraded = [student for student, row in rows["new"].items() if row[1:2] == [""]]
    wrong = [f"points of {student}" for student, row in rows["base"].items()
             if student not in ungraded and rows["new"].get(student) != row]
    told = {"out/grades.csv", "out/grades.json", "out/index.html", *(f"out/{student}.html" for student in ungraded)}
    return wrong + [name for name in same(base, new) if name not in told or name not in new] + ([] if ungraded else ["the ungraded"])


def same_but_refused(base, new, before):
    """The same of several captures of which some could not be read, as judge says of them: the others are judged as ever, and
    who was refused has no line; where it had a folder before, that is left alone."""
    def judged(files):
        lines = files.get("out/judge.jsonl", b"").splitlines()
        return {json.loads(line)["axes"]["capture"]: line for line in lines}
    def table(files):
        if not files["out/judge.csv"]:  # every capture was refused
            return []
        rows = table_of(files["out/judge.csv"])
        capture = rows[0].index("cell")
        return [row[:capture] + row[capture + 1:] for row in rows]
    names, refused = judged(base), set(judged(base)) - set(judged(new))
    wrong = [f"the line of {name}" for name, line in judged(new).items()
             if name not in names or lines_differ("judge.jsonl", names[name], line)]
    kept = [i for i, name in enumerate(names) if name not in refused]
    if "out/judge.csv" in new and table(new) != [table(base)[i] for i in (0, *(1 + i for i in kept)) if kept]:
        wrong.append("the table")
    for name in same(base, new):
        if any(name.startswith(f"out/{who}/") for who in refused):
            wrong += [name] if new.get(name) != before.get(name) else []
        elif name not in ("out/judge.jsonl", "out/judge.csv", "out/report.html", "said/stdout") or name not in new:
            wrong.append(name)
    return wrong + ([] if refused else ["the refused"])
