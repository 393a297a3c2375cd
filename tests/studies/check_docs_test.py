#!/usr/bin/python3
"""Runs the shell steps of the three files of docs/ci.md in a repository: on the main branch, on a change that draws as before, and on
one that draws worse. docker, gh, curl and unzip are stand-ins: what they fetch is the page that the main branch kept.

check_docs_test.py PROGRAM SOURCE_FOLDER WORK_FOLDER. Exit code 77 (skipped) where Python cannot read YAML.
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys

program, source, work = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3])
try:
    import yaml
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(77)

blocks = re.findall(r"```(toml|yaml|make)\n(.*?)```", (source / "docs/ci.md").read_text(), re.S)
assert [language for language, _ in blocks] == ["toml", "yaml", "yaml", "make"], "docs/ci.md has other files"
configuration, workflow, pipeline, makefile = (text for _, text in blocks)

STAND_INS = {
    "docker": """[ "$1" = build ] && exit 0
while [ "$1" != gnomon ]; do shift; done
shift; exec gnomon "$@" """,
    "gh": """case "$2" in
list) [ ! -d "$KEPT" ] || echo 17 ;;
download) cp -r "$KEPT" baseline ;;
esac""",
    "curl": """while [ "$1" != --output ]; do shift; done
[ -d "$KEPT" ] && touch "$2" """,
    "unzip": """mkdir before && cp -r "$KEPT" before/report""",
}

WORSE = configuration.replace("settings = { map-size = 2048 }", 'settings = { map-size = 64, technique = "hard" }')
assert WORSE != configuration


def repository(name):
    """A folder with a scene, the configuration and what stands in for a platform."""
    folder = work / name
    (folder / "scenes").mkdir(parents=True)
    (folder / "bin").mkdir()
    shutil.copy(source / "scene/builtin/acne-floor.json", folder / "scenes/hall.json")
    (folder / "gnomon.toml").write_text(configuration)
    (folder / "Makefile").write_text(makefile)
    for word, text in STAND_INS.items():
        (folder / "bin" / word).write_text(f"#!/bin/sh\n{text}\n")
        (folder / "bin" / word).chmod(0o755)
    (folder / "bin/gnomon").symlink_to(program)
    return folder


def run(folder, steps, **environment):
    """The steps as a platform runs them; the exit code of the last that was run, and all that was said."""
    path = f"{folder}/bin:{os.environ['PATH']}"
    said = ""
    for step in steps:
        done = subprocess.run(["bash", "-eo", "pipefail", "-c", step], cwd=folder, text=True, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, env={**os.environ, "PATH": path, "KEPT": f"{folder}/kept", **environment})
        said += done.stdout
        if done.returncode != 0:
            return done.returncode, said
    return 0, said


def expect(name, found, code, part=""):
    assert found[0] == code and part in found[1], f"{name}: exit code {found[0]}, wanted {code} and {part!r}:\n{found[1]}"


def gate(name, on_main, on_change, part):
    """`on_main`, `on_change`: run the steps there."""
    folder = repository(name)
    expect(f"{name}, the first change", on_change(folder), 0, "no baseline")
    shutil.rmtree(folder / "report")
    expect(f"{name}, main", on_main(folder), 0)
    (folder / "report").rename(folder / "kept")
    expect(f"{name}, no change", on_change(folder), 0, " same ")
    shutil.rmtree(folder / "baseline"), shutil.rmtree(folder / "before", ignore_errors=True)
    (folder / "gnomon.toml").write_text(WORSE)
    expect(f"{name}, worse", on_change(folder), 1, part)
    assert (folder / "report/hall/diff/report.html").exists(), "the page has no diff"


shutil.rmtree(work, ignore_errors=True)
steps = yaml.safe_load(workflow)["jobs"]["check"]["steps"]
shells = [step["run"] for step in steps if "run" in step]
always = [step["run"] for step in steps if "run" in step and "if" not in step]
assert len(shells) == 3 and len(always) == 2
gate("github", lambda folder: run(folder, always), lambda folder: run(folder, shells, GITHUB_BASE_REF="main"), "::error title=")

script = yaml.safe_load(pipeline)["shadows"]["script"]
gate("gitlab", lambda folder: run(folder, script), lambda folder: run(folder, script, CI_MERGE_REQUEST_IID="5"), "exceeded: ")

if shutil.which("make"):
    folder = repository("make")
    expect("make baseline", run(folder, ["make baseline"]), 0)
    expect("make shadows", run(folder, ["make shadows"]), 0, " same ")
    (folder / "gnomon.toml").write_text(WORSE)
    expect("make shadows, worse", run(folder, ["make shadows"]), 2, "exceeded: ")
