#!/usr/bin/env python3
"""Counts the files that a new metric, setting, technique, light shape, file format and lesson take.

    project_exercise_test.py SOURCE          counts, and holds the table of CONTRIBUTING.md to the counts
    project_exercise_test.py SOURCE --apply  makes all six changes there, to be built and tried

Each exercise is a small one that works: its lines are all that it takes beside tests, manual and changelog. An anchor that
is gone, or stands there several times, fails the test: then the exercise is to be done again by hand, and the table with it.
"""
import pathlib
import re
import sys

AFTER, BEFORE, REPLACE = "after", "before", "replace"


def row(name, kind, read_by, text):
    return (f'    {{.name = "{name}",\n     .key = "{name}",\n     .group = SettingGroup::filter,\n     .kind = {kind},\n'
            f'     .read_by = {read_by},\n     .type = "N",\n     .help = "{text}",\n     .title = "{name}",\n     .what = "{text}."}},\n')


# File, anchor, where the text stands beside it, text. Without an anchor the file is new; of "file <- other" it is the other
# with the anchor's word replaced.
EXERCISES = {
    "a metric": [  # how much darker or lighter the picture is in all
        ("compare/comparison.h", "  double mean_absolute = 0.0, rms = 0.0;\n", AFTER, "  double surplus = 0.0;\n"),
        ("compare/ladder/budget.cpp", "  error.mean_absolute = absolute_ / compared_;\n", AFTER,
         "  error.surplus = (missed_shadow_ - false_shadow_) / compared_;\n"),
        ("compare/result/figures.cpp", '    {"error.fractional", "pixels", at<error, &E::fractional>()},\n', AFTER,
         '    {"error.surplus", "share", at<error, &E::surplus>()},\n'),
        ("compare/result/result.schema.json", '            "fractional": {"type": "integer"', BEFORE,
         '            "surplus": {"type": "number", "description": "share missed less share false"},\n'),
    ],
    "a setting of the map": [  # twice as many points, and again
        ("raster/options.h", "  int samples = 32;          ///< pcf vogel", BEFORE, "  int doublings = 0;         ///< pcf vogel\n"),
        ("raster/settings.cpp", '    {.name = "blocker-samples",\n', BEFORE,
         row("doublings", 'integer<of_filter, &F::doublings>("times", 0, 4, 0, 4)', "averages", "how often the samples are doubled")),
        ("raster/passes/technique.cpp", 'return {"pcf_vogel", {define("FILTER_SAMPLES", filter.samples', AFTER, " << filter.doublings"),
        ("compare/result/result.schema.json", '                "samples": {"type": "number", "description": "pcf', BEFORE,
         '                "doublings": {"type": "number", "minimum": 0},\n'),
    ],
    "a technique with a parameter": [  # lets a share of the light into every shadow
        ("raster/options.h", "  izb,\n  hybrid\n", REPLACE, "  izb,\n  hybrid,\n  veil\n"),
        ("raster/options.h", "  int samples = 32;          ///< pcf vogel", BEFORE, "  int veil = 50;             ///< veil: per cent\n"),
        ("raster/technique_traits.cpp", "     TexelShape::of_light, true, planar}};\n", REPLACE,
         "     TexelShape::of_light, true, planar},\n    {Technique::veil, \"veil\", MapContents::nearest_depth, 1, "
         "ShadowTest::averaged, every_light,\n     TexelShape::of_light, false, planar}};\n"),
        ("raster/technique_traits.cpp", "static_cast<std::size_t>(Technique::hybrid) + 1", REPLACE, "static_cast<std::size_t>(Technique::veil) + 1"),
        ("raster/settings.cpp", '    {.name = "blocker-samples",\n', BEFORE,
         row("veil", 'integer<of_filter, &F::veil>("per cent", 0, 100, 0, 100)', "is<Technique::veil>", "what the shadow lets through")),
        ("raster/passes/technique.cpp", "    case Technique::hybrid:\n", BEFORE,
         '    case Technique::veil:\n      return {"veil", {define("VEIL", options.filter.veil)}};\n'),
        ("shaders/technique/veil.glsl", None, None,
         "float technique_visibility(ShadowTest test, vec3 position, vec3 normal, vec3 to_light) {\n  COUNT_LOOKUPS(1);\n"
         "  return test.gap > light.bias.x ? float(VEIL) / 100.0 : 1.0;\n}\n"),
        ("compare/result/result.schema.json", '            "technique": {"enum": ["hard", ', AFTER, '"veil", '),
        ("compare/result/result.schema.json", '                "samples": {"type": "number", "description": "pcf', BEFORE,
         '                "veil": {"type": "number", "minimum": 0},\n'),
    ],
    "a light's shape": [  # the disc under another name
        ("scene/light_shape/light_shape.h", "struct RectangleLight {\n", BEFORE,
         'struct PlateLight {\n  double radius = 0.0;\n  Vec3 normal{0.0, -1.0, 0.0};\n'
         '  static constexpr std::string_view name = "plate", shader_define = "AREA_DISC";\n  static constexpr bool is_sun = false;\n'
         '  bool operator==(const PlateLight&) const = default;\n  double size() const { return radius; }\n  bool resize(double size);\n'
         '  ShapeMeasures measures();\n  Vec3 half_extent() const;\n  LightHull hull(const Light& light, const LitWorld& world) const;\n'
         '  void set_up(LightSampler& sampler, const Light& light) const;\n  ShaderArea shader_area(const LightFace& face) const;\n};\n\n'),
        ("scene/light_shape/light_shape.h", "std::variant<PointShape, SunDisc, SphereLight, DiscLight, RectangleLight", AFTER, ", PlateLight"),
        ("scene/light_shape/plate.cpp <- scene/light_shape/disc.cpp", "DiscLight", REPLACE, "PlateLight"),
        ("scene/files/scene.schema.json", '        "disc": {\n          "type": "object",\n          "description": "Point and spot', BEFORE,
         '        "plate": {\n          "type": "object",\n          "required": ["radius"],\n          "additionalProperties": false,\n'
         '          "properties": { "radius": { "type": "number", "minimum": 0 }, "normal": { "$ref": "#/$defs/vec3" } }\n        },\n'),
    ],
    "a file format": [  # nine numbers a line, a triangle
        ("scene/files/formats.h", "Expected<LoadedFile> read_ply(", BEFORE,
         "Expected<LoadedFile> read_tri(std::string_view text, const std::string& file, const LoadOptions& options);\n"),
        ("scene/files/load.cpp", '    {{".ply"}, [](In in) { return read_ply(in.bytes, in.path); }},\n', AFTER,
         '    {{".tri"}, [](In in) { return read_tri(in.bytes, in.path, in.options); }},\n'),
        ("scene/files/files.cmake", "files/ply/ply.cpp", AFTER, " files/tri.cpp"),
        ("scene/files/tri.cpp", None, None,
         '// Triangles as nine numbers each, separated by blanks.\n#include <sstream>\n\n#include "scene/files/formats.h"\n\nnamespace gnomon {\n\n'
         "Expected<LoadedFile> read_tri(std::string_view text, const std::string& file, const LoadOptions& options) {\n"
         "  std::istringstream in{std::string(text)};\n  std::string obj, x, y, z;\n"
         '  for (int corner = 1; in >> x >> y >> z; ++corner) {\n    obj += "v " + x + " " + y + " " + z + "\\n";\n'
         '    if (corner % 3 == 0) obj += "f -3 -2 -1\\n";\n  }\n  return read_obj(obj, file, {}, options);\n}\n\n}  // namespace gnomon\n'),
    ],
    "a lesson": [
        ("docs/lessons/tides.md <- docs/lessons/precision.md", "# Precision", REPLACE, "# Tides"),
        ("docs/lessons/README.md", "25. [What accuracy costs](cost.md): errors beside times\n", AFTER, "26. [Tides](tides.md): an exercise\n"),
        ("report/lessons.cpp", "constexpr std::array<std::string_view, 25> names{", REPLACE, "constexpr std::array<std::string_view, 26> names{"),
        ("report/lessons.cpp", '"hybrid",        "cost"}', REPLACE, '"hybrid",        "cost", "tides"}'),
    ],
}


