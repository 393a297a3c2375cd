"""The numbers that stand in a shader itself: a reader's bias is mostly one of its constants or of these."""
import re
from dataclasses import dataclass

import numpy as np

from . import spirv

_NUMBER = r"(?:\d+\.?\d*(?:[eE][-+]?\d+)?|\.\d+(?:[eE][-+]?\d+)?)[fF]?"


OF_SRGB = (0.0031308, 12.92, 1.055, 0.41666, 2.2, 1 / 2.2)  # numbers of its curve


@dataclass(frozen=True)
class Numbers:
    """What a reader works with: constants that it is given, numbers of its text that stand alone, and such that something is multiplied by."""

    given: tuple = ()
    alone: tuple = ()
    factors: tuple = ()
    has_tangent: bool = False  # whether it asks for one
    vectors: tuple = ()  # of the constants that it is given, those that are several numbers

    @property
    def encodes(self):
        """Whether the shader writes sRGB or a power like it; None where its numbers are not told."""
        own = {*self.alone, *self.factors}
        return any(abs(n - of) < 2e-4 * of for n in own for of in OF_SRGB) if own else None

    @property
    def all(self):
        return [*self.given, *self.alone, *self.factors]


def of_constants(named):
    """The Numbers of constants [(name, value)]: those of one vector or array have one name, but for what follows it."""
    together = {}
    for name, value in named:
        together.setdefault(re.sub(r"(\.[xyzw]|\[\d+\])$", "", name), []).append(value)
    return Numbers(tuple(value for _, value in named), vectors=tuple(tuple(v) for v in together.values() if len(v) > 1))


def _value(text):
    return float(text.rstrip("fF"))


def _holds(condition, macros):
    """Whether a condition of the preprocessor holds; None where it is more than names that are defined or not."""
    words = re.sub(r"defined\s*\(?\s*(\w+)\s*\)?", lambda found: str(found[1] in macros), condition)
    if not re.fullmatch(r"(?:\s|True|False|\|\||&&|!|\(|\)|[01])+", words):
        return None
    try:
        return bool(eval(words.replace("||", " or ").replace("&&", " and ").replace("!", " not "), {"__builtins__": {}}))  # truth values alone
    except SyntaxError:
        return None


def without_comments(text):
    return re.sub(r"//[^\n]*|/\*.*?\*/", "", text, flags=re.DOTALL)


def _taken(text):
    """A GLSL text without the lines that its preprocessor leaves out; those of conditions that are not understood stay."""
    macros, stack, out = set(), [], []  # stack: [whether lines are taken, whether a branch was]
    for line in text.splitlines():
        found = re.match(r"\s*#\s*(ifdef|ifndef|if|elif|else|endif|define)\b(.*)", line)
        word, rest = (found[1], found[2].strip()) if found else ("", "")
        if word in ("ifdef", "ifndef", "if"):
            rest = f"{'!' if word == 'ifndef' else ''}defined({rest})" if word != "if" else rest
            holds = _holds(rest, macros)
            stack.append([holds is not False, holds is True])
        elif word == "elif" and stack:
            holds = _holds(rest, macros)
            stack[-1] = [not stack[-1][1] and holds is not False, stack[-1][1] or holds is True]
        elif word == "else" and stack:
            stack[-1] = [not stack[-1][1], True]
        elif word == "endif" and stack:
            stack.pop()
        elif all(taken for taken, _ in stack):
            if word == "define" and rest:
                macros.add(re.match(r"\w+", rest)[0])
            out.append(line)
    return "\n".join(out)


def of_glsl(text):
    """Numbers of a GLSL text, and products of two that stand side by side; macros that are numbers are put in their places."""
    text = _taken(without_comments(text))
    macros = dict(re.findall(rf"^[ \t]*#[ \t]*define[ \t]+(\w+)[ \t]+(-?{_NUMBER})[ \t]*$", text, flags=re.MULTILINE))
    if macros:
        text = re.sub(r"\b(" + "|".join(map(re.escape, macros)) + r")\b", lambda found: macros[found[1]], text)
    text = re.sub(r"^[ \t]*#.*$", "", text, flags=re.MULTILINE)
    factor = re.compile(r"\s*\*")
    pairs = [(one, _value(one[1]) * _value(one[3]) if one[2] == "*" else _value(one[1]) / (_value(one[3]) or np.inf))
             for one in re.finditer(rf"(?<![\w.])({_NUMBER})\s*([*/])\s*({_NUMBER})", text)]
    folded = [one.span() for one, _ in pairs]
    ones = [(one, _value(one[1])) for one in re.finditer(rf"(?<![\w.])({_NUMBER})", text) if not any(a <= one.start() < b for a, b in folded)]
    multiplied = lambda one: factor.match(text, one.end()) or re.search(r"\*\s*$", text[:one.start()])
    found = [(value, multiplied(one)) for one, value in [*pairs, *ones]]
    return Numbers((), tuple(sorted({v for v, by in found if not by})), tuple(sorted({v for v, by in found if by})), bool(re.search(r"\btan\s*\(", text)))


def of_code(code):
    """Numbers of a fragment shader as replay.Frame.fragment_code() has it."""
    if not code:
        return Numbers()
    if isinstance(code, str):
        return of_glsl(code)
    constants = tuple(sorted(set(spirv.float_constants(code))))
    return Numbers((), constants, constants, spirv.has_tangent(code))
