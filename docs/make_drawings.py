#!/usr/bin/env python3
"""Writes the lessons' drawings that are no figure's picture (docs/images/lesson-*.svg), each from the formula that its lesson has.
  make_drawings.py            writes them
  make_drawings.py --check    says which differ"""
import math
import pathlib
import sys

IMAGES = pathlib.Path(__file__).resolve().parent / "images"
STYLE = """
  text { font: 15px sans-serif; fill: #22262b; }
  .small { font-size: 13px; }
  .line { stroke: #22262b; stroke-width: 2; fill: none; }
  .thin { stroke: #6b7178; stroke-width: 1; fill: none; }
  .dots { stroke: #6b7178; stroke-width: 1.5; fill: none; stroke-dasharray: 3 4; }
  .ray { stroke: #b35900; stroke-width: 2; fill: none; }
  .map { stroke: #2166ac; stroke-width: 2.5; fill: none; }
  .surface { stroke: #22262b; stroke-width: 5; fill: none; }
  .body { fill: #d5d8dc; stroke: #22262b; stroke-width: 2; }
  .lit { fill: #f4d58d; stroke: #6b7178; }
  .dark { fill: #4a5563; stroke: #6b7178; }
  .glass { fill: #cfe3f3; stroke: none; }
  .one { fill: #cdbfe0; stroke: #22262b; stroke-width: 2; }
  .two { fill: #bcd8ee; stroke: #22262b; stroke-width: 2; }
  .dot { fill: #b35900; }
  .node { fill: #2166ac; }
"""


def n(value):
    return f"{value:.1f}".rstrip("0").rstrip(".")


class Drawing:
    def __init__(self, title, width, height):
        self.title, self.width, self.height, self.parts = title, width, height, []

    def shape(self, name, kind, points):
        self.parts.append(f'<{name} class="{kind}" points="{" ".join(f"{n(x)},{n(y)}" for x, y in points)}"/>')

    def line(self, kind, *points):
        self.shape("polyline", kind, points)

    def area(self, kind, *points):
        self.shape("polygon", kind, points)

    def dot(self, x, y, radius=5, kind="dot"):
        self.parts.append(f'<circle class="{kind}" cx="{n(x)}" cy="{n(y)}" r="{n(radius)}"/>')

    def text(self, x, y, words, anchor="middle", kind=""):
        kind = f' class="{kind}"' if kind else ""
        self.parts.append(f'<text{kind} x="{n(x)}" y="{n(y)}" text-anchor="{anchor}">{words}</text>')

    def arrow(self, kind, start, end):
        """A line with a head at its end."""
        angle = math.atan2(end[1] - start[1], end[0] - start[0])
        self.line(kind, start, end)
        self.line(kind, *((end[0] - 11 * math.cos(angle + a), end[1] - 11 * math.sin(angle + a)) if a else end for a in (0.4, 0, -0.4)))

    def arc(self, kind, center, radius, first, last):
        """From one angle to another, in degrees, counted as in books: 0 to the right, 90 up."""
        angles = (math.radians(first + (last - first) * i / 24) for i in range(25))
        self.line(kind, *((center[0] + radius * math.cos(a), center[1] - radius * math.sin(a)) for a in angles))

    def svg(self):
        head = f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {self.width} {self.height}" width="{self.width}" height="{self.height}" role="img">'
        back = f'<rect width="{self.width}" height="{self.height}" rx="8" fill="#f7f7f4"/>'
        return "\n".join([head, f"<title>{self.title}</title>", f"<style>{STYLE}</style>", back, *self.parts, "</svg>\n"])


def shared_edge():
    d = Drawing("Two triangles with a common edge: its number is positive for one and negative for the other", 540, 272)
    a, b, c, e = (70, 130), (290, 240), (250, 40), (480, 150)
    d.area("one", a, b, c)
    d.area("two", e, c, b)
    for corner, name, dx, dy in ((a, "A", -16, 5), (b, "B", 4, 22), (c, "C", -2, -10), (e, "D", 16, 5)):
        d.text(corner[0] + dx, corner[1] + dy, name)
    d.dot(270, 140)
    d.text(170, 145, "Cx·By − Cy·Bx")
    d.text(372, 145, "Bx·Cy − By·Cx")
    return d


