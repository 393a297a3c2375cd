#!/usr/bin/env python3
"""Makes calls of the C library fail, one at a time, in every command of gnomon, and looks at what the command leaves behind. Does
the same over what somebody else has planted where the command writes (planted.py).

usage: tests/faults/campaign.py GNOMON INJECTOR [--points N] [--only COMMAND]... [--kind KIND]... [--error NAME] [--jobs N]
                                [--log FILE] [--table FILE]

INJECTOR is the library made of tests/faults/injector.cpp. A point is one run in which the n-th call of one kind fails. Each
command is run undisturbed first, which counts its calls; then the points are spread evenly over the kinds and over each kind's
calls, and all calls around those that publish a result (the renames to its final names) are points. Half of the runs find an
older result where they write, and every run finds files of the user's there. Each plant is a point as well, with and without an
older result, unless kinds or an error are chosen.

Held at every point:
  - exit code 0 (or what the undisturbed run has): every output is there and is the undisturbed run's (outputs.py);
  - else the outputs are, all together, the older ones byte by byte, or all of the new, and nothing else of the program's lies
    about (commands.py says which come one by one). Three commands finish what they can: a sweep that failed is taken up by the
    next and is then whole, grade gives all points but those of students that it names, and of several captures judge
    refuses the one that it cannot read;
  - files of the user's are what they were;
  - the exit code is 4 where an output failed, 3 where an input did, 5 where a resource did, and none but success where a signal
    interrupted the call; the program does not crash, hang
    (limits: processor time, and a generous time besides) or call it an error of its own.
Where a drawn process of grade fails, its parent has to answer as well.

What is not counted as the program's is listed in points.py, by the library that made the failing call. The last line is
"N points, ..."; the exit code is 1 when anything was wrong. --table writes points and failures by command, in Markdown.
"""
import argparse
import collections
import concurrent.futures
import errno
import json
import os
import pathlib
import resource
import shutil
import signal
import struct
import subprocess
import sys
import tempfile

import planted
from commands import COMMANDS, make_inputs
from outputs import files_below, same, same_but_drawn_anew, same_but_refused, same_but_ungraded
from points import EXCEPTIONS, KINDS, RESOURCES, SHORT_IS_END, points_of, ways_of

FOREIGN = {"out/movie.mp4.part": b"a film that a browser is loading", "out/notes.txt": b"notes", "out/cells/cell-7.png": b"a picture",
           "out/.gnomon-notes": b"more notes", "mine.part": b"mine"}

