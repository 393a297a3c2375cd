// Trees and bushes: bark as closed tubes, leaves as folded rhombi of two triangles each (open, lit from both
// sides).
#include <glm/gtc/matrix_transform.hpp>

#include "scene/generate/generator.h"
#include "scene/generate/mesh_builder.h"
#include "scene/generate/random.h"

namespace gnomon {
namespace {

// A leaf from its stalk at `foot` along `along` (unit), folded a little about its midrib.
void add_leaf(MeshBuilder& b, const Vec3& foot, const Vec3& along, const Vec3& up_hint, double size) {
  const Vec3 side = glm::normalize(glm::cross(along, up_hint));
  const Vec3 up = glm::cross(side, along);
  const Vec3 tip = foot + size * along;
  const Vec3 middle = foot + 0.45 * size * along + 0.10 * size * up;
  for (const double s : {1.0, -1.0}) {
    const Vec3 edge = middle + 0.30 * s * size * side;
    const Vec3 n = glm::normalize(s * glm::cross(edge - foot, tip - foot));
    const std::uint32_t a = b.vertex(foot, n, {0.5, 1.0}), c = b.vertex(tip, n, {0.5, 0.0});
    const std::uint32_t e = b.vertex(edge, n, {0.5 + 0.5 * s, 0.55});
    s > 0.0 ? b.triangle(a, e, c) : b.triangle(a, c, e);
  }
}

void add_random_leaf(MeshBuilder& b, Random& random, const Vec3& foot, const Vec3& outward, double size) {
  const Vec3 along = glm::normalize(outward + 0.9 * random.direction());
  Vec3 up = Vec3(0.0, 1.0, 0.0) + 0.5 * random.direction();
  if (glm::length(glm::cross(along, up)) < 0.05) up += Vec3(0.5, 0.0, 0.3);
  add_leaf(b, foot, along, up, size * random.between(0.7, 1.2));
}

// A five-petalled flower that looks along `facing`: five triangles about a raised middle.
void add_flower(MeshBuilder& b, const Vec3& at, const Vec3& facing, double size) {
  Vec3 t, s;
  orthonormal_basis(facing, t, s);
  constexpr int petals = 5;
  for (int i = 0; i < petals; ++i) {
    const auto rim = [&](double step) {
      const double a = 2.0 * pi * (i + step) / petals;
      return at + size * (std::cos(a) * t + std::sin(a) * s) + 0.25 * size * facing;
    };
    const std::array<Vec3, 3> corners{at, rim(0.06), rim(0.94)};
    b.polygon(corners);
  }
}

// ---- tree

struct Branch {
  Vec3 start, direction;
  double length, radius;
  int level;
};

class Tree {
 public:
  explicit Tree(const Values& v) : values_(v), random_(v.seed()) {}

  GeneratedModel grow() {
    const double height = values_.number("height");
    add({Vec3(0.0, -0.02 * height, 0.0), Vec3(0.0, 1.0, 0.0), 0.55 * height, values_.number("trunk_radius"),
         0});
    // Leaves are dealt to twigs at random, so that their number is exact.
    for (int i = 0; i < values_.count("leaves"); ++i) {
      const auto& [from, to] = twigs_[random_.bits() % twigs_.size()];
      const Vec3 stray = 0.02 * height * random_.in_ball();
      const Vec3 foot = glm::mix(from, to, random_.unit()) + stray;
      add_random_leaf(leaves_, random_, foot, glm::normalize(to - from), values_.number("leaf_size"));
    }
    GeneratedModel model;
    model.parts.push_back({"bark", bark_.take()});
    if (!leaves_.empty()) model.parts.push_back({"leaf", leaves_.take()});
    return model;
  }

 private:
  void add(const Branch& branch) {
    constexpr int segments = 6;
    const bool last = branch.level == values_.count("levels");
    const double end_radius = branch.radius * (last ? 0.3 : 0.55);
    std::vector<Vec3> centers{branch.start};
    std::vector<double> radii{branch.level == 0 ? 1.35 * branch.radius : branch.radius};
    Vec3 d = branch.direction;
    for (int i = 1; i <= segments; ++i) {
      const double lift = branch.level == 0 ? 0.3 : 0.06;
      d = glm::normalize(d + 0.16 * random_.in_ball() + Vec3(0.0, lift, 0.0));
      centers.push_back(centers.back() + d * (branch.length / segments));
      radii.push_back(glm::mix(branch.radius, end_radius, static_cast<double>(i) / segments));
    }
    bark_.tube(centers, radii, branch.level == 0 ? 14 : branch.level == 1 ? 9 : 5);
    if (last || branch.level + 1 == values_.count("levels")) {
      for (std::size_t i = 2; i < centers.size(); ++i) twigs_.emplace_back(centers[i - 1], centers[i]);
    }
    if (!last) fork(branch, centers, radii, d);
  }

  void fork(const Branch& branch, const std::vector<Vec3>& centers, const std::vector<double>& radii,
            const Vec3& end) {
    constexpr double golden_angle = 2.399963229728653;  // keeps neighbours from growing over each other
    const int children = branch.level == 0 ? 6 : 4;
    const double first = branch.level == 0 ? 0.55 : 0.35, phase = random_.between(0.0, 2.0 * pi);
    for (int i = 0; i < children; ++i) {
      const double at =
          (first + (1.0 - first) * (i + 1) / children) * static_cast<double>(centers.size() - 1);
      const auto k = std::min(static_cast<std::size_t>(at), centers.size() - 1);
      Vec3 side, other;
      orthonormal_basis(end, side, other);
      const double turn = phase + golden_angle * i,
                   open = values_.number("spread") * random_.between(0.75, 1.1);
      const Vec3 out = std::cos(turn) * side + std::sin(turn) * other;
      const Vec3 direction = glm::normalize(std::cos(open) * end + std::sin(open) * out);
      add({centers[k], direction, branch.length * random_.between(0.5, 0.68), 0.62 * radii[k],
           branch.level + 1});
    }
  }