def assumptions():
    d = Drawing("Light goes straight, passes through other light, and may be followed backwards", 720, 240)
    for at, words in ((0, "straight lines"), (240, "no disturbance"), (480, "the same both ways")):
        d.text(at + 120, 222, words)
        if at:
            d.line("thin", (at, 20), (at, 215))
    # A lamp, a wall with a gap, the spot behind it.
    d.dot(40, 110, 9, "lit")
    d.line("surface", (120, 20), (120, 95))
    d.line("surface", (120, 125), (120, 200))
    d.line("line", (205, 20), (205, 200))
    for y in (95, 125):
        d.line("ray", (40, 110), (205, 110 + (y - 110) * 165 / 80))
    # Two beams that cross.
    for kind, y in (("ray", 50), ("map", 170)):
        d.arrow(kind, (270, y), (450, 220 - y))
    # A way off a mirror and through glass, in both directions.
    d.area("glass", (560, 130), (620, 70), (640, 90), (580, 150))
    d.line("surface", (640, 195), (710, 195))
    for shift in (-3, 3):
        way = [(505 + shift, 75 - shift), (575, 118 - shift), (602, 128 - shift), (672 + shift, 190), (706 + shift, 90)]
        d.arrow("ray" if shift > 0 else "map", *(way[-2:] if shift > 0 else way[1::-1]))
        d.line("ray" if shift > 0 else "map", *way)
    d.text(507, 62, "eye", kind="small")
    d.text(690, 78, "lamp", kind="small")
    return d


def pinhole():
    d = Drawing("A pinhole camera: the picture stands on its head behind the hole, and upright on the window before it", 640, 272)
    eye = (270, 140)
    d.area("body", (90, 60), (eye[0], 60), (eye[0], 220), (90, 220))
    d.line("surface", (90, 60), (90, 220))
    for top, kind in ((40, "ray"), (240, "ray")):
        far = (560, top)
        slope = (far[1] - eye[1]) / (far[0] - eye[0])
        d.line(kind, far, eye, (90, eye[1] + slope * (90 - eye[0])))
    d.arrow("line", (560, 240), (560, 40))
    d.arrow("map", (90, 140 - 100 * 180 / 290), (90, 140 + 100 * 180 / 290))
    d.arrow("map", (400, 140 + 100 * 130 / 290), (400, 140 - 100 * 130 / 290))
    d.line("dots", (400, 30), (400, 250))
    d.dot(*eye, 6)
    d.text(eye[0] + 4, 40, "hole: the eye")
    d.line("thin", (eye[0], 46), (eye[0], 130))
    d.text(80, 40, "film, on its head")
    d.text(404, 20, "window, upright")
    d.line("thin", (eye[0], 258), (400, 258))
    d.text(335, 252, "1", kind="small")
    d.text(566, 30, "thing")
    return d


def shading():
    d = Drawing("At the hit: the normal, the ways to the light and to the eye, and the angle that decides", 540, 272)
    hit = (270, 220)
    d.line("surface", (60, 220), (480, 220))
    d.arrow("line", hit, (270, 70))
    d.arrow("map", hit, (420, 90))
    d.line("dots", (420, 90), (462, 54))
    d.dot(470, 46, 11, "lit")
    d.line("ray", (90, 60), hit)
    d.arc("thin", hit, 62, 41, 90)
    d.dot(*hit)
    d.text(256, 66, "n", "end")
    d.text(398, 76, "l")
    d.text(497, 50, "lamp", "start")
    d.text(88, 48, "eye")
    d.text(306, 148, "θ")
    d.text(270, 250, "n·l = cos θ: as much light as the surface turns to the lamp")
    return d


