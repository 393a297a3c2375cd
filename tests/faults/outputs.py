"""Whether two runs wrote the same, but for what differs by nature: times, and what hangs on them.

Held byte by byte: models, shaders, pages without times, and of pictures and channels all but dates and commands in their
headers. JSON is held key by key, without the keys of times; CSV by its other columns. A page with times, whose sentences speak
of them, is held by its sections, the pictures in it and its end; text for people by its size and its end. JSON whose subject is
time (of bench, of tune, of --trace) is held by its keys alone.
"""
import csv
import io
import json
import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "tools"))
from same_results import differing_keys, exr_parts, png_parts  # noqa: E402

ABOUT_TIME = re.compile(r"(^|/)(bench|also|trace|tune)\.json$|_times\.jsonl$")
TIMED_COLUMN = re.compile(r"_ms(_|$)|^derived$")


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


def lines_differ(name, base, new):
    base, new = base.splitlines(), new.splitlines()
    return len(base) != len(new) or any(json_differs(name, a, b) for a, b in zip(base, new))


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
