// A straight shadow edge against closed forms (docs/design.md, section 3): the area drawn wrong per unit of edge
// length is 0.25 texel for an edge along the texels and 0.236 at 45 degrees, and the error falls with the
// map's size as its inverse.
//
// The scene: thin plates under a sun straight above a floor, their edges at an angle to the texels, at
// distances that fall anywhere between them; the camera looks straight down from below the plates. Nothing
// but sampling can be wrong: the floor's depth is constant, and the plates are far above it.
#include <cmath>

#include "tests/support/compare_support.h"
#include "tests/support/one_world.h"

namespace gnomon::test {
namespace {

constexpr ImageSize square{400, 400};  // square, so that texels are
constexpr double camera_height = 1.0, plate_height = 3.0;
constexpr int plates = 8;  // at least five texels from edge to edge in every map below

double half_height() {
  return camera_height * std::tan(0.25);
}
double half_width() {
  return half_height() * square.width / square.height;
}

/// The edges' distances from the origin along (cos, sin) of the angle: about equally spaced, but not evenly.
std::vector<double> edge_distances() {
  std::vector<double> distances;
  const double reach = 0.95 * half_height(), golden = 0.6180339887498949;
  for (int i = 0; i < 2 * plates; ++i) {
    const double jitter = std::fmod(golden * (i + 1), 1.0) - 0.5;
    distances.push_back(reach * (-1.0 + 2.0 * (i + 0.5 + 0.5 * jitter) / (2.0 * plates)));
  }
  return distances;
}

/// Two triangles high above the floor, between two parallel edges.
Mesh plate(double from, double to, double angle) {
  const Vec3 across(std::cos(angle), 0.0, std::sin(angle)), along(-std::sin(angle), 0.0, std::cos(angle));
  const Vec3 up(0.0, plate_height, 0.0);
  const double reach = 10.0;
  Mesh mesh;
  mesh.positions = {up + from * across - reach * along, up + to * across - reach * along,
                    up + to * across + reach * along, up + from * across + reach * along};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

Scene plates_over_floor(double angle) {
  std::vector<Mesh> meshes{floor_mesh(20, 20)};
  const std::vector<double> distances = edge_distances();
  for (std::size_t i = 0; i + 1 < distances.size(); i += 2)
    meshes.push_back(plate(distances[i], distances[i + 1], angle));
  Scene scene = sunlit_scene(std::move(meshes), {0, -1, 0});
  scene.camera = {{0, camera_height, 0}, {0, 0, 0}, {0, 0, -1}, 0.5};
  return scene;
}

/// Length of all edges inside the picture, world units on the floor.
double visible_edge_length(double angle) {
  double length = 0.0;
  for (const double d : edge_distances()) {
    // Points d (cos, sin) + t (-sin, cos) inside the rectangle.
    double low = -1e9, high = 1e9;
    const auto clip = [&](double start, double rate, double bound) {
      if (std::abs(rate) < 1e-12) return;
      const double a = (-bound - start) / rate, b = (bound - start) / rate;
      low = std::max(low, std::min(a, b)), high = std::min(high, std::max(a, b));
    };
    clip(d * std::cos(angle), -std::sin(angle), half_width());
    clip(d * std::sin(angle), std::cos(angle), half_height());
    length += std::max(0.0, high - low);
  }
  return length;
}

struct Measured {
  double area_texels = 0.0;  ///< drawn wrong, per unit of edge length
  double wrong_fraction = 0.0;
};

/// `angle` is that of the edges to the texels: the map of a sun straight above lies along the world's axes.
Measured measure(OneWorld& world, double angle, int map_size) {
  const compare::Comparison run = world.compare(test_options(square, map_size, 0.01));
  const auto& light = run.lights[0];
  const double pixel = 2.0 * half_height() / square.height;
  const double area = double(light.error.wrong) * pixel * pixel / visible_edge_length(angle);
  return {area / light.texel_world[1], light.error.wrong_fraction};
}

/// A mean over map sizes, so that the edges fall anywhere between the texels.
Measured mean_over_sizes(double angle) {
  OneWorld world(plates_over_floor(angle));
  Measured mean;
  const std::vector<int> sizes{199, 211, 223, 227, 233, 239, 251, 257,
                               263, 269, 277, 283, 293, 307, 317, 331};
  for (const int map_size : sizes) {
    const Measured one = measure(world, angle, map_size);
    mean.area_texels += one.area_texels / double(sizes.size());
  }
  return mean;
}

TEST(StraightEdge, AreaIsTheClosedForm) {
  const Measured aligned = mean_over_sizes(0.0), diagonal = mean_over_sizes(pi / 4);
  std::printf("  area per edge length: %.4f texel along the texels (0.25), %.4f at 45 degrees (0.236)\n",
              aligned.area_texels, diagonal.area_texels);
  EXPECT_NEAR(aligned.area_texels, 0.25, 0.05 * 0.25);
  EXPECT_NEAR(diagonal.area_texels, 1 / (3 * std::sqrt(2.0)), 0.05 * 0.236);
}

// Texels of 5 to 10 pixels, so that the pixels' own steps add less than two percent to the offsets.
TEST(StraightEdge, OffsetOfTheEdgeIsUniformOverATexel) {
  OneWorld world(plates_over_floor(0.0));
  double squares = 0.0, absolute = 0.0;
  std::uint64_t edges = 0;
  for (int map_size = 40; map_size < 80; ++map_size) {
    const compare::Comparison run = world.compare(test_options(square, map_size, 0.01));
    const compare::EdgeStats& stats = run.lights[0].edges;
    squares += stats.rms_texels * stats.rms_texels * double(stats.edges);
    edges += stats.edges;
    absolute += stats.mean_absolute_texels * double(stats.edges);
    // The floor is square to the light: both figures are of the same way. The map's positions are floats.
    const double texel = run.lights[0].texel_world[1];
    EXPECT_NEAR(stats.rms_world, stats.rms_texels * texel, 1e-3 * texel) << map_size;
    EXPECT_NEAR(stats.mean_world, stats.mean_texels * texel, 1e-3 * texel) << map_size;
    EXPECT_NEAR(stats.mean_absolute_world, stats.mean_absolute_texels * texel, 1e-3 * texel) << map_size;
  }
  const double rms = std::sqrt(squares / double(edges));
  EXPECT_NEAR(absolute / double(edges), 0.25, 0.05 * 0.25);  // of a uniform offset
  std::printf("  edge offset: RMS %.4f texel (1/sqrt(12) = %.4f)\n", rms, 1 / std::sqrt(12.0));
  EXPECT_NEAR(rms, 1 / std::sqrt(12.0), 0.05 / std::sqrt(12.0));
}

TEST(StraightEdge, ErrorFallsAsTheInverseOfTheMapSize) {
  OneWorld world(plates_over_floor(0.4));
  double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (const int map_size : {160, 192, 256, 320, 384, 512, 640, 800}) {
    const double x = std::log(map_size), y = std::log(measure(world, 0.4, map_size).wrong_fraction);
    n += 1, sx += x, sy += y, sxx += x * x, sxy += x * y;
  }
  const double slope = (n * sxy - sx * sy) / (n * sxx - sx * sx);
  std::printf("  log-log slope of error against map size: %.4f (-1)\n", slope);
  EXPECT_NEAR(slope, -1.0, 0.05);
}

}  // namespace
}  // namespace gnomon::test
