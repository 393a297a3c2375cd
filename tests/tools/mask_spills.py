#!/usr/bin/env python3
"""Finds where a program reads more of a spilled mask register than was stored.

    tests/tools/mask_spills.py [--self-test] PROGRAM...

GCC 12 may store one of AVX-512's mask registers on the stack by `kmovb` or `kmovw`, which write its 8 or 16 bits, and
read 32 there: the upper bits are then whatever stood in that place before, and lanes seem to be set that do not exist.
raytrace/mask_bits-inl.h keeps the compiler from it. From every such store this follows a function's instructions, over
jumps, to the first that reads or overwrites the place. The places found are listed, and the exit code is then 1.
--self-test first looks at a function with the fault, and at three without.
"""

import argparse
import pathlib
import platform
import re
import shutil
import subprocess
import sys
import tempfile

SKIPPED = 77
WIDEST_READ = 4  # bytes, at least, that a read of a whole number takes
SLOT = re.compile(r"(-?0x[0-9a-f]+)?\((%rsp|%rbp)\)")
SUFFIX = {"b": 1, "w": 2, "l": 4, "d": 4, "q": 8}
REGISTERS = [
    (re.compile(r"%zmm"), 64),
    (re.compile(r"%ymm"), 32),
    (re.compile(r"%xmm"), 16),
    (re.compile(r"%r(ax|bx|cx|dx|si|di|bp|sp|8|9|1[0-5])(?![0-9dwb])"), 8),
    (re.compile(r"%(e(ax|bx|cx|dx|si|di|bp|sp)|r\d+d)(?![0-9])"), 4),
    (re.compile(r"%(ax|bx|cx|dx|si|di|r\d+w)(?![0-9])"), 2),
    (re.compile(r"%([abcd][lh]|sil|dil|r\d+b)"), 1),
]
SCALARS = {"vmovd": 4, "movd": 4, "vmovss": 4, "movss": 4, "vmovq": 8, "movq": 8, "vmovsd": 8, "movsd": 8}
WRITES_LAST = re.compile(r"(v?mov|kmov|add|sub|and|or|xor|inc|dec|neg|not|sh[lr]|sar|set|pop|vextract|vpextr|xchg)")
READS_LAST = re.compile(r"(add|sub|and|or|xor|inc|dec|neg|not|sh[lr]|sar|cmp|test|push|xchg)")
NO_RETURN = re.compile(
    r"<(abort|std::(terminate|__throw)|__cxa_(re)?throw|__cxa_throw_bad|_Unwind_Resume|__stack_chk_fail|__assert_fail"
    r"|__asan_report|__ubsan.*abort)"
)


class Instruction:
    def __init__(self, address, name, operands):
        self.address, self.name = address, name
        self.calls_no_return = name.startswith("call") and bool(NO_RETURN.search(operands))
        self.operands = operands.split("#")[0].split("<")[0].strip()
        self.slot, self.reads, self.writes = self._stack_access()

    def _width(self):
        """Bytes of the place in memory; 0 where that is not known."""
        if self.name.startswith("kmov") or re.match(r"mov[sz][bwl]", self.name):
            return SUFFIX[self.name[4]]
        if self.name in SCALARS:
            return SCALARS[self.name]
        others = SLOT.sub("", self.operands)
        return next((width for pattern, width in REGISTERS if pattern.search(others)), SUFFIX.get(self.name[-1], 0))

    def _stack_access(self):
        """The place on the stack (offset, register), and the bytes that are read and written there."""
        place = SLOT.search(self.operands)
        if not place or self.name.startswith(("lea", "call", "j", "nop", "prefetch")):
            return None, 0, 0
        slot, width = (int(place.group(1) or "0", 16), place.group(2)), self._width()
        is_last = self.operands.endswith(place.group(0))
        is_only = "," not in SLOT.sub("", self.operands)
        writes = width if is_last and WRITES_LAST.match(self.name) else 0
        reads = width if not is_last or READS_LAST.match(self.name) or (is_only and not writes) else 0
        return slot, reads, writes

    def ends(self):
        return self.name.startswith(("ret", "ud2", "hlt")) or self.calls_no_return

    def __str__(self):
        return f"{self.address:x} {self.name} {self.operands}"


