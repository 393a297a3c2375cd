#!/usr/bin/python3
"""Runs docs/notebook.md: its shell blocks with the built program, its Python blocks as one script.

docs_notebook_test.py PROGRAM SOURCE_FOLDER WORK_FOLDER. Exit code 77 (skipped) where Python lacks what the page needs.
"""
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys

program, source, work = sys.argv[1], pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3])
try:
    import matplotlib  # noqa: F401
    import OpenImageIO  # noqa: F401
    import pandas  # noqa: F401
except ImportError as missing:
    print(f"skipped: this Python lacks what a notebook needs ({missing})")
    sys.exit(77)

shutil.rmtree(work, ignore_errors=True)
work.mkdir(parents=True)
os.chdir(work)
blocks = re.findall(r"```(sh|python)\n(.*?)```", (source / "docs/notebook.md").read_text(), re.S)
script = ""
for language, text in blocks:
    if language == "python":
        script += text + "\n"
        continue
    for line in text.splitlines():
        words = shlex.split(line)
        assert words[0] == "gnomon", line
        subprocess.run([program, *words[1:]], check=True)
assert script.count("assert") >= 3, "the page no longer checks itself"
exec(compile(script, "docs/notebook.md", "exec"), {"__name__": "__main__"})
for picture in ("out/curve.png", "out/sweep.png"):
    assert os.path.getsize(picture) > 1000, picture
