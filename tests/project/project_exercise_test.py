#!/usr/bin/env python3
"""Counts the files that a new metric, label, setting, technique, light shape, file format, convention and lesson take.

    project_exercise_test.py SOURCE          counts, and holds the table of CONTRIBUTING.md to the counts
    project_exercise_test.py SOURCE --apply  makes all changes there, to be built and tried

Each exercise is the hardest of its kind that is still small, and works: its lines are all that it takes beside tests, manual and
changelog. An anchor that
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
    "a metric that is measured": [  # the pixels that both renderers draw as half lit
        ("compare/comparison.h", "struct OutsideMap {\n", REPLACE,
         "struct Halves {\n  std::uint64_t true_ones = 0, drawn_ones = 0;\n};\n\nstruct OutsideMap {\n"),
        ("compare/comparison.h", "  Detachment detachment;\n", AFTER, "  Halves halves;\n"),
        ("compare/measure/halves.h", None, None,
         "// Counts pixels between light and shadow.\n#pragma once\n\n#include \"compare/ladder/ladder.h\"\n\nnamespace gnomon::compare {\n\n"
         "class HalvesSum {\n public:\n  void add(const LadderInput& in, const Climb& climb);\n"
         "  void write_to(LightFigures& out) const { out.halves = sum_; }\n\n private:\n  Halves sum_;\n};\n\n}  // namespace gnomon::compare\n"),
        ("compare/measure/halves.cpp", None, None,
         "#include \"compare/measure/halves.h\"\n\nnamespace gnomon::compare {\n\n"
         "void HalvesSum::add(const LadderInput&, const Climb& climb) {\n  const auto is_half = [](float v) { return v > 0.0f && v < 1.0f; };\n"
         "  for (std::size_t i = 0; i < climb.labels.data.size(); ++i) {\n    if (!is_compared(climb.labels.data[i])) continue;\n"
         "    sum_.true_ones += is_half(climb.rungs.front().data[i]) ? 1 : 0;\n    sum_.drawn_ones += is_half(climb.rungs.back().data[i]) ? 1 : 0;\n"
         "  }\n}\n\n}  // namespace gnomon::compare\n"),
        ("compare/measure/pixel_measures.h", '#include "compare/ladder/ladder.h"\n', AFTER, '#include "compare/measure/halves.h"\n'),
        ("compare/measure/pixel_measures.h", "LookupSum>;", REPLACE, "LookupSum, HalvesSum>;"),
        ("compare/CMakeLists.txt", "measure/image_sink.cpp", BEFORE, "measure/halves.cpp "),
        ("compare/result/figure_rows.cpp", '    {"terminator.dark", "pixels",', BEFORE,
         '    {"halves.true_ones", "pixels", "in truth", at<&L::halves, &Halves::true_ones>()},\n'
         '    {"halves.drawn_ones", "pixels", "as drawn", at<&L::halves, &Halves::drawn_ones>()},\n\n'),
    ],
    "a label": [  # what is dark within a filter's reach, apart from what is bright there
        ("compare/comparison.h", "  lag,\n  remap\n};", REPLACE, "  lag,\n  remap,\n  dark_blur\n};"),
        ("compare/comparison.h", "class_count = 21;", REPLACE, "class_count = 22;"),
        ("compare/ladder/labels.cpp", '     "technique rays: the remap step, with the denoiser\'s clamps and contrast"},\n', AFTER,
         '    {"dark_blur",\n     "dark blur",\n     "d",\n     {0x10, 0x20, 0x30},\n     Cause::filter,\n     "filtering",\n'
         '     "a filter darkens beside a shadow",\n     "The filter mixes shadow into light.",\n     "Make the filter narrower.",\n'
         '     "the filter step, darker than the truth"},\n'),
        ("compare/ladder/labelling.cpp", "  return lit_within_reach(in, wrong.pixel) ? Label::blur", REPLACE,
         "  return lit_within_reach(in, wrong.pixel) ? Label::dark_blur"),
    ],
    "a setting of the map": [  # twice as many points, and again
        ("raster/options.h", "  int samples = 32;          ///< pcf vogel", BEFORE, "  int doublings = 0;         ///< pcf vogel\n"),
        ("raster/settings.cpp", '    {.name = "blocker-samples",\n', BEFORE,
         row("doublings", 'integer<of_filter, &F::doublings>("times", 0, 4, 0, 4)', "averages", "how often the samples are doubled")),
        ("raster/passes/technique.cpp", 'return {"pcf_vogel", {define("FILTER_SAMPLES", filter.samples', AFTER, " << filter.doublings"),
    ],
    "a technique with a parameter": [  # lets a share of the light into every shadow
        ("raster/options.h", "  hybrid,\n  rays\n", REPLACE, "  hybrid,\n  rays,\n  veil\n"),
        ("raster/options.h", "  int samples = 32;          ///< pcf vogel", BEFORE, "  int veil = 50;             ///< veil: per cent\n"),
        ("raster/technique_traits.cpp", "rays_drawing;\n", REPLACE, "rays_drawing, veil_drawing;\n"),
        ("raster/technique_traits.cpp", "     .soft = true}};\n", REPLACE, "     .soft = true},\n"
         '    {.technique = Technique::veil, .name = "veil", .drawing = &veil_drawing, .test = ShadowTest::averaged}};\n'),
        ("raster/technique_traits.cpp", "static_cast<std::size_t>(Technique::rays) + 1", REPLACE, "static_cast<std::size_t>(Technique::veil) + 1"),
        ("raster/settings.cpp", '    {.name = "blocker-samples",\n', BEFORE,
         row("veil", 'integer<of_filter, &F::veil>("per cent", 0, 100, 0, 100)', "is<Technique::veil>", "what the shadow lets through")),
        ("raster/passes/technique.cpp", "extern const TechniqueDrawing hybrid_drawing{", BEFORE,
         "extern const TechniqueDrawing veil_drawing{.shader = [](const MapOptions& options, const Light&) -> TechniqueShader {\n"
         '  return {"veil", {define("VEIL", options.filter.veil)}};\n}};\n'),
        ("shaders/technique/veil.glsl", None, None,
         "float technique_visibility(ShadowTest test, vec3 position, vec3 normal, vec3 to_light) {\n  COUNT_LOOKUPS(1);\n"
         "  return test.gap > light.bias.x ? float(VEIL) / 100.0 : 1.0;\n}\n"),
    ],
    "a technique with a map of its own": [  # the depth a quarter of the way to the next surface behind (after Weiskopf and Ertl 2003)
        ("raster/options.h", "  midpoint,\n", AFTER, "  quarter,\n"),
        ("raster/technique_traits.cpp", "extern const TechniqueDrawing midpoint_drawing;\n", AFTER, "extern const TechniqueDrawing quarter_drawing;\n"),
        ("raster/technique_traits.cpp", "     .contents = MapContents::midpoint_depth},\n", AFTER,
         '    {.technique = Technique::quarter, .name = "quarter", .drawing = &quarter_drawing, .contents = MapContents::midpoint_depth},\n'),
        ("raster/passes/quarter_pass.cpp", None, None,
         "// A map of the depth a quarter of the way from the first surface to the next one behind it.\n"
         '#include "raster/gl/fill.h"\n#include "raster/passes/technique_pass.h"\n#include "shaders/shared_constants.h"\n\n'
         "namespace gnomon::raster {\nnamespace {\n\nclass QuarterPass final : public TechniquePass {\n public:\n"
         "  QuarterPass(Gl& gl, ProgramCache& programs) : gl_(&gl), second_(gl, programs) {}\n"
         "  Expected<void> prepare(const MapJob& job) override {\n    const ImageSize size{job.view.size, job.view.size};\n"
         "    if (auto ok = second_.prepare(job.view, job.options.depth_format); !ok) return ok;\n"
         "    map_ = Texture2D(*gl_, GL_R32F, size, job.view.face_count);\n    faces_.clear();\n"
         "    for (int i = 0; i < job.view.face_count; ++i) {\n      Framebuffer& face = faces_.emplace_back(*gl_);\n"
         "      face.attach(GL_COLOR_ATTACHMENT0, map_, i);\n      face.draw_to(1);\n"
         "      if (auto ok = face.check_complete(); !ok) return ok;\n    }\n    return gl_->check(\"a map of quarters\");\n  }\n"
         "  Expected<void> draw(const MapJob& job) override {\n"
         "    if (auto ok = second_.draw(job.world, job.view, job.options.cull, {}, &job.map); !ok) return ok;\n"
         "    std::vector<std::string_view> defines;\n"
         "    if (job.view.projection == LightProjection::perspective) defines.emplace_back(\"PERSPECTIVE\");\n"
         "    if (job.view.reversed) defines.emplace_back(\"REVERSED\");\n"
         '    auto program = Program::link(*gl_, "fullscreen.vert", "technique/quarter.frag", defines);\n'
         "    if (!program) return fail(program.error());\n    program->use();\n    job.map.bind(shaders::depth_map_unit);\n"
         "    second_.bind(shaders::second_layer_unit);\n    const Gl& gl = *gl_;\n    gl->Disable(GL_DEPTH_TEST);\n    gl->Disable(GL_CULL_FACE);\n"
         "    gl->Viewport(0, 0, map_.size().width, map_.size().height);\n    for (int face = 0; face < job.view.face_count; ++face) {\n"
         "      gl->BindFramebuffer(GL_FRAMEBUFFER, faces_[static_cast<std::size_t>(face)].id());\n"
         "      gl->ProgramUniform1i(program->id(), shaders::face_uniform, face);\n      fill(gl, map_.size());\n    }\n    return {};\n  }\n"
         "  void bind_for_lookup() const override { map_.bind(shaders::depth_map_unit); }\n"
         "  void read(ShadowMap& map) const override {\n    map_.read(GL_RED, GL_FLOAT, std::as_writable_bytes(std::span(map.depth)));\n  }\n"
         "  std::uint64_t texels() const override { return 2 * map_.size().pixels() * static_cast<std::uint64_t>(map_.layers()); }\n"
         "  std::uint64_t bytes() const override { return second_.bytes() + 2 * texels(); }\n\n private:\n"
         "  Gl* gl_;\n  DepthMapPass second_;\n  Texture2D map_;\n  std::vector<Framebuffer> faces_;\n};\n\n"
         'constexpr std::string_view quarter_stages[] = {"technique/quarter.frag"};\n\n}  // namespace\n\n'
         "extern const TechniqueDrawing quarter_drawing{\n"
         "    .make_pass = [](Gl& gl, ProgramCache& programs) -> std::unique_ptr<TechniquePass> {\n"
         "      return std::make_unique<QuarterPass>(gl, programs);\n    },\n    .stages = quarter_stages};\n\n}  // namespace gnomon::raster\n"),
        ("shaders/technique/quarter.frag <- shaders/midpoint.frag", "0.5 * (next - depth)", REPLACE, "0.25 * (next - depth)"),
        ("raster/CMakeLists.txt", "passes/moment_pass.cpp", AFTER, " passes/quarter_pass.cpp"),
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
    "a convention of captured maps": [  # all directions unfolded onto one square: an octahedron (Meyer et al. 2010)
        ("judge/conventions.h", "  paraboloid,\n};", REPLACE, "  paraboloid,\n  octahedron,\n};"),
        ("judge/conventions.h", "extern const MapLayout paraboloid_layout;  ///< paraboloids.cpp\n", AFTER,
         "extern const MapLayout octahedron_layout;  ///< octahedron.cpp\n"),
        ("judge/conventions.h", "std::array<StoredConvention, 6>", REPLACE, "std::array<StoredConvention, 7>"),
        ("judge/conventions.h", "&paraboloid_layout}}};", REPLACE,
         '&paraboloid_layout},\n     {"octahedron", Stores::distances, true, false, true, &octahedron_layout}}};'),
        ("judge/octahedron.cpp", None, None,
         "// Octahedral maps: a direction's place on the octahedron |x| + |y| + |z| = 1, whose half with z < 0 is folded outwards.\n"
         "#include \"judge/directions_test.h\"\n\nnamespace gnomon::judge {\nnamespace {\n\n"
         "Vec2 folded(const Vec2& p) {\n  return (1.0 - glm::abs(Vec2(p.y, p.x))) * Vec2(p.x < 0.0 ? -1.0 : 1.0, p.y < 0.0 ? -1.0 : 1.0);\n}\n\n"
         "class OctahedronTest final : public DirectionsTest {\n public:\n  Mat3 turn{1.0};\n"
         "  DirectionPlace place(const Vec3& direction) const override {\n    Vec3 d = turn * direction;\n"
         "    d /= std::abs(d.x) + std::abs(d.y) + std::abs(d.z);\n    const Vec2 p = d.z < 0.0 ? folded(Vec2(d)) : Vec2(d);\n"
         "    return {0, 0.5 * (p.x + 1.0) * pictures[0].width, 0.5 * (p.y + 1.0) * pictures[0].height};\n  }\n"
         "  Vec3 direction(const DirectionPlace& place) const override {\n"
         "    const Vec2 p(2.0 * place.u / pictures[0].width - 1.0, 2.0 * place.v / pictures[0].height - 1.0);\n"
         "    const double z = 1.0 - std::abs(p.x) - std::abs(p.y);\n"
         "    return glm::transpose(turn) * glm::normalize(Vec3(z < 0.0 ? folded(p) : p, z));\n  }\n"
         "  std::shared_ptr<CapturedTest> clone() const override { return std::make_shared<OctahedronTest>(*this); }\n};\n\n"
         "Expected<LightTurn> turn_of(const Capture& capture, const Light& light, const World& world) {\n"
         "  return read_turn(capture, 0, light, world, \"the matrix is the light's view without a projection\");\n}\n\n"
         "Expected<void> check_octahedron(const Capture& capture) {\n  if (capture.map.size() != 1) return capture_error(capture, \"map\", "
         "\"of an octahedron has one layer\");\n  return check_directions(capture, \"octahedra\");\n}\n\n"
         "Expected<void> check_turn(const Capture& capture, const Light& light, const World& world) {\n"
         "  const auto turn = turn_of(capture, light, world);\n  if (!turn) return fail(turn.error());\n  return {};\n}\n\n"
         "Expected<CapturedMap> read_octahedron(const Capture& capture, const Light& light, const World& world) {\n"
         "  const auto turn = turn_of(capture, light, world);\n  if (!turn) return fail(turn.error());\n"
         "  const auto test = std::make_shared<OctahedronTest>();\n  test->turn = turn->turn;\n"
         "  return read_directions(capture, turn->origin, test, 1.0);\n}\n\n}  // namespace\n\n"
         "const MapLayout octahedron_layout{check_octahedron, check_turn, read_octahedron};\n\n}  // namespace gnomon::judge\n"),
        ("judge/CMakeLists.txt", "own_test.cpp", BEFORE, "octahedron.cpp "),
        ("judge/capture.schema.json", '"linear_z", "paraboloid"],\n', REPLACE, '"linear_z", "paraboloid", "octahedron"],\n'),
        ("judge/capture.schema.json", "Nothing drawn: the far end's number;", BEFORE,
         "octahedron: the same of one layer, onto which an octahedron is unfolded. "),
        ("docs/capture.md", "| `paraboloid` | no depth: it turns and shifts, the light at 0 | distance from the light, world units | the same |\n", AFTER,
         "| `octahedron` | the same, of one layer onto which an octahedron is unfolded | the same | the same |\n"),
    ],
    "a lesson": [
        ("docs/lessons/tides.md <- docs/lessons/precision.md", "# Precision", REPLACE, "# Tides"),
        ("docs/lessons/README.md", "26. [What accuracy costs](cost.md): errors beside times\n", AFTER, "27. [Tides](tides.md): an exercise\n"),
        ("report/lessons.cpp", "constexpr std::array<std::string_view, 26> names{", REPLACE, "constexpr std::array<std::string_view, 27> names{"),
        ("report/lessons.cpp", '"one-ray",       "cost"}', REPLACE, '"one-ray",       "cost", "tides"}'),
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
