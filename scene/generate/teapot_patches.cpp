// Newell's control points, and the evaluation of bicubic Bezier patches by Bernstein polynomials.
#include "scene/generate/teapot_patches.h"

#include <span>

namespace gnomon::teapot {
namespace {

// A ring of revolution, approximated as Newell did: a quarter circle's inner control points lie `tangent` off
// the axes (0.56 of the radius; the knob's 0.45 is his own rounding).
struct Ring {
  double radius, height, tangent;
};

constexpr Ring ring(double radius, double height) {
  return {radius, height, 0.56 * radius};
}

constexpr std::array<Ring, 4> rim{ring(1.4, 2.4), ring(1.3375, 2.53125), ring(1.4375, 2.53125),
                                  ring(1.5, 2.4)};
constexpr std::array<Ring, 7> body{ring(1.5, 2.4),  ring(1.75, 1.875), ring(2.0, 1.35), ring(2.0, 0.9),
                                   ring(2.0, 0.45), ring(1.5, 0.225),  ring(1.5, 0.15)};
constexpr std::array<Ring, 4> bottom{ring(1.5, 0.15), ring(1.5, 0.075), ring(1.425, 0.0), ring(0.0, 0.0)};
constexpr std::array<Ring, 7> lid{ring(0.0, 3.15), Ring{0.8, 3.15, 0.45}, ring(0.0, 2.85), ring(0.2, 2.7),
                                  ring(0.4, 2.55), ring(1.3, 2.55),       ring(1.3, 2.4)};

// A section of handle or spout: two points in the plane of symmetry, and how far the curve between them
// bulges out of it.
struct Section {
  double inner_x, inner_z, outer_x, outer_z, half_width;
};

constexpr std::array<Section, 7> handle{{{-1.6, 2.025, -1.5, 2.25, 0.3},
                                         {-2.3, 2.025, -2.5, 2.25, 0.3},
                                         {-2.7, 2.025, -3.0, 2.25, 0.3},
                                         {-2.7, 1.8, -3.0, 1.8, 0.3},
                                         {-2.7, 1.575, -3.0, 1.35, 0.3},
                                         {-2.5, 1.125, -2.65, 0.9375, 0.3},
                                         {-2.0, 0.9, -1.9, 0.6, 0.3}}};
constexpr std::array<Section, 7> spout{{{1.7, 1.425, 1.7, 0.6, 0.66},
                                        {2.6, 1.425, 3.1, 0.825, 0.66},
                                        {2.3, 2.1, 2.4, 2.025, 0.25},
                                        {2.7, 2.4, 3.3, 2.4, 0.25},
                                        {2.8, 2.475, 3.525, 2.49375, 0.25},
                                        {2.9, 2.475, 3.45, 2.5125, 0.15},
                                        {2.8, 2.4, 3.2, 2.4, 0.15}}};

Vec3 quarter_turns(Vec3 p, int turns) {
  for (int i = 0; i < turns; ++i) p = Vec3(p.y, -p.x, p.z);
  return p + Vec3(0.0);  // turns -0 into 0, so that equal points are equal bits
}

// Four patches around the axis; rows run down the outside, columns clockwise from above.
void revolve(std::span<const Ring> rings, Piece piece, std::vector<NamedPatch>& out) {
  for (std::size_t first = 0; first + 3 < rings.size(); first += 3) {
    for (int turn = 0; turn < 4; ++turn) {
      Patch patch;
      for (std::size_t row = 0; row < 4; ++row) {
        const auto [r, z, t] = rings[first + row];
        const std::array<Vec3, 4> quarter{{{r, 0.0, z}, {r, -t, z}, {t, -r, z}, {0.0, -r, z}}};
        for (std::size_t k = 0; k < 4; ++k) patch[row][k] = quarter_turns(quarter[k], turn);
      }
      out.push_back({piece, patch});
    }
  }
}

// Two patches, mirror images in the plane y = 0, for every four sections.
void mirror(std::span<const Section> sections, Piece piece, std::vector<NamedPatch>& out) {
  for (std::size_t first = 0; first + 3 < sections.size(); first += 3) {
    Patch near_side, far_side;
    for (std::size_t row = 0; row < 4; ++row) {
      const Section& s = sections[first + row];
      near_side[row] = {Vec3(s.inner_x, 0.0, s.inner_z), Vec3(s.inner_x, -s.half_width, s.inner_z),
                        Vec3(s.outer_x, -s.half_width, s.outer_z), Vec3(s.outer_x, 0.0, s.outer_z)};
      far_side[row] = {Vec3(s.outer_x, 0.0, s.outer_z), Vec3(s.outer_x, s.half_width, s.outer_z),
                       Vec3(s.inner_x, s.half_width, s.inner_z), Vec3(s.inner_x, 0.0, s.inner_z)};
    }
    out.push_back({piece, near_side});
    out.push_back({piece, far_side});
  }
}

using Weights = std::array<double, 4>;

Weights bernstein(double t, double s) {
  return {s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t};
}
Weights bernstein_derivative(double t) {
  const double s = 1.0 - t;
  return {-3.0 * s * s, 3.0 * s * (s - 2.0 * t), 3.0 * t * (2.0 * s - t), 3.0 * t * t};
}

// Symmetric under reversal: outer pair, inner pair, then their sum.
template <class Point>
Vec3 blend(const Weights& w, const Point& point) {
  return (w[0] * point(0) + w[3] * point(3)) + (w[1] * point(1) + w[2] * point(2));
}

Vec3 blend(const Patch& patch, const Weights& wu, const Weights& wv) {
  return blend(wu, [&](std::size_t r) { return blend(wv, [&](std::size_t c) { return patch[r][c]; }); });
}

// A row that is one point must stay that point: the weights' rounded sum would move it by an ulp.
bool collapsed(const std::array<Vec3, 4>& row) {
  return row[0] == row[1] && row[0] == row[2] && row[0] == row[3];
}

}  // namespace

std::vector<NamedPatch> patches() {
  std::vector<NamedPatch> out;
  revolve(rim, Piece::body, out);
  revolve(body, Piece::body, out);
  revolve(bottom, Piece::body, out);
  revolve(lid, Piece::lid, out);
  mirror(handle, Piece::handle, out);
  mirror(spout, Piece::spout, out);
  return out;
}

Vec3 evaluate(const Patch& patch, double u, double one_minus_u, double v, double one_minus_v) {
  if (u == 0.0 && collapsed(patch[0])) return patch[0][0];
  if (one_minus_u == 0.0 && collapsed(patch[3])) return patch[3][0];
  return blend(patch, bernstein(u, one_minus_u), bernstein(v, one_minus_v)) + Vec3(0.0);
}

Vec3 normal(const Patch& patch, double u, double v) {
  const auto cross_at = [&](double row, double column) {
    return glm::cross(blend(patch, bernstein(row, 1.0 - row), bernstein_derivative(column)),
                      blend(patch, bernstein_derivative(row), bernstein(column, 1.0 - column)));
  };
  Vec3 n = cross_at(u, v);
  // At a collapsed row the column derivative vanishes: take the normal in the middle of the patch's columns a
  // little way in. The patches that meet there are symmetric about the axis, so the limit is the axis itself.
  if (glm::length(n) < 1e-9) {
    n = cross_at(u < 0.5 ? 1e-4 : 1.0 - 1e-4, 0.5);
    n = Vec3(0.0, 0.0, n.z);
  }
  return glm::normalize(n);
}

}  // namespace gnomon::teapot
