"""Just enough of an assembler for SPIR-V (Khronos, SPIR-V 1.0) to write the stand-ins of stand_ins.py without a compiler."""
import struct

CAPABILITY_SHADER, MODEL_LOGICAL, MODEL_GLSL450 = 1, 0, 1
VERTEX, FRAGMENT = 0, 4
INPUT, OUTPUT = 1, 3
POSITION, FRAG_COORD, FRAG_DEPTH, VERTEX_INDEX = 0, 15, 22, 42
FABS = 4  # of GLSL.std.450


def _text(text):
    data = text.encode() + b"\0"
    data += b"\0" * (-len(data) % 4)
    return list(struct.unpack(f"<{len(data) // 4}I", data))


class Module:
    """A module of one entry point, main. Every method returns the new id."""

    def __init__(self, stage):
        self.stage = stage
        self.bound = 1
        self.decorations, self.types, self.body, self.interface, self.modes = [], [], [], [], []
        self._known = {}
        self.library, self.main = self.new(), self.new()
        self.void, self.float, self.int, self.bool = (self._declare(op, *words) for op, words in ((19, ()), (22, (32,)), (21, (32, 1)), (20, ())))
        self.function_type = self._declare(33, self.void)

    def new(self):
        self.bound += 1
        return self.bound - 1

    def _declare(self, op, *words):
        if (op, words) not in self._known:
            made = self._known[op, words] = self.new()
            self.types.append((op, [made, *words]))
        return self._known[op, words]

    def number(self, value):
        return self._constant(self.float, struct.unpack("<I", struct.pack("<f", value))[0])

    def whole(self, value):
        return self._constant(self.int, value)

    def _constant(self, kind, word):
        key = ("constant", kind, word)
        if key not in self._known:
            made = self._known[key] = self.new()
            self.types.append((43, [kind, made, word]))
        return self._known[key]

    def vector(self, size):
        return self._declare(23, self.float, size)

    def builtin(self, storage, kind, which):
        """A variable of the shader's interface."""
        pointer = self._declare(32, storage, kind)
        variable = self.new()
        self.types.append((59, [pointer, variable, storage]))
        self.decorations.append((71, [variable, 11, which]))
        if kind == self.int and self.stage == FRAGMENT:
            self.decorations.append((71, [variable, 14]))
        self.interface.append(variable)
        return variable

    def output(self, kind, location):
        pointer = self._declare(32, OUTPUT, kind)
        variable = self.new()
        self.types.append((59, [pointer, variable, OUTPUT]))
        self.decorations.append((71, [variable, 30, location]))
        self.interface.append(variable)
        return variable

    def op(self, op, kind, *words):
        """An instruction with a result."""
        made = self.new()
        self.body.append((op, [kind, made, *words]))
        return made

    def do(self, op, *words):
        """One without."""
        self.body.append((op, list(words)))

    def load(self, kind, variable):
        return self.op(61, kind, variable)

    def part(self, vector, index):
        return self.op(81, self.float, vector, index)

    def absolute(self, value):
        return self.op(12, self.float, self.library, FABS, value)

    def assembled(self):
        code = [(17, [CAPABILITY_SHADER]), (11, [self.library, *_text("GLSL.std.450")]), (14, [MODEL_LOGICAL, MODEL_GLSL450]),
                (15, [self.stage, self.main, *_text("main"), *self.interface]), *[(16, [self.main, mode]) for mode in self.modes],
                *self.decorations, *self.types, (54, [self.void, self.main, 0, self.function_type]), *self.body, (56, [])]
        words = [0x07230203, 0x00010000, 0, self.bound, 0]
        for op, operands in code:
            words += [(len(operands) + 1) << 16 | op, *operands]
        return struct.pack(f"<{len(words)}I", *words)


def _instructions(code):
    """(opcode, operands) of each instruction of a module."""
    words = struct.unpack(f"<{len(code) // 4}I", code[:len(code) // 4 * 4])
    at = 5 if words and words[0] == 0x07230203 else len(words)
    while at < len(words):
        length = max(words[at] >> 16, 1)
        yield words[at] & 0xFFFF, words[at + 1:at + length]
        at += length


def can_discard(code):
    """Whether a module leaves fragments out: OpKill, OpTerminateInvocation, OpDemoteToHelperInvocation."""
    return any(op in (252, 4416, 5380) for op, _ in _instructions(code))


def replaces_depth(code):
    """Whether a module writes the depth of its fragments: the execution mode DepthReplacing."""
    return any(op == 16 and words[1] == 12 for op, words in _instructions(code))


def float_constants(code):
    """The 32-bit floats that a module declares."""
    floats = {words[0] for op, words in _instructions(code) if op == 22 and words[1] == 32}
    return [struct.unpack("<f", struct.pack("<I", words[2]))[0] for op, words in _instructions(code) if op == 43 and words[0] in floats]


def has_tangent(code):
    """Whether a module asks GLSL.std.450 for a tangent."""
    return any(op == 12 and words[3] == 15 for op, words in _instructions(code))