def mirror_snell():
    d = Drawing("A mirror, and Snell's law: what turns round at the surface, and what does not", 720, 290)
    for at in (180, 540):
        d.line("dots", (at, 30), (at, 260))
    d.line("surface", (30, 150), (330, 150))
    d.area("glass", (390, 150), (690, 150), (690, 262), (390, 262))
    d.line("line", (390, 150), (690, 150))
    angle = math.radians(50)
    size = 135
    for at in (180, 540):
        d.arrow("ray", (at - size * math.sin(angle), 150 - size * math.cos(angle)), (at, 150))
        d.text(at - size * math.sin(angle) - 8, 150 - size * math.cos(angle) - 4, "d")
        d.arrow("line", (at, 150), (at, 62))
        d.text(at + 12, 62, "n", "start")
        d.arc("thin", (at, 150), 46, 90, 140)
    d.arrow("map", (180, 150), (180 + size * math.sin(angle), 150 - size * math.cos(angle)))
    d.text(180 + size * math.sin(angle) + 12, 150 - size * math.cos(angle), "r")
    d.arc("thin", (180, 150), 46, 40, 90)
    # Twice c along n leads from d to r.
    d.arrow("dots", (180 + size * math.sin(angle), 150 + size * math.cos(angle)), (180 + size * math.sin(angle), 150 - size * math.cos(angle) + 6))
    d.line("dots", (180, 150), (180 + size * math.sin(angle), 150 + size * math.cos(angle)))
    d.text(180 + size * math.sin(angle) + 10, 175, "2c·n", "start")
    inside = math.asin(math.sin(angle) / 1.5)
    d.arrow("map", (540, 150), (540 + 110 * math.sin(inside), 150 + 110 * math.cos(inside)))
    d.text(540 + 110 * math.sin(inside) + 14, 256, "t")
    d.arc("thin", (540, 150), 60, 270, 270 + math.degrees(inside))
    d.text(514, 94, "θ₁")
    d.text(556, 230, "θ₂")
    d.text(154, 94, "θ")
    d.text(206, 94, "θ")
    d.text(610, 138, "n₁ (air)", "start")
    d.text(610, 174, "n₂ (glass)", "start")
    d.text(540, 282, "n₁·sin θ₁ = n₂·sin θ₂")
    d.text(180, 282, "the same angle on the other side")
    return d


def reflected(cosine, ratio):
    """Fresnel's share: `ratio` is the index before the surface over that behind it."""
    k = 1 - ratio**2 * (1 - cosine**2)
    if k <= 0:
        return 1.0
    s = (ratio * cosine - math.sqrt(k)) / (ratio * cosine + math.sqrt(k))
    p = (cosine - ratio * math.sqrt(k)) / (cosine + ratio * math.sqrt(k))
    return (s * s + p * p) / 2


def fresnel():
    d = Drawing("The reflected share R over the angle of arrival, into glass of index 1.5 and out of it", 560, 290)
    left, right, bottom, top = 70, 520, 240, 30

    def place(degrees, share):
        return left + (right - left) * degrees / 90, bottom - (bottom - top) * share

    for share, words in ((0, "0"), (0.5, "50 %"), (1, "R = 100 %")):
        d.line("thin", place(0, share), place(90, share))
        d.text(left - 6, place(0, share)[1] + 5, words.replace("R = ", ""), "end", "small")
    for degrees in (0, 30, 60, 90):
        d.text(place(degrees, 0)[0], bottom + 20, f"{degrees}°", kind="small")
    d.line("map", *(place(a / 2, reflected(math.cos(math.radians(a / 2)), 1 / 1.5)) for a in range(181)))
    d.line("ray", *(place(a / 4, reflected(math.cos(math.radians(a / 4)), 1.5)) for a in range(361)))
    d.text(*(sum(p) for p in zip(place(66, 0.26), (0, 0))), "into glass")
    d.text(place(40, 0)[0] - 10, place(0, 0.6)[1], "out of glass", "end")
    d.text(place(43, 0)[0], place(0, 0.8)[1], "total from 41.8° on", "start")
    d.text(place(3, 0)[0], place(0, 0.1)[1], "4 %", "start")
    d.text((left + right) / 2, 282, "angle between ray and normal")
    return d


