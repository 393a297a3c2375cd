// A ray's walk through a tree of boxes, with a stack. A case's numbers are how many nodes there are, which boxes may be asked (a bit for
// each node), how often leaves may be, and four for each node; shaders/function/call.frag counts who asks.
#include <algorithm>
#include <cmath>
#include <span>

#include "functions/make_questions.h"
#include "functions/parts.h"

namespace gnomon::functions {
namespace {

/// A node as the shader gets it: t at which the ray is in its box (-1: never), its children (-1: a leaf), t of what is in a leaf.
struct Node {
  double entry = -1.0, left = -1.0, right = -1.0, thing = -1.0;
};
using Nodes = std::vector<Node>;
constexpr std::size_t most_nodes = 11, walk_numbers = 3 + 4 * most_nodes;

Nodes nodes_of(Numbers n) {
  Nodes nodes;
  for (std::size_t i = 0; i < static_cast<std::size_t>(n[0]); ++i)
    nodes.push_back({n[3 + 4 * i], n[4 + 4 * i], n[5 + 4 * i], n[6 + 4 * i]});
  return nodes;
}

/// How a walk is made: as it should be, or with a mistake that a group of cases is to show.
struct Manner {
  bool ordered = true;       ///< the nearer child first
  bool cuts = true;          ///< no box is entered that begins behind the nearest hit
  bool ends_early = false;   ///< at the first hit
  bool near_only = false;    ///< the farther child is forgotten
  bool right_first = false;  ///< of children whose boxes begin at one t
};
struct Walked {
  double nearest = -1.0;
  int leaves = 0;  ///< asked
  int boxes = 0;   ///< asked, a bit for each node
};

void walk(const Nodes& nodes, const Node& node, Manner manner, Walked& so_far) {
  if (manner.cuts && so_far.nearest >= 0.0 && node.entry > so_far.nearest) return;
  if (manner.ends_early && so_far.nearest >= 0.0) return;
  if (node.left < 0.0) {
    ++so_far.leaves;
    if (node.thing >= 0.0 && (so_far.nearest < 0.0 || node.thing < so_far.nearest))
      so_far.nearest = node.thing;
    return;
  }
  so_far.boxes |= 1 << static_cast<int>(node.left) | 1 << static_cast<int>(node.right);
  const Node *near = &nodes[static_cast<std::size_t>(node.left)],
             *far = &nodes[static_cast<std::size_t>(node.right)];
  const bool exchange = near->entry > far->entry || (manner.right_first && near->entry == far->entry);
  if (near->entry >= 0.0 && far->entry >= 0.0 && manner.ordered && exchange) std::swap(near, far);
  if (near->entry >= 0.0) walk(nodes, *near, manner, so_far);
  if (far->entry >= 0.0 && !(manner.near_only && near->entry >= 0.0)) walk(nodes, *far, manner, so_far);
}

Walked walk(const Nodes& nodes, Manner manner = {}) {
  Walked out;
  out.boxes = 1;
  if (nodes[0].entry >= 0.0) walk(nodes, nodes[0], manner, out);
  return out;
}

Right walk_right(Numbers n) {
  const Walked walked = walk(nodes_of(n));
  return {{walked.nearest, n[1], n[2], 0.0}, 1e-3, {}};
}

std::string walk_words(Numbers n) {
  std::string text = "the tree";
  const Nodes nodes = nodes_of(n);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const Node& node = nodes[i];
    text += fmt::format("{} {} (box {}, {})", i == 0 ? "" : ",", i,
                        node.entry < 0.0 ? "missed" : fmt::format("at {:.4g}", node.entry),
                        node.left >= 0.0    ? fmt::format("children {} and {}", node.left, node.right)
                        : node.thing >= 0.0 ? fmt::format("leaf hit at {:.4g}", node.thing)
                                            : "leaf missed");
  }
  return text;
}

std::string walk_value_words(Numbers, const Value& value) {
  std::string boxes;
  for (std::size_t i = 0; i < most_nodes; ++i)
    if ((static_cast<int>(std::clamp(value[1], 0.0, 4095.0)) >> i & 1) != 0) boxes += fmt::format(" {}", i);
  return fmt::format("{} (leaves asked: up to {}; boxes asked or allowed:{})",
                     value[0] == -1.0 ? "no hit" : fmt::format("t = {:.6g}", value[0]), value[2], boxes);
}

struct Ball {
  Vec3 center;
  double radius;
  Aabb box() const { return {center - radius, center + radius}; }
};

/// Adds the tree over the balls as the ray meets it, its root first, and returns the root's number. `skewed`: each node has one
/// leaf, as deep as can be.
double build(Nodes& nodes, std::span<Ball> balls, const Ray& ray, bool skewed) {
  Aabb box;
  for (const Ball& ball : balls) box.grow(ball.box());
  Questions q;
  const std::size_t own = nodes.size();
  nodes.push_back({box_right(q.made(ray.origin, ray.direction, box.min, box.max).numbers).value[0]});
  if (balls.size() == 1) {
    const Ball& ball = balls[0];
    nodes[own].thing =
        sphere_right(q.made(ray.origin, ray.direction, ball.center, ball.radius).numbers).value[0];
  } else {
    const int axis = longest_axis(box.extent());
    std::sort(balls.begin(), balls.end(),
              [&](const Ball& a, const Ball& b) { return a.center[axis] < b.center[axis]; });
    const std::size_t cut = skewed ? 1 : balls.size() / 2;
    const double left = build(nodes, balls.first(cut), ray, skewed);
    nodes[own].left = left;
    nodes[own].right = build(nodes, balls.subspan(cut), ray, skewed);
  }
  return static_cast<double>(own);
}

std::vector<Ball> some_balls(Dice& dice, int count) {
  std::vector<Ball> balls;
  for (int i = 0; i < count; ++i) {
    const Vec3 center = dice.in_cube(1.3);
    balls.push_back({center, dice.between(0.3, 0.8)});
  }
  return balls;
}

/// Adds the tree as the shader gets it. The boxes that a walk comes to may be asked again and again, and those of the root's children in
/// any case; leaves as often as a walk needs. False where boxes that begin at one t leave open what a walk needs.
bool add_tree(Questions& q, const Nodes& nodes, bool any = false) {
  Question question = q.made(static_cast<double>(nodes.size()));
  const Walked left_first = walk(nodes), right_first = walk(nodes, {.right_first = true});
  if (!any && (left_first.leaves != right_first.leaves || left_first.boxes != right_first.boxes))
    return false;
  const int children =
      nodes[0].left < 0.0 ? 0 : 1 << static_cast<int>(nodes[0].left) | 1 << static_cast<int>(nodes[0].right);
  q.append(question, left_first.boxes | right_first.boxes | children,
           std::max(left_first.leaves, right_first.leaves));
  for (const Node& node : nodes) q.append(question, node.entry, node.left, node.right, node.thing);
  question.numbers.resize(walk_numbers);
  q.put(std::move(question));
  return true;
}

std::vector<Question> walk_questions() {
  Questions q;
  Dice dice(11);
  const auto group = [&](std::string_view name, int leaves, const auto& good, bool inside = false,
                         bool skewed = false) {
    q.group(name, 2 * of_each, [&](int i) {
      for (;;) {
        std::vector<Ball> balls = some_balls(dice, leaves);
        const Vec3 to = dice.in_cube(1.3), from = dice.direction();
        Nodes nodes;
        build(nodes, balls, {to + (inside ? 0.0 : 4.0) * from, -from}, skewed);
        if (good(nodes, i) && add_tree(q, nodes)) return;
      }
    });
  };
  const auto is_hit = [](const Nodes& nodes) { return walk(nodes).nearest >= 0.0; };
  group("one", 1, [&](const Nodes& nodes, int i) {
    return is_hit(nodes) == (i % 3 == 0) && (nodes[0].entry < 0.0) == (i % 3 == 2);
  });
  group("two", 2, [&](const Nodes& nodes, int) {
    return is_hit(nodes) && nodes[1].thing >= 0.0 && nodes[2].thing >= 0.0 && walk(nodes).leaves == 2;
  });
  group("order", 5,
        [](const Nodes& nodes, int) { return walk(nodes, {.ordered = false}).leaves > walk(nodes).leaves; });
  group("cut", 6,
        [](const Nodes& nodes, int) { return walk(nodes, {.cuts = false}).leaves > walk(nodes).leaves; });
  group("overlap", 6, [](const Nodes& nodes, int) {
    return walk(nodes, {.ends_early = true}).nearest != walk(nodes).nearest;
  });
  group("stack", 6, [](const Nodes& nodes, int) {
    return walk(nodes, {.near_only = true}).nearest != walk(nodes).nearest;
  });
  group(
      "inside", 5, [](const Nodes& nodes, int) { return nodes[0].entry == 0.0; }, true);
  group("miss", 4, [&](const Nodes& nodes, int i) {
    return !is_hit(nodes) && (walk(nodes).leaves > 0) == (i % 2 == 0);
  });
  group(
      "deep", 6, [](const Nodes& nodes, int) { return walk(nodes).leaves >= 3; }, false, true);
  std::vector<Ball> balls = some_balls(dice, 6);
  add_picture(q, [&](const Vec3& eye, const Vec3& to) {
    Nodes nodes;
    build(nodes, balls, {eye, to}, false);
    add_tree(q, nodes, true);
  });
  return q.take();
}

}  // namespace

Function bvh_walk_function() {
  return {"bvh_walk",
          "float t = bvh_walk(); int leaves = int(case_number(2)); "
          "answer = vec4(t, boxes_asked | int(case_number(1)), leaves_asked > leaves ? leaves_asked : "
          "leaves, 0.0)",
          walk_numbers,
          AnswerKind::several,
          walk_questions,
          walk_right,
          walk_words,
          walk_value_words};
}

}  // namespace gnomon::functions
