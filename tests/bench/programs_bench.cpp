// Gnomon's ray tracer against POV-Ray 3.7 and Blender's Cycles, whole processes from the command line to the written
// picture: the same triangles, camera, sun and materials, one ray per pixel, all cores. POV-Ray reads a scene of its
// own with a mesh2, Gnomon and Cycles (cycles_peer.py) a JSON scene with a binary PLY. The pictures are compared and
// put side by side. Not part of the mandatory set-up: what is not on the PATH is said and left out.
#include <fmt/format.h>
#include <fmt/os.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "bench_scenes.h"
#include "scene/base/timing.h"
#include "scene/camera.h"
#include "scene/files/pictures/image_io.h"
#include "scene/world.h"

namespace gnomon::bench {
namespace {

struct Settings {
  std::string gnomon = "gnomon", folder = "out/programs", json;
  ImageSize size{1280, 720};
  int runs = 3;
  std::vector<std::string> scenes, peers{"povray", "cycles"};
};

constexpr double grey = 0.8;
constexpr std::array<double, 3> sky{0.2, 0.3, 0.45};
/// What the pictures may differ by: each program's own arithmetic decides pixels on outlines and shadow edges.
constexpr double most_different = 0.02;

/// Another program.
struct Peer {
  std::string name, program, title;
  double goal;  ///< of whole-process wall clock, its over ours
};
const std::array<Peer, 2> known_peers{
    {{"povray", "povray", "POV-Ray 3.7", 10.0}, {"cycles", "blender", "Cycles (Blender)", 1.0}}};

std::string vector_text(const Vec3& v) {
  return fmt::format("<{},{},{}>", v.x, v.y, v.z);
}

void write_pov(const std::string& path, const World& world, const View& view, const Light& sun) {
  auto out = fmt::output_file(path);
  out.print("#version 3.7;\nglobal_settings {{ assumed_gamma 1.0 }}\n");
  out.print("background {{ rgb <{}> }}\n", fmt::join(sky, ","));
  // The frame is given outright, so that POV-Ray's left-handed habits do not matter.
  out.print("camera {{ perspective location {} direction {} right {} up {} }}\n", vector_text(view.eye),
            vector_text(view.forward), vector_text(2.0 * view.tan_half_x * view.right),
            vector_text(2.0 * view.tan_half_y * view.up));
  out.print("light_source {{ {} color rgb 1 parallel point_at <0,0,0> }}\n",
            vector_text(-1000.0 * sun.direction));
  out.print("mesh2 {{\nvertex_vectors {{ {}", world.vertex_count());
  for (const Vec3& p : positions_of(world)) out.print(",\n{}", vector_text(p));
  out.print(" }}\nface_indices {{ {}", world.triangle_count());
  for (const auto& t : triangles_of(world)) out.print(",\n<{},{},{}>", t[0], t[1], t[2]);
  out.print(" }}\npigment {{ rgb {} }} finish {{ ambient 0 diffuse 1 }} }}\n", grey);
}

void write_ply(const std::string& path, const World& world) {
  std::ofstream out(path, std::ios::binary);
  out << "ply\nformat binary_little_endian 1.0\nelement vertex " << world.vertex_count()
      << "\nproperty float x\nproperty float y\nproperty float z\nelement face " << world.triangle_count()
      << "\nproperty list uchar int vertex_indices\nend_header\n";
  std::string bytes;
  const auto put = [&](const auto& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  for (const Vec3& p : positions_of(world))
    for (int k = 0; k < 3; ++k) put(static_cast<float>(p[k]));
  for (const auto& t : triangles_of(world)) {
    put(static_cast<std::uint8_t>(3));
    for (const std::uint32_t index : t) put(index);
  }
  out << bytes;
}

nlohmann::json vector_json(const Vec3& v) {
  return {v.x, v.y, v.z};
}

void write_json(const std::string& path, const std::string& model, const Scene& scene, const Light& sun) {
  const nlohmann::json document{
      {"schema", "gnomon/scene/1"},
      {"camera",
       {{"eye", vector_json(scene.camera.eye)},
        {"target", vector_json(scene.camera.target)},
        {"vertical_fov_degrees", scene.camera.vertical_fov * 180.0 / pi}}},
      {"lights", {{{"type", "directional"}, {"direction", vector_json(sun.direction)}}}},
      {"materials", {{{"name", "grey"}, {"diffuse", grey}}}},
      {"meshes", {{{"name", "model"}, {"file", model}}}},
      {"instances", {{{"mesh", "model"}, {"material", "grey"}}}},
      {"background", sky},
      {"exposure", 1}};
  std::ofstream(path) << document.dump(1) << "\n";
}

/// Milliseconds of the whole process; nothing when it failed.
std::optional<double> run_command(const std::string& command, int runs) {
  Times times;
  for (int run = 0; run < runs; ++run) {
    int status = 0;
    time_run(times, [&] { status = std::system(command.c_str()); });
    if (status != 0) return std::nullopt;
  }
  return times.median();
}

struct Difference {
  double mean = 0.0;   ///< of the channels, 0 to 255
  double share = 0.0;  ///< of pixels with a channel that differs by more than 8
};

std::optional<Difference> compare(const std::string& ours, const std::string& theirs,
                                  const std::string& both) {
  const auto a = read_texture(ours, true), b = read_texture(theirs, true);
  if (!a || !b || !(a->size == b->size)) return std::nullopt;
  Rgb8Image side_by_side({2 * a->size.width, a->size.height});
  Difference difference;
  for (int y = 0; y < a->size.height; ++y)
    for (int x = 0; x < a->size.width; ++x) {
      const std::size_t i =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(a->size.width) + static_cast<std::size_t>(x);
      const glm::ivec3 p(a->texels[i]), q(b->texels[i]), d = glm::abs(p - q);
      side_by_side.at(x, y) = p, side_by_side.at(a->size.width + x, y) = q;
      difference.mean += (d.x + d.y + d.z) / 3.0;
      difference.share += std::max({d.x, d.y, d.z}) > 8 ? 1.0 : 0.0;
    }
  const auto pixels = static_cast<double>(a->size.pixels());
  difference.mean /= pixels, difference.share /= pixels;
  if (!write_png(both, side_by_side)) return std::nullopt;
  return difference;
}

/// From the start to the picture; BASE-NAME.png.
std::string command_of(const Peer& peer, const std::string& base, const Settings& settings) {
  const ImageSize size = settings.size;
  if (peer.name == "povray")
    return fmt::format(
        "povray '+I{0}.pov' '+O{0}-povray.png' +W{1} +H{2} +FN8 -D -A -GA File_Gamma=sRGB >/dev/null 2>&1",
        base, size.width, size.height);
  return fmt::format(
      "blender --background --factory-startup --python-exit-code 1 --python '{0}/cycles_peer.py' -- "
      "'{1}.json' "
      "{2} {3} '{1}-cycles.png' >'{1}-cycles.txt' 2>&1",
      GNOMON_BENCH_FOLDER, base, size.width, size.height);
}

/// What Cycles says its last render alone took, milliseconds.
std::optional<double> render_alone(const std::string& base) {
  std::ifstream said(base + "-cycles.txt");
  for (std::string line; std::getline(said, line);)
    if (line.starts_with("render_ms ")) return std::stod(line.substr(10));
  return std::nullopt;
}

void add_row(nlohmann::json& rows, const std::string& name, const BenchScene& bench, double ours,
             const std::string& peer, double theirs, double goal, const Difference& difference) {
  const double ratio = theirs / ours;
  rows.push_back({{"name", name},
                  {"scene", bench.name},
                  {"threads", 0},
                  {"value", ours},
                  {"unit", "ms"},
                  {"peer", peer},
                  {"peer_value", theirs},
                  {"ratio", ratio},
                  {"goal", goal},
                  {"met", ratio >= goal},
                  {"different_pixels", difference.share}});
  fmt::print("{:<10}{:<28}{:>10.0f}{:>10.0f}{:>8.1f}  {:<8}{:>8.3f}{:>9.3f} %  {}\n", bench.name, peer, ours,
             theirs, ratio, ratio >= goal ? "met" : "NOT MET", difference.mean, 100.0 * difference.share,
             difference.share <= most_different ? "alike" : "NOT ALIKE");
}

bool run_peer(const Peer& peer, const BenchScene& bench, const std::string& base, double ours,
              const Settings& settings, nlohmann::json& rows) {
  const auto theirs = run_command(command_of(peer, base, settings), settings.runs);
  const auto difference = compare(base + "-gnomon.png", fmt::format("{}-{}.png", base, peer.name),
                                  fmt::format("{}-{}-side-by-side.png", base, peer.name));
  if (!theirs || !difference) {
    fmt::print("{}: {} failed\n", bench.name, peer.title);
    return false;
  }
  add_row(rows, "whole_process", bench, ours, peer.title, *theirs, peer.goal, *difference);
  const auto alone = peer.name == "cycles" ? render_alone(base) : std::nullopt;
  if (alone)
    add_row(rows, "whole_process_against_render", bench, ours, peer.title + ", render alone", *alone,
            peer.goal, *difference);
  return difference->share <= most_different;
}

bool run_scene(const BenchScene& bench, const std::vector<Peer>& peers, const Settings& settings,
               nlohmann::json& rows) {
  const World world = make_world(bench.scene);
  const Light& sun = bench.scene.lights[1];
  const std::string base = settings.folder + "/" + bench.name;
  write_pov(base + ".pov", world, make_view(bench.scene.camera, settings.size), sun);
  write_ply(base + ".ply", world);
  write_json(base + ".json", bench.name + ".ply", bench.scene, sun);
  const auto ours =
      run_command(fmt::format("'{}' raytrace '{}.json' --size {}x{} -o '{}-gnomon.png' --quiet",
                              settings.gnomon, base, settings.size.width, settings.size.height, base),
                  settings.runs);
  if (!ours) {
    fmt::print("{}: gnomon failed\n", bench.name);
    return false;
  }
  bool alike = true;
  for (const Peer& peer : peers) alike = run_peer(peer, bench, base, *ours, settings, rows) && alike;
  return alike;
}

std::vector<Peer> peers_here(const Settings& settings) {
  std::vector<Peer> here;
  for (const Peer& peer : known_peers) {
    if (std::find(settings.peers.begin(), settings.peers.end(), peer.name) == settings.peers.end()) continue;
    if (std::system(fmt::format("command -v {} >/dev/null 2>&1", peer.program).c_str()) == 0)
      here.push_back(peer);
    else
      fmt::print("{0} is not installed: {1} is left out (Debian's package: {0})\n", peer.program, peer.title);
  }
  return here;
}

int run(const Settings& settings) {
  const std::vector<Peer> peers = peers_here(settings);
  if (peers.empty()) return 0;
  std::filesystem::create_directories(settings.folder);
  fmt::print("{}x{}, whole processes, median of {}; pictures in {}\n", settings.size.width,
             settings.size.height, settings.runs, settings.folder);
  fmt::print("{:<10}{:<28}{:>10}{:>10}{:>8}  {:<8}{:>8}{:>11}\n", "scene", "peer", "gnomon ms", "peer ms",
             "ratio", "goal", "mean", "> 8/255");
  std::vector<BenchScene> scenes{teapot_scene()};
  if (auto bunny = bunny_scene()) scenes.push_back(std::move(*bunny));
  scenes.push_back(million_scene());
  nlohmann::json rows = nlohmann::json::array();
  bool alike = true;
  for (const BenchScene& scene : scenes) {
    const auto& wanted = settings.scenes;
    if (wanted.empty() || std::find(wanted.begin(), wanted.end(), scene.name) != wanted.end())
      alike = run_scene(scene, peers, settings, rows) && alike;
  }
  if (!settings.json.empty())
    std::ofstream(settings.json) << nlohmann::json{{"schema", "gnomon/bench/1"}, {"rows", rows}}.dump(2)
                                 << "\n";
  return alike ? 0 : 1;
}

}  // namespace
}  // namespace gnomon::bench

int main(int argc, char** argv) {
  CLI::App app("Gnomon's ray tracer against POV-Ray 3.7 and Blender's Cycles: whole processes.");
  gnomon::bench::Settings settings;
  app.add_option("--gnomon", settings.gnomon, "the program [default gnomon, from the PATH]");
  app.add_option("--out", settings.folder, "folder for scenes and pictures [default out/programs]");
  app.add_option("--width", settings.size.width, "pixels [default 1280]");
  app.add_option("--height", settings.size.height, "pixels [default 720]");
  app.add_option("--runs", settings.runs, "the median counts [default 3]");
  app.add_option("--scene", settings.scenes, "teapot, bunny, million [default all]");
  app.add_option("--peer", settings.peers, "povray, cycles [default both, where they are installed]");
  app.add_option("--json", settings.json, "write the rows as gnomon/bench/1 [default off]");
  CLI11_PARSE(app, argc, argv);
  return gnomon::bench::run(settings);
}
