// Every mistake in a JSON scene is one line with its place: file:line:column: field: reason.
#include "scene/files/formats.h"
#include "tests/support/scene_files_support.h"

namespace gnomon {
namespace {

struct Mistake {
  std::string_view what;   // test case
  std::string_view text;   // the scene
  std::string_view start;  // of the message, which must also be one line
};

std::string message_of(std::string_view text, const LoadOptions& options = {},
                       const std::string& folder = ".") {
  const auto scene = load_json_scene(text, "s.json", folder, options);
  if (scene) return "loaded";
  EXPECT_EQ(scene.error().kind, ErrorKind::bad_input);
  return scene.error().message();
}

void expect_start(const Mistake& m, const std::string& message) {
  EXPECT_EQ(message.substr(0, m.start.size()), m.start) << m.what << "\n  " << message;
  EXPECT_EQ(message.find('\n'), std::string::npos) << m.what;
}

const Mistake syntax_mistakes[] = {
    {"empty", "", "s.json:1:1: the file is empty"},
    {"only space and comments", " // nothing\n/* here */ ", "s.json:1:1: the file is empty"},
    {"comment without end", "{\n  /* here", "s.json:2:3: the comment that starts here does not end"},
    {"byte order mark", "\xef\xbb\xbf{}", "s.json:1:1: the file starts with a byte order mark"},
    {"UTF-16", std::string_view("\xff\xfe{\0}\0", 6), "s.json:1:1: the file starts with a byte order mark"},
    {"truncated object", "{\n \"schema\": \"gnomon/scene/1\",\n", "s.json:3:1: the file ends in the middle"},
    {"truncated string", "{\n \"schema", "s.json:2:9: "},
    {"trailing garbage", "{\"schema\": \"gnomon/scene/1\"}\n x", "s.json:2:2: syntax error"},
    {"second value", "{} {}", "s.json:1:4: syntax error"},
    {"duplicate key", "{\n  \"name\": \"a\",\n  \"name\": \"b\"\n}", "s.json:3:3: duplicate key \"name\""},
    {"NaN", "{\"exposure\": NaN}", "s.json:1:14: not a number in JSON (got NaN, allowed finite numbers)"},
    {"Infinity", "{\"exposure\":\n Infinity}", "s.json:2:2: not a number in JSON (got Infinity"},
    {"-Infinity", "{\"exposure\": -Infinity}", "s.json:1:14: not a number in JSON (got -Infinity"},
    {"1e400", "{\"exposure\": 1e400}",
     "s.json:1:14: the number is too large (got 1e400, allowed up to 1.8e308)"},
    {"bad UTF-8", "{\"name\": \"\xc3(\"}", "s.json:1:1"},
    {"lone surrogate", "{\"name\": \"\\ud800\"}", "s.json:1:1"},
    {"raw newline in string", "{\"name\": \"a\nb\"}", "s.json:1:1"},
    {"trailing comma", "{\"name\": \"a\",}", "s.json:1:14: syntax error"},
    {"not an object", "[1]", "s.json:1:1: wrong type (got an array of 1, allowed an object)"},
};

TEST(JsonErrors, Syntax) {
  for (const Mistake& m : syntax_mistakes) expect_start(m, message_of(m.text));
}

TEST(JsonErrors, NestingIsCappedBeforeParsing) {
  const std::string deep = "{\"x\": " + std::string(100000, '[') + std::string(100000, ']') + "}";
  EXPECT_EQ(message_of(deep), "s.json:1:70: nested too deeply (got more than 64 levels, allowed 64)");
  EXPECT_EQ(message_of(std::string(100000, '{')),
            "s.json:1:65: nested too deeply (got more than 64 levels, allowed 64)");
}

// A scene with one line of its own, line 5; line 4 is a material's, line 3 a mesh's.
std::string scene_with(std::string_view line) {
  return std::string(R"({ "schema": "gnomon/scene/1",
  "shapes": [{ "sphere": { "center": [0, 0, 0], "radius": 1 }, "material": "m" }],
  "meshes": [{ "name": "tri", "vertices": [[0,0,0],[1,0,0],[0,1,0]], "triangles": [[0,1,2]] }],
  "materials": [{ "name": "m" }],
  )") + std::string(line) +
         "\n}";
}

const Mistake field_mistakes[] = {
    {"unknown key", R"("camra": {})", "s.json:5:3: camra: unknown key (got \"camra\", allowed "},
    {"zero fov", R"("camera": {"eye": [0,0,5], "target": [0,0,0], "vertical_fov_degrees": 0})",
     "s.json:5:73: camera.vertical_fov_degrees: out of range (got 0, allowed a number in (0, 180))"},
    {"fov 180", R"("camera": {"eye": [0,0,5], "target": [0,0,0], "vertical_fov_degrees": 180})",
     "s.json:5:73: camera.vertical_fov_degrees: out of range (got 180, allowed a number in (0, 180))"},
    {"no height", R"("camera": {"eye": [0,0,5], "target": [0,0,0], "orthographic_height": 0})",
     "s.json:5:72: camera.orthographic_height: out of range (got 0, allowed a number in (0, 1e+12])"},
    {"height and fov",
     R"("camera": {"eye": [0,0,5], "target": [0,0,0], "orthographic_height": 2, "vertical_fov_degrees": 9})",
     "s.json:5:72: camera.orthographic_height: does not go with vertical_fov_degrees"},
    {"look = eye", R"("camera": {"eye": [0,0,5], "target": [0,0,5]})",
     "s.json:5:40: camera.target: is the eye itself"},
    {"up along view", R"("camera": {"eye": [0,5,0], "target": [0,0,0]})",
     "s.json:5:13: camera.up: is parallel to the view direction"},
    {"up given along view", R"("camera": {"eye": [0,5,0], "target": [0,0,0], "up": [0,2,0]})",
     "s.json:5:55: camera.up: is parallel to the view direction"},
    {"zero up", R"("camera": {"eye": [0,0,5], "target": [0,0,0], "up": [0,0,0]})",
     "s.json:5:55: camera.up: has no direction"},
    {"missing eye", R"("camera": {"target": [0,0,0]})", "s.json:5:13: camera.eye: is missing"},
    {"vector of two", R"("camera": {"eye": [0,0], "target": [0,0,0]})",
     "s.json:5:21: camera.eye: wrong type (got an array of 2, allowed an array of 3 numbers)"},
    {"string in vector", R"("camera": {"eye": [0,"x",0], "target": [0,0,0]})",
     "s.json:5:24: camera.eye[1]: wrong type (got \"x\", allowed a number in [-1e+15, 1e+15])"},
    {"far away", R"("camera": {"eye": [0,0,1e30], "target": [0,0,0]})",
     "s.json:5:26: camera.eye[2]: out of range (got 1e30"},
    {"no lights", R"("lights": [])", "s.json:5:13: lights: is empty"},
    {"unknown light type", R"("lights": [{"type": "spotlight"}])",
     "s.json:5:23: lights[0].type: unknown value (got \"spotlight\", allowed directional, point, spot)"},
    {"close light type", R"("lights": [{"type": "sport"}])",
     "s.json:5:23: lights[0].type: unknown value (got \"sport\", allowed directional, point, spot); did you "
     "mean \"spot\"?"},
    {"zero direction", R"("lights": [{"type": "directional", "direction": [0,0,0]}])",
     "s.json:5:51: lights[0].direction: has no direction"},
    {"no direction", R"("lights": [{"type": "directional"}])",
     "s.json:5:14: lights[0]: needs one of direction, elevation_degrees"},
    {"two directions",
     R"("lights": [{"type": "directional", "direction": [0,-1,0], "elevation_degrees": 3}])",
     "s.json:5:61: lights[0].elevation_degrees: cannot stand beside direction"},
    {"position of a sun",
     R"("lights": [{"type": "directional", "direction": [0,-1,0], "position": [0,0,0]}])",
     "s.json:5:61: lights[0].position: does not apply to a directional light"},
    {"elevation without azimuth", R"("lights": [{"type": "directional", "elevation_degrees": 3}])",
     "s.json:5:14: lights[0].azimuth_degrees: is missing"},
    {"negative intensity", R"("lights": [{"type": "point", "position": [0,9,0], "intensity": [1,-1,1]}])",
     "s.json:5:69: lights[0].intensity[1]: out of range (got -1, allowed a number in [0, 1e+30])"},
    {"inner above outer",
     R"("lights": [{"type": "spot", "position": [0,9,0], "target": [0,0,0], "inner_angle_degrees": 50}])",
     "s.json:5:94: lights[0].inner_angle_degrees: the inner angle must be below the outer (got 50 and 45"},
    {"spot at its target", R"("lights": [{"type": "spot", "position": [0,9,0], "target": [0,9,0]}])",
     "s.json:5:62: lights[0].target: is the light's position"},
    {"same light name",
     R"("lights": [{"name":"a", "type": "point", "position": [0,9,0]}, {"name":"a", "type": "point", "position": [0,9,0]}])",
     "s.json:5:66: lights[1]: another light has this name (got \"a\")"},
    {"missing material", R"("instances": [{"mesh": "tri", "material": "mm"}])",
     "s.json:5:45: instances[0].material: no such material (got \"mm\", allowed m)"},
    {"no material", R"("instances": [{"mesh": "tri"}])",
     "s.json:5:17: instances[0]: material is missing for part \"tri\""},
    {"unknown mesh", R"("instances": [{"mesh": "trii", "material": "m"}])",
     "s.json:5:26: instances[0].mesh: no such mesh (got \"trii\", allowed tri); did you mean \"tri\"?"},
    {"unknown part", R"("instances": [{"mesh": "tri", "materials": {"lid": "m"}}])",
     "s.json:5:47: instances[0].materials.lid: no such part (got \"lid\", allowed tri)"},
    {"zero scale", R"("instances": [{"mesh": "tri", "material": "m", "scale": [1,0,1]}])",
     "s.json:5:59: instances[0].scale: flattens the mesh"},
    {"singular matrix",
     R"("instances": [{"mesh": "tri", "material": "m", "matrix": [[1,0,0,0],[2,0,0,0],[0,0,1,0],[0,0,0,1]]}])",
     "s.json:5:60: instances[0].matrix: is singular"},
    {"projective matrix",
     R"("instances": [{"mesh": "tri", "material": "m", "matrix": [[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,1,1]]}])",
     "s.json:5:91: instances[0].matrix[3]: the last row must be [0, 0, 0, 1]"},
    {"matrix and scale",
     R"("instances": [{"mesh": "tri", "material": "m", "scale": 2, "matrix": [[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]}])",
     "s.json:5:50: instances[0].scale: cannot stand beside matrix"},
    {"no room between copies",
     R"("instances": [{"mesh": "tri", "material": "m", "repeat": {"count": [2,2], "spacing": [1,0]}}])",
     "s.json:5:88: instances[0].repeat.spacing: leaves no room between copies"},
    {"too many copies",
     R"("instances": [{"mesh": "tri", "material": "m", "repeat": {"count": [2,257], "spacing": 1}}])",
     "s.json:5:73: instances[0].repeat.count[1]: out of range (got 257, allowed a whole number in [1, 256])"},
    {"copies without size",
     R"("instances": [{"mesh": "tri", "material": "m", "repeat": {"count": [2,2], "spacing": 1, "scale": [2,1]}}])",
     "s.json:5:100: instances[0].repeat.scale: is no range"},
    {"zero axis",
     R"("instances": [{"mesh": "tri", "material": "m", "rotate": {"axis": [0,0,0], "degrees": 3}}])",
     "s.json:5:69: instances[0].rotate.axis: has no direction"},
    {"missing include", R"("include": ["nothing.obj"])",
     "s.json:5:15: include[0]: nothing.obj: no such file"},
    {"max_depth", R"("max_depth": 2.5)",
     "s.json:5:16: max_depth: out of range (got 2.5, allowed a whole number in [0, 64])"},
    {"2^31", R"("max_depth": 2147483648)", "s.json:5:16: max_depth: out of range (got 2147483648"},
    {"exposure", R"("exposure": 0)",
     "s.json:5:15: exposure: out of range (got 0, allowed a number in (0, 1e+30])"},
    {"colour", R"("background": "#12345g")", "s.json:5:17: background: not a colour (got \"#12345g\""},
    {"null", R"("ambient": null)", "s.json:5:14: ambient: wrong type (got null, allowed a number, [r, g, b]"},
    {"hostile key", "\"a\\u0000\\n\\u001b[31m\": 1", "s.json:5:3: a\\x00\\n\\x1b[31m: unknown key"},
};

TEST(JsonErrors, Fields) {
  for (const Mistake& m : field_mistakes) expect_start(m, message_of(scene_with(m.text)));
  EXPECT_EQ(message_of(scene_with(R"("name": "fine")")), "loaded");
}

TEST(JsonErrors, DidYouMean) {
  const std::string message = message_of(scene_with(R"("camra": {})"));
  EXPECT_NE(message.find("did you mean \"camera\"?"), std::string::npos) << message;
}

const Mistake whole_mistakes[] = {
    {"no schema", "{ }", "s.json:1:1: schema: is missing"},
    {"other schema", "{\"schema\": \"gnomon/scene/2\"}",
     "s.json:1:12: schema: not a scene of this version (got \"gnomon/scene/2\""},
    {"nothing to see", "{\"schema\": \"gnomon/scene/1\"}", "s.json:1:1: the scene shows nothing"},
    {"misspelt in a material",
     "{\"schema\": \"gnomon/scene/1\",\n\"materials\": [{\"name\": \"m\", \"difuse\": 1}]}",
     "s.json:2:29: materials[0].difuse: unknown key"},
    {"ior 0", "{\"schema\": \"gnomon/scene/1\",\n\"materials\": [{\"name\": \"m\", \"ior\": 0}]}",
     "s.json:2:36: materials[0].ior: out of range (got 0, allowed a number in [0.01, 100])"},
    {"ior -1", "{\"schema\": \"gnomon/scene/1\",\n\"materials\": [{\"name\": \"m\", \"ior\": -1}]}",
     "s.json:2:36: materials[0].ior: out of range (got -1"},
    {"mirror + transmission",
     "{\"schema\": \"gnomon/scene/1\",\n\"materials\": [{\"name\": \"m\", \"mirror\": 0.6, \"transmission\": "
     "0.6}]}",
     "s.json:2:60: materials[0].transmission: mirror + transmission (got 0.6 + 0.6, allowed up to 1)"},
    {"same material",
     "{\"schema\": \"gnomon/scene/1\",\n\"materials\": [{\"name\": \"m\"}, {\"name\": \"m\"}]}",
     "s.json:2:39: materials[1].name: another material has this name (got \"m\")"},
    {"no texture source",
     "{\"schema\": \"gnomon/scene/1\",\n\"materials\": [{\"name\": \"m\", \"texture\": {}}]}",
     "s.json:2:40: materials[0].texture: needs one of file, generate"},
    {"missing texture",
     "{\"schema\": \"gnomon/scene/1\",\n\"materials\": [{\"name\": \"m\", \"texture\": {\"file\": "
     "\"no.png\"}}]}",
     "s.json:2:49: materials[0].texture.file: no.png: no such file"},
    {"negative radius",
     "{\"schema\": \"gnomon/scene/1\", \"materials\": [{\"name\": \"m\"}],\n\"shapes\": [{\"sphere\": "
     "{\"center\": [0,0,0], \"radius\": -1}, \"material\": \"m\"}]}",
     "s.json:2:53: shapes[0].sphere.radius: out of range (got -1, allowed a number in (0, 1e+15])"},
    {"zero normal",
     "{\"schema\": \"gnomon/scene/1\", \"materials\": [{\"name\": \"m\"}],\n\"shapes\": [{\"plane\": "
     "{\"point\": [0,0,0], \"normal\": [0,0,0]}, \"material\": \"m\"}]}",
     "s.json:2:51: shapes[0].plane.normal: has no direction (got an array of 3, allowed a vector that is not "
     "zero)"},
    {"two shapes in one",
     "{\"schema\": \"gnomon/scene/1\", \"materials\": [{\"name\": \"m\"}],\n\"shapes\": [{\"plane\": {}, "
     "\"sphere\": {}, \"material\": \"m\"}]}",
     "s.json:2:13: shapes[0]: "},
    {"index out of range",
     "{\"schema\": \"gnomon/scene/1\",\n\"meshes\": [{\"name\": \"a\", \"vertices\": "
     "[[0,0,0],[1,0,0],[0,1,0]],\n\"triangles\": [[0,1,3]]}]}",
     "s.json:3:20: meshes[0].triangles[0][2]: out of range (got 3, allowed a whole number in [0, 2])"},
    {"fractional index",
     "{\"schema\": \"gnomon/scene/1\",\n\"meshes\": [{\"name\": \"a\", \"vertices\": "
     "[[0,0,0],[1,0,0],[0,1,0]],\n\"triangles\": [[0,1,1.5]]}]}",
     "s.json:3:20: meshes[0].triangles[0][2]: out of range (got 1.5"},
    {"normals short",
     "{\"schema\": \"gnomon/scene/1\",\n\"meshes\": [{\"name\": \"a\", \"vertices\": "
     "[[0,0,0],[1,0,0],[0,1,0]], \"triangles\": [[0,1,2]],\n\"normals\": [[0,0,1]]}]}",
     "s.json:3:12: meshes[0].normals: one per vertex is needed (got 1, allowed 3)"},
    {"file and vertices",
     "{\"schema\": \"gnomon/scene/1\",\n\"meshes\": [{\"name\": \"a\", \"file\": \"x.obj\", \"vertices\": "
     "[]}]}",
     "s.json:2:43: meshes[0].vertices: cannot stand beside file"},
    {"unknown generator",
     "{\"schema\": \"gnomon/scene/1\",\n\"meshes\": [{\"name\": \"a\", \"generate\": {\"kind\": \"fenc\"}}]}",
     "s.json:2:47: meshes[0].generate.kind: "},
    {"generator without kind",
     "{\"schema\": \"gnomon/scene/1\",\n\"meshes\": [{\"name\": \"a\", \"generate\": {}}]}",
     "s.json:2:38: meshes[0].generate: kind is missing"},
};

TEST(JsonErrors, WholeScenes) {
  for (const Mistake& m : whole_mistakes) {
    if (m.what == "two shapes in one") continue;
    expect_start(m, message_of(m.text));
  }
  const std::string both = message_of(whole_mistakes[12].text);
  EXPECT_NE(both.find("shapes[0].plane: cannot stand beside sphere"), std::string::npos) << both;
}

// ---- includes and paths ----

constexpr std::string_view shape_scene = R"({ "schema": "gnomon/scene/1", "materials": [{ "name": "NAME" }],
  "shapes": [{ "sphere": { "center": [0, 0, 0], "radius": 1 }, "material": "NAME" }], "include": [FILES] })";

std::string shape_scene_with(const std::string& name, const std::string& files) {
  std::string text(shape_scene);
  for (std::size_t at = text.find("NAME"); at != std::string::npos; at = text.find("NAME"))
    text.replace(at, 4, name);
  return text.replace(text.find("FILES"), 5, files);
}

TEST(JsonErrors, IncludeCyclesAreNamed) {
  const TemporaryFolder folder;
  const std::string a = folder.put("a.json", shape_scene_with("a", "\"b.json\""));
  folder.put("b.json", shape_scene_with("b", "\"c.json\""));
  const std::string c = folder.put("c.json", shape_scene_with("c", "\"./a.json\""));
  const auto scene = load_scene(a);
  ASSERT_FALSE(scene);
  EXPECT_EQ(scene.error().message(),
            c + ":2:96: include[0]: the files include each other (a.json -> b.json -> c.json -> a.json)");
  const auto self = load_scene(folder.put("self.json", shape_scene_with("s", "\"self.json\"")));
  EXPECT_NE(self.error().message().find("(self.json -> self.json)"), std::string::npos);
}

TEST(JsonErrors, IncludedFilesSpeakForThemselves) {
  const TemporaryFolder folder;
  const std::string a = folder.put("a.json", shape_scene_with("a", "\"sub/b.json\""));
  const std::string b = folder.put("sub/b.json", "{\n\"x\": 1}");
  const auto scene = load_scene(a);
  ASSERT_FALSE(scene);
  EXPECT_EQ(scene.error().message().substr(0, b.size() + 7), b + ":2:1: x");
}

TEST(JsonErrors, SameMaterialInTwoFiles) {
  const TemporaryFolder folder;
  const std::string a = folder.put("a.json", shape_scene_with("m", "\"b.json\""));
  folder.put("b.json", shape_scene_with("m", ""));
  EXPECT_NE(load_scene(a).error().message().find("another material has this name"), std::string::npos);
}

TEST(JsonErrors, ConfinedPathsStayInside) {
  const TemporaryFolder folder;
  const std::string outside = folder.put("outside.json", shape_scene_with("o", ""));
  folder.put("in/inside.json", shape_scene_with("i", ""));
  LoadOptions confined;
  confined.confine_paths = true;
  for (const std::string& path :
       {std::string("../outside.json"), outside, std::string("sub/../../outside.json")}) {
    const std::string scene = folder.put("in/a.json", shape_scene_with("a", "\"" + path + "\""));
    EXPECT_TRUE(load_scene(scene)) << path;
    const auto refused = load_scene(scene, confined);
    ASSERT_FALSE(refused) << path;
    EXPECT_NE(
        refused.error().message().find("a.json:2:96: include[0]: the file is outside the scene's folder"),
        std::string::npos)
        << refused.error().message();
  }
  EXPECT_TRUE(load_scene(folder.put("in/a.json", shape_scene_with("a", "\"inside.json\"")), confined));
  std::filesystem::create_symlink(outside, folder.file("in/link.json"));
  EXPECT_FALSE(load_scene(folder.put("in/a.json", shape_scene_with("a", "\"link.json\"")), confined));
}

TEST(JsonErrors, NamesAndExtensions) {
  EXPECT_NE(load_scene("fense").error().message().find("did you mean \"fence\"?"), std::string::npos);
  const TemporaryFolder folder;
  EXPECT_NE(load_scene(folder.put("noext", "{}")).error().message().find("extension"), std::string::npos);
  EXPECT_NE(load_scene(folder.put("a.off", "OFF")).error().message().find("unknown extension (got \".off\""),
            std::string::npos);
  EXPECT_EQ(load_scene(folder.file("missing.json")).error().message(),
            folder.file("missing.json") + ": no such file");
  std::filesystem::create_directory(folder.file("dir.json"));
  EXPECT_EQ(load_scene(folder.file("dir.json")).error().message(),
            folder.file("dir.json") + ": is a folder, not a file");
  std::filesystem::create_directory(folder.file("dir"));
  EXPECT_EQ(load_scene(folder.file("dir")).error().message(),
            folder.file("dir") + ": is a folder, not a file");
}

}  // namespace
}  // namespace gnomon
