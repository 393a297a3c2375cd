"""Which calls of a command are made to fail, and how: the points of the campaign."""
import collections
import errno

# Libraries whose own failing calls the program cannot answer for, and what they do instead of telling.
EXCEPTIONS = {
    "libLLVM": "ends the process where memory is missing (report_bad_alloc_error)",
    "libOSMesa": "uses what it could not allocate, and waits for threads that it could not start",
    "swrast_dri": "as libOSMesa, through EGL",
    "libgallium": "as libOSMesa, in newer Mesa",
    "libEGL": "as libOSMesa",
    "libGL": "as libOSMesa",
    "libgbm": "as libOSMesa",
    "libglfw": "uses what it could not allocate",
    "libX11": "ends the process by exit(1)",
    "libxcb": "as libX11",
}
# Libraries that take a short answer of read() for the end of the file, so that the file is none of its kind to them. Files on disks
# give short answers at their end alone.
SHORT_IS_END = {"libOpenImageIO": "IOFile::pread()"}
KINDS = ["write", "short-write", "fsync", "close", "rename", "link", "open", "mkdir", "unlink", "truncate", "read", "short-read",
         "list", "stat", "descriptor", "mmap", "malloc", "large-malloc", "thread", "process", "pipe"]
# How each kind fails: errno, and whether it goes on failing (a disk that stays full, no more threads, no more large pieces of
# memory). What clearing up needs itself fails once: names that cannot be removed stay, whoever tries. EINTR is no failure: a signal
# came, and the program makes the call again.
ONCE, ONWARD = False, True
WAYS = {
    "write": [(errno.ENOSPC, ONWARD), (errno.EIO, ONCE), (errno.EDQUOT, ONCE), (errno.EINTR, ONCE)], "short-write": [(0, ONCE), (0, ONWARD)],
    "fsync": [(errno.EIO, ONCE), (errno.EINTR, ONCE), (errno.ENOSPC, ONWARD)],
    "close": [(errno.EIO, ONCE), (errno.EINTR, ONCE), (errno.ENOSPC, ONCE)],
    "rename": [(errno.EIO, ONCE), (errno.EACCES, ONCE)], "link": [(errno.EIO, ONCE), (errno.EPERM, ONWARD)],
    "open": [(errno.EACCES, ONCE), (errno.EIO, ONCE), (errno.EINTR, ONCE)], "mkdir": [(errno.ENOSPC, ONCE), (errno.EACCES, ONWARD)],
    "unlink": [(errno.EACCES, ONCE), (errno.EIO, ONCE)], "truncate": [(errno.ENOSPC, ONCE), (errno.EIO, ONCE), (errno.EINTR, ONCE)],
    "read": [(errno.EIO, ONCE), (errno.EINTR, ONCE)], "short-read": [(0, ONCE), (0, ONWARD)], "list": [(errno.EIO, ONCE), (errno.EACCES, ONCE)],
    "stat": [(errno.EIO, ONCE), (errno.EACCES, ONCE)], "descriptor": [(errno.EMFILE, ONCE), (errno.ENFILE, ONCE)],
    "mmap": [(errno.ENOMEM, ONCE), (errno.ENOMEM, ONWARD)], "malloc": [(errno.ENOMEM, ONCE)], "large-malloc": [(errno.ENOMEM, ONWARD)],
    "thread": [(errno.EAGAIN, ONCE), (errno.EAGAIN, ONWARD)], "process": [(errno.EAGAIN, ONCE), (errno.ENOMEM, ONWARD)],
    "pipe": [(errno.EMFILE, ONCE), (errno.ENFILE, ONWARD)],
}
RESOURCES = {"descriptor", "mmap", "malloc", "large-malloc", "thread", "process", "pipe"}
AROUND = 4  # calls before and after a publishing one

Point = collections.namedtuple("Point", "process kind n error onward old")


def ways_of(kind, only):
    """How a kind fails: in all ways, or with one errno alone."""
    return [way for way in WAYS[kind] if only is None or way[0] == only]


def points_of(counts, calls, kinds, old, budget, only=None):
    """`counts` by (process, kind) and `calls` in their order. All calls around those that publish come first, with an allocation
    between any two of those, then each kind's in turn, spread evenly over its calls."""
    final = [i for i, (_, _, kind, _, path, _) in enumerate(calls)
             if kind in ("rename", "link", "unlink") and "/out/" in path and ".part" not in path and ".gnomon" not in path]
    near = sorted({j for i in final for j in range(max(0, i - AROUND), min(len(calls), i + AROUND + 1))})
    wanted = [(calls[j][1], calls[j][2], calls[j][3]) for j in near if calls[j][2] not in ("stat", "descriptor", "short-write")]
    wanted += allocations_between([calls[i] for i in final])
    share = max(1, budget // 2)
    if len(wanted) > share:
        wanted = [wanted[i * len(wanted) // share] for i in range(share)]
    lists = []
    for kind in kinds:
        places = [(process, n) for (process, k), n in counts.items() if k == kind]
        total = sum(n for _, n in places)
        if total:
            lists.append([place(places, kind, i) for i in spread(total, budget)])
    rounds = [chosen for turn in range(budget) for places in lists for chosen in places[turn:turn + 1]]
    seen = dict.fromkeys(chosen for chosen in wanted + rounds if chosen[1] in kinds)
    return [as_point(i, *chosen, old, only) for i, chosen in enumerate(list(seen)[:budget])]


def allocations_between(final):
    """For each call that publishes the allocation halfway to the next, when older files are away and new ones not there yet."""
    pairs = [(one[1], int(one[5]), int(other[5])) for one, other in zip(final, final[1:]) if one[1] == other[1]]
    return [(process, "malloc", (before + after + 1) // 2) for process, before, after in pairs if after > before]


def place(places, kind, index):
    """The index-th call of a kind over all processes, as (process, kind, n)."""
    for process, count in places:
        if index < count:
            return process, kind, index + 1
        index -= count
    raise IndexError


def as_point(i, process, kind, n, old, only):
    ways = ways_of(kind, only)
    error, onward = ways[(n + i) % len(ways)]
    return Point(process, kind, n, error, onward, old)


def spread(total, most):
    """Numbers below `total`, the last and the first of them before those between, in an order that is even whenever it ends."""
    if total <= most:
        rest = list(range(total))
    else:
        rest = sorted({i * (total - 1) // max(1, most - 1) for i in range(most)})
    order, step = [], 1
    while step < len(rest):
        step *= 2
    while step >= 1:
        order += [i for i in range(len(rest) - 1, -1, -step) if i not in order]
        step //= 2
    return [rest[i] for i in dict.fromkeys([len(rest) - 1, 0] + order)]