def texel():
    d = Drawing("One texel of a map: all light that comes through it has one stored depth, that at its centre", 620, 300)
    low, high, top = 230, 390, 48
    d.line("map", (110, top), (510, top))
    for x in (low - 160, low, high, high + 160):
        d.line("map", (min(max(x, 110), 510), top - 8), (min(max(x, 110), 510), top + 8))
    d.text(310, 26, "one texel")
    d.text(120, 30, "the map", "start", "small")
    for x in (low, high):
        d.line("dots", (x, top), (x, 282))

    def floor(x):
        return 120 + 0.42 * (x - 110)

    d.line("surface", (110, floor(110)), (510, floor(510)))
    center = (low + high) / 2
    d.arrow("ray", (center, top), (center, floor(center) - 4))
    d.text(center + 8, 130, "depth that is stored", "start", "small")
    d.line("map", (low, floor(center)), (high, floor(center)))
    for x, words, anchor, dx, dy in ((low + 26, "nearer: lit", "end", -34, 40), (high - 24, "farther: dark", "start", 32, -12)):
        d.dot(x, floor(x))
        d.text(x + dx, floor(x) + dy, words, anchor, "small")
        d.line("dots", (x, top), (x, floor(x)))
    return d


def filtered():
    d = Drawing("A filter of 3 by 3 texels: nine answers of yes or no, whose mean is 5/9; beside it the stairs become a ramp", 640, 272)
    answers = (1, 1, 0, 1, 1, 0, 1, 0, 0)
    for i, answer in enumerate(answers):
        x, y = 60 + 58 * (i % 3), 40 + 58 * (i // 3)
        d.area("lit" if answer else "dark", (x, y), (x + 54, y), (x + 54, y + 54), (x, y + 54))
    d.dot(147, 127, 6)
    d.text(147, 246, f"{sum(answers)} of 9 texels say lit: {sum(answers)}/9")
    left, right, bottom, top = 340, 610, 210, 60
    d.line("thin", (left, bottom), (right, bottom))
    d.text(left - 8, top + 5, "lit", "end", "small")
    d.text(left - 8, bottom + 5, "dark", "end", "small")
    middle = (left + right) / 2
    d.line("line", (left, top), (middle, top), (middle, bottom), (right, bottom))
    d.line("map", (left, top), (middle - 81, top), (middle + 81, bottom), (right, bottom))
    d.line("dots", (middle - 81, 226), (middle + 81, 226))
    d.text(middle, 246, "the filter: 3 texels")
    d.text(middle + 8, 40, "without", "start", "small")
    d.line("thin", (middle + 4, 44), (middle, 74))
    return d


def moller():
    d = Drawing("A triangle by its corner A and its edges E and F, and a ray from o along d to the point P", 620, 290)
    a, b, c, p, o = (150, 230), (470, 250), (330, 60), (330, 186), (560, 90)
    d.area("two", a, b, c)
    d.arrow("line", a, b)
    d.arrow("line", a, c)
    d.arrow("ray", o, (p[0] + 5, p[1] - 2))
    d.line("dots", a, o)
    d.dot(*p)
    d.dot(*o)
    for at, words, dx, dy in ((a, "A", -14, 6), (b, "B", 14, 8), (c, "C", 0, -10), (p, "P", 6, 24), (o, "o", 14, 0)):
        d.text(at[0] + dx, at[1] + dy, words)
    d.text(316, 264, "E = B − A")
    d.text(214, 140, "F = C − A", "end")
    d.text(455, 162, "d", "start")
    d.text(462, 104, "s = o − A", "end")
    return d


DRAWINGS = {
    "shared-edge": shared_edge,
    "assumptions": assumptions,
    "pinhole": pinhole,
    "shading": shading,
    "mirror-snell": mirror_snell,
    "fresnel": fresnel,
    "texel": texel,
    "filter": filtered,
    "moller": moller,
}


def main():
    different = []
    for name, draw in DRAWINGS.items():
        path, text = IMAGES / f"lesson-{name}.svg", draw().svg()
        if "--check" not in sys.argv[1:]:
            path.write_text(text, encoding="utf-8")
        elif not path.exists() or path.read_text(encoding="utf-8") != text:
            different.append(f"{path.name} is not what docs/make_drawings.py writes")
    print("\n".join(different) or "fine")
    return 1 if different else 0


sys.exit(main())