class Campaign:
    """The points of one command after another in `folder`, whose work/in holds the inputs."""

    def __init__(self, options, folder):
        self.program, self.injector = str(options.gnomon.resolve()), str(options.injector.resolve())
        self.error = getattr(errno, options.error) if options.error else None
        self.kinds = [kind for kind in options.kind or KINDS if ways_of(kind, self.error)]
        self.plants = not options.kind and not options.error
        self.folder, self.account = folder / "work", folder / "account"
        self.counts, self.rows = collections.Counter(), []
        self.environment = dict(
            os.environ, TMPDIR=str(self.folder / "tmp"), HOME=str(folder / "home"),
            XDG_CACHE_HOME=str(folder / "home/cache"), LC_ALL="C.UTF-8", LANG="C.UTF-8")
        (folder / "home/cache").mkdir(parents=True)
        self.inputs = files_below(self.folder / "in") if (self.folder / "in").is_dir() else {}

    # -- One run.

    def clear(self, older=None):
        """Empties all places but in/, and puts an older result and the user's files there."""
        for name in list(os.listdir(self.folder)):
            if name == "in":
                continue
            path = self.folder / name
            shutil.rmtree(path) if path.is_dir() and not path.is_symlink() else path.unlink()
        for name in ("tmp", "said"):
            (self.folder / name).mkdir()
        if older is None:
            (self.folder / "mine.part").write_bytes(FOREIGN["mine.part"])
            return
        for name, content in {**older, **FOREIGN}.items():
            path = self.folder / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(content)

    def run(self, command, faults, seconds=600.0):
        """Exit code (minus a signal's number, or "hangs"), and what was said on stderr."""
        variables = {"LD_PRELOAD": self.injector, "GNOMON_FAULT_PROGRAM": self.program, "GNOMON_FAULT_ACCOUNT": str(self.account),
                     "GNOMON_FAULT_NOT_FROM": ":".join(EXCEPTIONS),
                     "GNOMON_FAULT_FOLDERS": str(self.folder), **{f"GNOMON_FAULT_{k}": str(v) for k, v in faults.items()}}
        for path in (self.account, pathlib.Path(str(self.account) + ".calls")):
            path.unlink(missing_ok=True)

        def limit():
            resource.setrlimit(resource.RLIMIT_CPU, (int(seconds), int(seconds) + 5))
            resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        with open(self.folder / "said/stdout", "wb") as out:
            process = subprocess.Popen([self.program, *command.words], cwd=self.folder, env={**self.environment, **variables}, stdout=out,
                                       stderr=subprocess.PIPE, stdin=subprocess.DEVNULL, preexec_fn=limit, start_new_session=True)
            try:
                said = process.communicate(timeout=60 + 10 * seconds)[1]
            except subprocess.TimeoutExpired:
                os.killpg(process.pid, signal.SIGKILL)
                return "hangs", process.communicate()[1].decode("utf-8", "replace")
        code = "hangs" if process.returncode in (-signal.SIGXCPU, -signal.SIGKILL) else process.returncode
        return code, said.decode("utf-8", "replace")

    def calls(self):
        """What the injector noted: (what, process, kind, n, path, callers)."""
        try:
            lines = pathlib.Path(str(self.account) + ".calls").read_text(errors="replace").splitlines()
        except FileNotFoundError:
            return []
        found = []
        for line in lines:
            head, _, callers = line.partition("\t")
            what, process, kind, n, path = head.split(" ", 4)
            found.append((what, int(process), kind, int(n), path, callers))
        return found

    def counted(self):
        """How often each kind was called, by (process, kind)."""
        data = self.account.read_bytes()
        width = 8 * len(KINDS)
        processes = struct.unpack_from("<q", data)[0]
        rows = [struct.unpack_from(f"<{len(KINDS)}q", data, 8 + p * width) for p in range(processes)]
        return {(p, kind): n for p, row in enumerate(rows) for kind, n in zip(KINDS, row) if n > 0}

    def outputs(self):
        """All that a run left but for inputs and for empty folders where outputs go."""
        return {name: content for name, content in files_below(self.folder).items()
                if not name.startswith("in/") and name not in ("tmp/", "said/", "out/")}

    # -- A command undisturbed.

    def older_result(self, command):
        """What out/ holds before, or None where the command refuses to write over anything."""
        self.clear()
        if command.older is None:
            return {}
        if command.older[0] == "copy":
            shutil.copytree(self.folder / command.older[1], self.folder / "out")
        else:
            done = subprocess.run([self.program, *command.older], cwd=self.folder, env=self.environment, capture_output=True, text=True)
            if done.returncode != 0:
                raise SystemExit(f"{command.name}: the older result: {done.stderr}")
        return {name: content for name, content in self.outputs().items() if name.startswith("out/")}

    def undisturbed(self, command, older, faults):
        self.clear(older)
        code, said = self.run(command, faults)
        if code != command.code:
            raise SystemExit(f"{command.name}: ends with {code} when nothing fails: {said}")
        return self.outputs()

    # -- A point.

    def try_point(self, command, point, base, older, seconds):
        self.clear(older)
        before = self.outputs()
        faults = {"CALL": point.kind, "AT": point.n, "ERROR": point.error, "ONWARD": int(point.onward), "PROCESS": point.process}
        code, said = self.run(command, faults, seconds)
        failed = [call for call in self.calls() if call[0] == "failed"]
        found = self.judge(command, point, code, said, failed, before, base)
        self.counts["points"] += 1
        self.counts["reached"] += bool(failed)
        for what in {what for what, _ in found}:
            self.counts[what] += 1
        path, callers = (failed[0][4], failed[0][5]) if failed else ("", "")
        path = path.replace(str(self.folder) + "/", "")
        if found:
            print(f"{command.name}: {point.kind} {point.n}{' and on' if point.onward else ''} of process {point.process} "
                  f"({errno.errorcode.get(point.error, 'short')}, {path or 'not reached'}{', over an older result' if point.old else ''}): "
                  + "; ".join(text for _, text in found), flush=True)
        self.rows.append({"command": command.name, **point._asdict(), "code": code, "path": path, "callers": callers,
                          "said": said[-400:], "found": found})

    def judge(self, command, point, code, said, failed, before, base):
        found, after = [], self.outputs()
        if files_below(self.folder / "in") != self.inputs:
            found.append(("damaged", "an input was changed"))
            shutil.rmtree(self.folder / "in")
            for name, content in self.inputs.items():
                path = self.folder / "in" / name
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_bytes(content)
        foreign = [name for name, content in FOREIGN.items() if name in before and after.get(name) != content]
        if foreign:
            found.append(("foreign", f"the user's {', '.join(foreign)} changed"))
        found += self.judge_code(command, point, code, said, failed)
        files = {name: content for name, content in after.items() if not self.is_excused(point, name, failed)}
        new = same(base, files)
        if code == command.code:
            if new:
                found.append(("wrong", f"exit code {code}, but {self.listed(new)} missing or different"))
        elif new and command.grades and "not graded: " in said:
            wrong = same_but_ungraded(base, files)
            found += [("half", f"somebody could not be graded, but {self.listed(wrong)} missing or different")] if wrong else []
        elif new and command.refuses and code == 3:
            wrong = same_but_refused(base, files, before)
            found += [("half", f"a capture was refused, but {self.listed(wrong)} missing or different")] if wrong else []
        elif new and command.resumes:
            found += self.judge_resumed(command, said, after, base)
        elif new:
            for output in sorted({command.output_of(name) for name in {**files, **before} if not name.startswith("said/")}):
                found += self.judge_failed(*({k: v for k, v in part.items() if command.output_of(k) == output}
                                             for part in (files, before, base)))
        return found

    @staticmethod
    def listed(names):
        return ", ".join(names[:4]) + (f" and {len(names) - 4} more" if len(names) > 4 else "")

    def is_excused(self, point, name, failed):
        """What could not be removed lies there."""
        if point.kind != "unlink":
            return False
        path = str(self.folder / name).rstrip("/")
        return any(path == call[4] or path.startswith(call[4] + "/") for call in failed)

    def judge_failed(self, after, before, base):
        """One output of a command that failed is the older one, or all of the new."""
        if after == before or not same(base, after):
            return []
        found = []
        damaged = [name for name, content in before.items() if name.startswith("out/") and name not in FOREIGN and after.get(name) != content]
        if damaged:
            found.append(("damaged", f"of the older result {self.listed(damaged)} changed"))
        made = [name for name in after if name not in before]
        ours = [name for name in made if name in base]
        if ours:
            found.append(("half", f"half an output: {self.listed(ours)}"))
        if len(made) > len(ours):
            found.append(("left over", f"left over: {self.listed([name for name in made if name not in base])}"))
        return found

    def judge_resumed(self, command, said, after, base):
        """A sweep that failed is taken up again."""
        parts = [name for name in after if name.endswith((".part", ".part/")) and name not in FOREIGN]
        found = [("left over", f"left over: {self.listed(parts)}")] if parts else []
        code, said = self.run(command, {"CALL": "none"})
        wrong = same_but_drawn_anew(base, self.outputs())
        if code != command.code:
            found.append(("half", f"cannot be taken up again: exit code {code}: {said.strip()[-200:]}"))
        elif wrong:
            found.append(("half", f"taken up again, but {self.listed(wrong)} missing or different"))
        return found

    def judge_code(self, command, point, code, said, failed):
        if code == "hangs":
            return [("hangs", "hangs")]
        if code == command.code:
            return []
        if code < 0 or code >= 128:
            return [("crashes", f"ended by signal {-code if code < 0 else code - 128}: {said.strip()[-160:]}")]
        wanted = self.wanted_codes(point, failed)
        if point.kind == "short-read" and point.onward and "cannot read the image" in said:
            wanted = wanted | {3}  # a library of SHORT_IS_END, after the call that is noted
        if code not in wanted:
            wanted_text = " or ".join(str(c) for c in sorted(wanted)) or "none but success"
            return [("exit codes", f"exit code {code}, not {wanted_text}: {said.strip()[-200:]}")]
        return [] if said.strip() else [("exit codes", f"exit code {code} without a word")]

    def wanted_codes(self, point, failed):
        if point.kind == "short-read" and failed and any(library in call[5] for call in failed for library in SHORT_IS_END):
            return {3}
        if point.kind in ("short-write", "short-read") or not failed:
            return set()
        if point.error == errno.EINTR:
            return {3, 4} if is_a_librarys(failed[0][5]) else set()
        if point.kind in RESOURCES:
            return {5}
        return {3} if failed[0][4].startswith(str(self.folder / "in")) else {4}

    # -- A plant.

    def try_plant(self, command, plant, base, older):
        self.clear(older)
        (self.folder / "outside").mkdir()
        for name in ("hook", *(name.rsplit("/", 1)[-1] for name in base if name.startswith("out/"))):
            (self.folder / "outside" / (name or "hook")).write_bytes(planted.MINE)
        own = {name: content for name, content in base.items() if name not in FOREIGN}
        removed = self.make_room(plant, own) if plant.name.startswith("linked") else []
        stays = plant.put(self.folder, command, own)
        if stays is None:
            return
        before = planted.tree(self.folder)
        code, said = self.run(command, {"CALL": "none"})
        found = self.judge_plant(command, plant, code, said, stays, removed, before, base)
        self.counts["points"] += 1
        self.counts["reached"] += 1
        for what in {what for what, _ in found}:
            self.counts[what] += 1
        if found:
            print(f"{command.name}: {plant.name}{', over an older result' if older else ''}: " + "; ".join(text for _, text in found),
                  flush=True)
        self.rows.append({"command": command.name, "kind": plant.name, "old": bool(older), "code": code, "said": said[-400:], "found": found})

    def make_room(self, plant, base):
        """Takes away what the plant's links are to stand for."""
        removed = []
        for name in {name if plant.name == "linked files" else "/".join(name.split("/")[:2]) for name in base
                     if name.startswith("out/") and not name.endswith("/") and (name.count("/") > 1) == (plant.name == "linked folders")}:
            path = self.folder / name
            removed += [other for other in FOREIGN if other == name or other.startswith(name + "/")]
            if path.is_dir():
                shutil.rmtree(path)
            elif path.exists():
                path.unlink()
        return removed

    def judge_plant(self, command, plant, code, said, stays, removed, before, base):
        after, found = planted.tree(self.folder), []
        kept = [name for name in before if name.startswith(("outside", "in/")) or name in FOREIGN or name in stays]
        changed = [name for name in kept if after.get(name) != before[name]]
        changed += [name for name in after if name.startswith("outside/") and name not in before]
        if changed:
            found.append(("foreign", f"{self.listed(changed)} changed"))
        if code == "hangs" or code < 0 or code >= 128:
            return found + [("crashes", f"ended with {code}: {said.strip()[-160:]}")]
        if code != command.code and not (plant.refusable and code == 4):
            found.append(("exit codes", f"exit code {code}: {said.strip()[-200:]}"))
        if code == 4 and not any(why in said for why in ("link", "differs from", "left as it is")):
            found.append(("exit codes", f"refused without the reason: {said.strip()[-200:]}"))
        if plant.refused and code == command.code and not command.resumes:
            found.append(("foreign", "a link was taken for a folder"))
        if plant.said and command.folder and "left alone" not in said and not command.resumes:
            found.append(("wrong", "what was left is not said"))
        if code == command.code and not plant.refused:
            files = {name: content for name, (kind, _, content) in after.items() if isinstance(content, bytes)
                     and not name.startswith(("in/", "outside/")) and name not in stays}
            wrong = [name for name in same(base, files) if name not in removed and (name in base or name not in before)]
            wrong = [name for name in wrong if not name.endswith("/") and not (name in base and name in stays)]
            if wrong:
                found.append(("wrong", f"exit code {code}, but {self.listed(wrong)} missing or different"))
        return found

    # -- All points of a command.

    def try_command(self, command, budget):
        older = self.older_result(command)
        for old, part in ((True, budget - budget // 2), (False, budget // 2)):
            if part == 0:
                continue
            start = resource.getrusage(resource.RUSAGE_CHILDREN)
            base = self.undisturbed(command, older if old else None, {})
            end = resource.getrusage(resource.RUSAGE_CHILDREN)
            seconds = 10 + 10 * (end.ru_utime + end.ru_stime - start.ru_utime - start.ru_stime)
            counts, calls = self.counted(), self.calls()
            again = same(base, self.undisturbed(command, older if old else None, {"CALL": "none"})) if budget > 20 else []
            if again:
                raise SystemExit(f"{command.name}: two undisturbed runs differ in {', '.join(again)}")
            for point in points_of(counts, calls, self.kinds, old, part, self.error):
                self.try_point(command, point, base, older if old else None, seconds)
            writes = any(name.startswith("out/") for name in base)
            for plant in planted.PLANTS if self.plants and writes else []:
                self.try_plant(command, plant, base, older if old else None)


def is_a_librarys(callers):
    """Whether a library made the call of itself: it tells of what a signal interrupted as of any failure, and cannot be asked to try
    again."""
    own = [name for name in callers.split() if not name.startswith(("libgnomon_fault", "libfault", "libc.so", "libstdc++"))]
    return bool(own) and not own[0].startswith(("gnomon", "libgnomon"))


WRONG = {"half": "half outputs", "damaged": "older results damaged", "wrong": "successes with a wrong output", "left over": "left over",
         "exit codes": "wrong exit codes", "foreign": "files of the user's touched", "crashes": "crashes", "hangs": "hangs"}


def display():
    """Xvfb and the variable that names it, or nothing where it is not there."""
    if shutil.which("Xvfb") is None:
        return None, None
    read_end, write_end = os.pipe()
    server = subprocess.Popen(["Xvfb", "-displayfd", str(write_end), "-screen", "0", "1280x1024x24", "-nolisten", "tcp"],
                              pass_fds=[write_end], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    os.close(write_end)
    with os.fdopen(read_end) as lines:
        number = lines.readline().strip()
    return server, f":{number}"


def tried(options, inputs, command, budget):
    """The counts and the rows of a command's points."""
    with tempfile.TemporaryDirectory(prefix="gnomon-faults-") as folder:
        shutil.copytree(inputs, pathlib.Path(folder) / "work/in", symlinks=True)
        campaign = Campaign(options, pathlib.Path(folder))
        campaign.try_command(command, budget)
    counts = campaign.counts
    print(f"{command.name}: {counts['points']} points, {sum(counts[key] for key in WRONG)} failures", file=sys.stderr, flush=True)
    return counts, campaign.rows


def all_tried(options, commands):
    """Per command its counts and rows, in their order; the files hold what is known so far."""
    shares = sum(command.share for command in commands)
    budgets = [max(2, round(options.points * command.share / shares)) for command in commands]
    with tempfile.TemporaryDirectory(prefix="gnomon-faults-") as folder:
        maker = Campaign(options, pathlib.Path(folder))
        make_inputs(maker.program, maker.folder, maker.environment)
        with concurrent.futures.ProcessPoolExecutor(options.jobs) as pool:
            jobs = [pool.submit(tried, options, maker.folder / "in", *job) for job in zip(commands, budgets)]
            results = []
            for job in jobs:
                results.append(job.result())
                write_files(options, commands, results)
            return results


def write_files(options, commands, results):
    if options.log:
        rows = [json.dumps(row) + "\n" for _, part in results for row in part]
        pathlib.Path(options.log).write_text("".join(rows), encoding="utf-8")
    if options.table:
        pathlib.Path(options.table).write_text(table_of(commands, results), encoding="utf-8")


def table_of(commands, results):
    """Points and failures by command, as lines of Markdown."""
    lines = ["| command | points | reached | " + " | ".join(WRONG.values()) + " |", "|---|" + "--:|" * (2 + len(WRONG))]
    total = collections.Counter()
    for command, (counts, _) in [*zip(commands, results), (None, (total, None))]:
        name = "all" if command is None else f"`{command.name}`"
        lines.append(f"| {name} | " + " | ".join(f"{counts[key]:,}" for key in ("points", "reached", *WRONG)) + " |")
        total.update(counts)
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("gnomon", type=pathlib.Path)
    parser.add_argument("injector", type=pathlib.Path)
    parser.add_argument("--points", type=int, default=120, help="over all commands (default %(default)s)")
    parser.add_argument("--only", action="append", default=[], metavar="COMMAND", help="of commands.py, by its name")
    parser.add_argument("--kind", action="append", choices=KINDS, help="of calls; default all")
    parser.add_argument("--error", metavar="NAME", help="calls fail with this errno alone (EINTR)")
    parser.add_argument("--jobs", type=int, default=1, help="commands at a time (default %(default)s)")
    parser.add_argument("--log", metavar="FILE", help="writes every point as a line of JSON")
    parser.add_argument("--table", metavar="FILE", help="writes points and failures by command, in Markdown")
    options = parser.parse_args()
    commands = [c for c in COMMANDS if not options.only or c.name in options.only]
    server, number = display() if any(c.window for c in commands) else (None, None)
    if server is None:
        commands = [c for c in commands if not c.window]
    else:
        os.environ["DISPLAY"] = number
    try:
        results = all_tried(options, commands)
    finally:
        if server is not None:
            server.terminate()
            server.wait()
    counts = sum((part for part, _ in results), collections.Counter())
    print(f"{counts['points']} points of {len(commands)} commands, {counts['reached']} reached: "
          + ", ".join(f"{counts[key]} {text}" for key, text in WRONG.items()))
    if counts["reached"] < counts["points"] / 2:
        print("the injector does not reach what it is to make fail")
        return 1
    return 1 if any(counts[key] for key in WRONG) else 0


if __name__ == "__main__":
    sys.exit(main())