def changed(text, anchor, where, addition):
    return text.replace(anchor, {AFTER: anchor + addition, BEFORE: addition + anchor, REPLACE: addition}[where])


def check(source, idea, edits):
    faults = []
    for place, anchor, _, _ in edits:
        target, _, origin = place.partition(" <- ")
        if anchor is None or origin:
            if (source / target).exists():
                faults.append(f"{idea}: {target} is there already")
        if anchor is not None:
            found = (source / (origin or target)).read_text().count(anchor)
            if found != 1 and not (origin and found > 0):
                faults.append(f"{idea}: {origin or target} has {found} times: {anchor.strip()}")
    return faults


def apply(source, edits):
    for place, anchor, where, addition in edits:
        target, _, origin = place.partition(" <- ")
        text = addition if anchor is None else changed((source / (origin or target)).read_text(), anchor, where, addition)
        (source / target).write_text(text)


def main():
    source, words = pathlib.Path(sys.argv[1]), sys.argv[2:]
    faults = [fault for idea, edits in EXERCISES.items() for fault in check(source, idea, edits)]
    told = dict(re.findall(r"^\| (an? [^|]*?) \| (\d+) \|", (source / "CONTRIBUTING.md").read_text(), re.M))
    for idea, edits in EXERCISES.items():
        count = len({place.partition(" <- ")[0] for place, *_ in edits})
        print(f"{idea}: {count} files")
        if told.get(idea) != str(count):
            faults.append(f"{idea}: CONTRIBUTING.md says {told.get(idea, 'nothing')}, the exercise takes {count}")
    print(*faults, sep="\n")
    if faults:
        return 1
    if "--apply" in words:
        for edits in EXERCISES.values():
            apply(source, edits)
    return 0


if __name__ == "__main__":
    sys.exit(main())