def functions(program):
    """Of each function its name and its instructions."""
    command = ["objdump", "-d", "--no-show-raw-insn", "-C", "-w", program]
    name, body = "", []
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as listing:
        for line in listing.stdout:
            if head := re.match(r"[0-9a-f]+ <(.*)>:$", line):
                yield name, body
                name, body = head.group(1), []
            elif one := re.match(r" *([0-9a-f]+):\t(?:(?:lock|rep\w*|bnd|notrack|data16|cs|ds) )*(\S+) *(.*)$", line):
                body.append(Instruction(int(one.group(1), 16), one.group(2), one.group(3)))
    yield name, body
    if listing.returncode != 0:
        sys.exit(f"objdump {program}: exit {listing.returncode}")


def next_places(body, index, i):
    one = body[i]
    if one.ends():
        return
    if one.name.startswith("j"):
        target = re.match(r"([0-9a-f]+)$", one.operands)
        if target and int(target.group(1), 16) in index:
            yield index[int(target.group(1), 16)]
        if one.name == "jmp":
            return
    if i + 1 < len(body):
        yield i + 1


def first_wide_read(body, index, start):
    """Of what body[start] stored in part, or nothing."""
    (offset, base), stored = body[start].slot, body[start].writes
    seen, todo = set(), list(next_places(body, index, start))
    while todo:
        i = todo.pop()
        if i in seen:
            continue
        seen.add(i)
        one = body[i]
        if one.slot and one.slot[1] == base:
            if one.slot[0] == offset and one.reads > stored:
                return one
            if one.writes and one.slot[0] < offset + WIDEST_READ and one.slot[0] + one.writes > offset:
                continue
        todo.extend(next_places(body, index, i))
    return None


def faults(program):
    """(function, store, read)."""
    for name, body in functions(program):
        index = {one.address: i for i, one in enumerate(body)}
        for i, one in enumerate(body):
            if one.name in ("kmovb", "kmovw") and one.writes and (read := first_wide_read(body, index, i)):
                yield name, one, read


SELF_TEST = """
.globl faulty, rewritten, reloaded, elsewhere
faulty: kmovb %k1, 0x10(%rsp)
  test %eax, %eax
  je 1f
  ret
1: mov 0x10(%rsp), %edx
  ret
rewritten: kmovb %k1, 0x10(%rsp)
  mov %ecx, 0x10(%rsp)
  mov 0x10(%rsp), %edx
  ret
reloaded: kmovw %k1, 0x10(%rsp)
  movzwl 0x10(%rsp), %edx
  kmovw 0x10(%rsp), %k2
  ret
elsewhere: kmovb %k1, 0x10(%rsp)
  jmp 2f
  mov 0x10(%rsp), %edx
2: mov 0x14(%rsp), %edx
  ret
"""


def self_test():
    with tempfile.TemporaryDirectory() as folder:
        source, program = pathlib.Path(folder, "a.s"), pathlib.Path(folder, "a.o")
        source.write_text(SELF_TEST)
        subprocess.run(["as", "-o", program, source], check=True)
        found = [name for name, _, _ in faults(str(program))]
    if found != ["faulty"]:
        sys.exit(f"self-test: found {found}, not faulty alone")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--self-test", action="store_true")
    parser.add_argument("programs", nargs="+", metavar="PROGRAM")
    args = parser.parse_args()
    if platform.machine() != "x86_64" or not shutil.which("objdump"):
        print("skipped: an x86-64 machine and objdump are wanted")
        return SKIPPED
    if args.self_test:
        self_test()
    count = 0
    for program in args.programs:
        for name, store, read in faults(program):
            count += 1
            print(f"{program}: {name}: {store}, then {read}")
    print(f"{count} reads of more than was stored")
    return 1 if count else 0


if __name__ == "__main__":
    sys.exit(main())