  const Values& values_;
  Random random_;
  MeshBuilder bark_, leaves_;
  std::vector<std::pair<Vec3, Vec3>> twigs_;
};

Expected<GeneratedModel> make_tree(const Values& v) {
  return Tree(v).grow();
}

const std::array<std::string_view, 2> tree_parts{"bark", "leaf"};
const std::array<ParameterInfo, 7> tree_parameters{{
    length_parameter("height", 4.0, 0.1, 100.0, "of the whole tree, about"),
    length_parameter("trunk_radius", 0.11, 0.005, 5.0, "of the trunk above its foot"),
    count_parameter("levels", 3, 1, 5, "how often branches fork"),
    {"spread", "radians", 0.85, 0.1, 1.5, "angle between a branch and its children"},
    count_parameter("leaves", 6000, 0, 500000, "leaves, two triangles each"),
    length_parameter("leaf_size", 0.09, 0.002, 2.0, "length of a leaf"),
    seed_parameter(),
}};

// ---- bush: leaves over a dark core, so that few leaves hide everything

// A point of the surface of the unit ball or cube, and its outward direction.
std::pair<Vec3, Vec3> surface_point(Random& random, bool box) {
  if (!box) {
    const Vec3 d = random.direction();
    return {d, d};
  }
  const auto axis = static_cast<int>(random.bits() % 3);
  Vec3 n{0.0}, p{random.between(-1.0, 1.0), random.between(-1.0, 1.0), random.between(-1.0, 1.0)};
  n[axis] = random.unit() < 0.5 ? -1.0 : 1.0;
  p[axis] = n[axis];
  return {p, n};
}

Mesh bush_core(const Vec3& half, double center_y, bool box) {
  MeshBuilder b;
  if (box) {
    b.box({-half.x, center_y - half.y, -half.z}, {half.x, center_y + half.y, half.z},
          0.1 * std::min({half.x, half.y, half.z}));
    return b.take();
  }
  constexpr int rings = 10;
  std::vector<ProfilePoint> profile;
  for (int i = 0; i <= rings; ++i) {
    const double a = pi * i / rings;
    profile.push_back({i == 0 || i == rings ? 0.0 : std::sin(a), -std::cos(a)});
  }
  MeshBuilder ball;
  ball.lathe(profile, 20);
  b.append(ball.take(), glm::scale(glm::translate(Mat4(1.0), Vec3(0.0, center_y, 0.0)), half));
  return b.take();
}

Expected<GeneratedModel> make_bush(const Values& v) {
  const Vec3 size = v.vec3("size"), half = 0.5 * size;
  const bool box = v.text("shape") == "box";
  const double leaf = v.number("leaf_size"), depth = std::min({leaf, half.x, half.y, half.z});
  const Vec3 shell = glm::max(half - Vec3(0.5 * depth), 0.5 * half);
  const double center_y = v.number("lift") + half.y;
  Random random(v.seed());
  MeshBuilder leaves, flowers;
  const auto spot = [&](double out) {
    const auto [p, n] = surface_point(random, box);
    return std::pair{p * (shell + Vec3(depth * out)) + Vec3(0.0, center_y, 0.0), n};
  };
  for (int i = 0; i < v.count("leaves"); ++i) {
    const auto [p, n] = spot(random.between(-0.6, 0.2));
    add_random_leaf(leaves, random, p, n, leaf);
  }
  for (int i = 0; i < v.count("flowers"); ++i) {
    const auto [p, n] = spot(random.between(0.3, 0.6));
    add_flower(flowers, p, glm::normalize(n + 0.4 * random.direction()), v.number("flower_size"));
  }
  GeneratedModel model;
  model.parts.push_back({"core", bush_core(shell - Vec3(0.35 * depth), center_y, box)});
  model.parts.push_back({"leaf", leaves.take()});
  if (!flowers.empty()) model.parts.push_back({"flower", flowers.take()});
  return model;
}

const std::array<std::string_view, 3> bush_parts{"core", "leaf", "flower"};
const std::array<std::string_view, 2> bush_shapes{"ball", "box"};
const std::array<ParameterInfo, 8> bush_parameters{{
    {"size", "m", std::vector<double>{0.6, 0.5, 0.6}, 0.01, 200.0, "extent along x, y and z, about"},
    length_parameter("lift", 0.0, 0.0, 50.0, "height of its lower end"),
    {"shape", "", std::string("ball"), -infinity, infinity, "a ball (or ellipsoid), or a clipped hedge",
     false, 0, 0, bush_shapes},
    count_parameter("leaves", 1200, 1, 500000, "leaves, two triangles each"),
    length_parameter("leaf_size", 0.06, 0.002, 2.0, "length of a leaf"),
    count_parameter("flowers", 0, 0, 100000, "flowers, five triangles each"),
    length_parameter("flower_size", 0.025, 0.002, 1.0, "radius of a flower"),
    seed_parameter(),
}};

}  // namespace

std::span<const MeshGenerator> plant_generators() {
  static const std::array<MeshGenerator, 2> list{{
      {{"bush", "A bush or a clipped hedge: leaves, perhaps flowers, over a closed core.", bush_parameters,
        bush_parts},
       make_bush},
      {{"tree", "A tree: trunk and branches as closed tubes, leaves on the outer branches.", tree_parameters,
        tree_parts},
       make_tree},
  }};
  return list;
}

}  // namespace gnomon
