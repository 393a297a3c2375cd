"""What somebody else may have put where a command writes: staged folders with lists, links, FIFOs, another user's things.

Each plant is one run of a command over it. Held: nothing outside of the output folder changes, what is not the user's own stays
as it was, and the command either writes what it always does or refuses with exit code 4 and says why.
"""
import dataclasses
import os
import stat
import typing

HOOK = b"#!/bin/sh\necho planted\n"
MINE = b"what nobody may change\n"
OTHER = 65534  # nobody's number
AHEAD = 150  # process numbers that come next


def tree(folder):
    """All that lies in a folder, by name: its kind, owner and content, links not followed."""
    found = {}
    for place, folders, files in os.walk(folder):
        for name in folders + files:
            path = os.path.join(place, name)
            status = os.lstat(path)
            kind = stat.S_IFMT(status.st_mode)
            content = os.readlink(path) if kind == stat.S_IFLNK else None
            if kind == stat.S_IFREG:
                with open(path, "rb") as file:
                    content = file.read()
            found[os.path.relpath(path, folder)] = (kind, status.st_uid, content)
    return found


def put(path, content=MINE):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(content)


def staged_names(number):
    """Of a staged folder: in a folder that is there, and beside one that may not be."""
    return f"out/.gnomon.{number}.part", f"out.gnomon.{number}.part"


def coming_processes():
    with open("/proc/loadavg", encoding="ascii") as file:
        last = int(file.read().split()[-1])
    return range(last + 1, last + AHEAD)


def plant_lists(folder, _command, _base):
    """Lists of an unfinished publication, as older versions believed them: a way out by name, and one by a link."""
    for i, name in enumerate(staged_names(1) + staged_names(2)):
        put(folder / name / ".publishing", b"7 7 ../outside/new\0" if i < 2 else b"7 7 l/new\0")
        put(folder / name / ".replaced/l/new", HOOK)
        put(folder / name / "outside/new", HOOK)
    (folder / "out/l").symlink_to("../outside")
    return ["out/l"]


def plant_links(folder, _command, _base):
    (folder / "out").mkdir(exist_ok=True)
    names = staged_names(1) + staged_names(2)
    for i, name in enumerate(names):
        (folder / name).symlink_to(folder / ("outside" if i < 2 else "nowhere"))
    return names


def plant_others(folder, _command, _base):
    """A file and a FIFO with the names of staged folders."""
    names = staged_names(1) + staged_names(2)
    for name in names[:2]:
        put(folder / name)
    for name in names[2:]:
        os.mkfifo(folder / name)
    return names


def plant_taken_names(folder, _command, _base):
    (folder / "out").mkdir(exist_ok=True)
    names = [name for number in coming_processes() for name in staged_names(number)]
    for name in names:
        (folder / name).symlink_to(folder / "outside")
    return names


def plant_taken_files(folder, _command, base):
    """Links with the names that temporary files will have."""
    files = [name for name in base if name.startswith("out/") and name.count("/") == 1 and not name.endswith("/")]
    (folder / "out").mkdir(exist_ok=True)
    names = [f"{file}.{number}-{count}.part" for file in files[:3] for number in coming_processes() for count in range(3)]
    for name in names:
        (folder / name).symlink_to(folder / "outside/hook")
    return names


def plant_another_users(folder, _command, _base):
    if os.geteuid() != 0:
        return None
    names = [*staged_names(1), "out/theirs.txt"]
    for name in names[:2]:
        put(folder / name / "theirs")
        put(folder / name / ".publishing", b"7 7 ../outside/hook\0")
    put(folder / names[2])
    for name in [*names, "out", *(f"{name}/theirs" for name in names[:2])]:
        os.chown(folder / name, OTHER, OTHER)
    os.chmod(folder / "out", 0o1777)
    below = staged_names(3)[0]  # one's own, with another's in it
    put(folder / below / "folder/theirs")
    os.chown(folder / below / "folder/theirs", OTHER, OTHER)
    return [*names, f"{below}/folder/theirs"]


def plant_linked_folders(folder, command, base):
    """Links in place of folders inside the output folder."""
    if not command.folder:
        return None
    folders = sorted({name.split("/")[1] for name in base if name.startswith("out/") and name.count("/") > 1})
    if not folders:
        return None
    (folder / "out").mkdir(exist_ok=True)
    for name in folders:
        (folder / "out" / name).symlink_to("../outside")
    return [f"out/{name}" for name in folders]


def plant_linked_files(folder, command, base):
    """Links in place of files whose names the program chose: they are replaced, not followed."""
    names = [name for name in base if name.startswith("out/") and name.count("/") == 1 and not name.endswith("/")
             and name not in command.words]
    if not command.folder or not names:
        return None
    (folder / "out").mkdir(exist_ok=True)
    for name in names:
        (folder / name).symlink_to("../outside/" + name.split("/")[1])
    return []


@dataclasses.dataclass
class Plant:
    name: str
    put: typing.Callable  # names that have to stay as they are; None where this is nothing for the command
    said: bool = False  # the program names what it left
    refused: bool = False  # with the reason
    refusable: bool = False  # sweeps and kits look at a file before they replace it


PLANTS = [
    Plant("planted lists", plant_lists), Plant("planted links", plant_links, said=True), Plant("planted files", plant_others, said=True),
    Plant("taken names", plant_taken_names, said=True), Plant("taken temporary names", plant_taken_files),
    Plant("another user's", plant_another_users, said=True),
    Plant("linked folders", plant_linked_folders, refused=True, refusable=True), Plant("linked files", plant_linked_files, refusable=True),
]
