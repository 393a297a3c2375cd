// Gnomon's ray tracer against POV-Ray 3.7, whole processes from the command line to the written picture: the
// same triangles, camera, sun and materials, one ray per pixel, all cores. Each program reads its own format:
// a POV-Ray scene with a mesh2, a JSON scene with a binary PLY. The pictures are compared and put side by
// side. Not part of the mandatory set-up: without povray on the PATH it says so and does nothing.
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
#include "scene/camera.h"
#include "scene/files/image_io.h"
#include "scene/timing.h"
#include "scene/world.h"

namespace gnomon::bench {
namespace {

struct Settings {
  std::string gnomon = "gnomon", folder = "out/povray", json;
  ImageSize size{1280, 720};
  int runs = 3;
  std::vector<std::string> scenes;
};

constexpr double grey = 0.8;
constexpr std::array<double, 3> sky{0.2, 0.3, 0.45};
/// The goal of whole-process wall clock, and what the pictures may differ by: POV-Ray's own arithmetic
/// decides pixels on outlines and shadow edges.
constexpr double goal = 10.0, most_different = 0.02;

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
  out.print("mesh2 {{\nvertex_vectors {{ {}", world.positions.size());
  for (const Vec3& p : world.positions) out.print(",\n{}", vector_text(p));
  out.print(" }}\nface_indices {{ {}", world.triangles.size());
  for (const auto& t : world.triangles) out.print(",\n<{},{},{}>", t[0], t[1], t[2]);
  out.print(" }}\npigment {{ rgb {} }} finish {{ ambient 0 diffuse 1 }} }}\n", grey);
}

void write_ply(const std::string& path, const World& world) {
  std::ofstream out(path, std::ios::binary);
  out << "ply\nformat binary_little_endian 1.0\nelement vertex " << world.positions.size()
      << "\nproperty float x\nproperty float y\nproperty float z\nelement face " << world.triangles.size()
      << "\nproperty list uchar int vertex_indices\nend_header\n";
  std::string bytes;
  const auto put = [&](const auto& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  for (const Vec3& p : world.positions)
    for (int k = 0; k < 3; ++k) put(static_cast<float>(p[k]));
  for (const auto& t : world.triangles) {
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

bool run_scene(const BenchScene& bench, const Settings& settings, nlohmann::json& rows) {
  const World world = make_world(bench.scene);
  const Light& sun = bench.scene.lights[1];
  const std::string base = settings.folder + "/" + bench.name;
  write_pov(base + ".pov", world, make_view(bench.scene.camera, settings.size), sun);
  write_ply(base + ".ply", world);
  write_json(base + ".json", bench.name + ".ply", bench.scene, sun);
  const auto gnomon =
      run_command(fmt::format("'{}' raytrace '{}.json' --size {}x{} -o '{}-gnomon.png' --quiet",
                              settings.gnomon, base, settings.size.width, settings.size.height, base),
                  settings.runs);
  const auto povray = run_command(
      fmt::format(
          "povray '+I{0}.pov' '+O{0}-povray.png' +W{1} +H{2} +FN8 -D -A -GA File_Gamma=sRGB >/dev/null 2>&1",
          base, settings.size.width, settings.size.height),
      settings.runs);
  const auto difference = compare(base + "-gnomon.png", base + "-povray.png", base + "-side-by-side.png");
  if (!gnomon || !povray || !difference) {
    fmt::print("{}: one of the programs failed\n", bench.name);
    return false;
  }
  const double ratio = *povray / *gnomon;
  const bool alike = difference->share <= most_different;
  fmt::print("{:<10}{:>10}{:>12.0f}{:>12.0f}{:>8.1f}  {:<8}{:>8.3f}{:>9.3f} %  {}\n", bench.name,
             world.triangle_count(), *gnomon, *povray, ratio, ratio >= goal ? "met" : "NOT MET",
             difference->mean, 100.0 * difference->share, alike ? "alike" : "NOT ALIKE");
  rows.push_back({{"name", "whole_process"},
                  {"scene", bench.name},
                  {"threads", 0},
                  {"value", *gnomon},
                  {"unit", "ms"},
                  {"peer", "POV-Ray 3.7"},
                  {"peer_value", *povray},
                  {"ratio", ratio},
                  {"goal", goal},
                  {"met", ratio >= goal},
                  {"different_pixels", difference->share}});
  return alike;
}

int run(const Settings& settings) {
  if (std::system("command -v povray >/dev/null 2>&1") != 0) {
    fmt::print("povray is not installed: nothing is compared (Debian's package: povray)\n");
    return 0;
  }
  std::filesystem::create_directories(settings.folder);
  fmt::print("{}x{}, whole processes, median of {}; pictures in {}\n", settings.size.width,
             settings.size.height, settings.runs, settings.folder);
  fmt::print("{:<10}{:>10}{:>12}{:>12}{:>8}  {:<8}{:>8}{:>11}\n", "scene", "triangles", "gnomon ms",
             "povray ms", "ratio", "goal 10", "mean", "> 8/255");
  std::vector<BenchScene> scenes{teapot_scene()};
  if (auto bunny = bunny_scene()) scenes.push_back(std::move(*bunny));
  scenes.push_back(million_scene());
  nlohmann::json rows = nlohmann::json::array();
  bool alike = true;
  for (const BenchScene& scene : scenes) {
    const auto& wanted = settings.scenes;
    if (wanted.empty() || std::find(wanted.begin(), wanted.end(), scene.name) != wanted.end())
      alike = run_scene(scene, settings, rows) && alike;
  }
  if (!settings.json.empty())
    std::ofstream(settings.json) << nlohmann::json{{"schema", "gnomon/bench/1"}, {"rows", rows}}.dump(2)
                                 << "\n";
  return alike ? 0 : 1;
}

}  // namespace
}  // namespace gnomon::bench

int main(int argc, char** argv) {
  CLI::App app("Gnomon's ray tracer against POV-Ray 3.7: whole processes.");
  gnomon::bench::Settings settings;
  app.add_option("--gnomon", settings.gnomon, "the program [default gnomon, from the PATH]");
  app.add_option("--out", settings.folder, "folder for scenes and pictures [default out/povray]");
  app.add_option("--width", settings.size.width, "pixels [default 1280]");
  app.add_option("--height", settings.size.height, "pixels [default 720]");
  app.add_option("--runs", settings.runs, "the median counts [default 3]");
  app.add_option("--scene", settings.scenes, "teapot, bunny, million [default all]");
  app.add_option("--json", settings.json, "write the rows as gnomon/bench/1 [default off]");
  CLI11_PARSE(app, argc, argv);
  return gnomon::bench::run(settings);
}
