// Where the visibility of a light with size can change at all. Seen from one point x, the occluders between x
// and the light's points change only across edges that fold or end a surface on the way. The source is Laine
// et al. 2005, "Soft shadow volumes for ray tracing". Where both triangles of an edge have the whole light on
// the same side, a segment that sweeps over the edge meets one instead of the other. Such edges are left out.
// The others, and triangles that hold more than their outline (alpha-masked, or touching the light), are kept
// in a tree.
#pragma once

#include "hybrid/light_facing.h"
#include "scene/light_shape/light_shape.h"

namespace gnomon::hybrid {

// What a receiver and a light with size have between them: all that can stand in the way.

/// The convex hull of a point (or a ball around it) and the light's ball.
class LightCone {
 public:
  LightCone(const Vec3& point, double point_radius, const LightHull& hull);
  /// The point's ball and the light's lie in one another: there is no cone.
  bool is_everything() const { return everything_; }
  /// Conservative.
  bool may_intersect_ball(const Vec3& center, double radius) const;
  /// `margin`: how far beside the cone still counts.
  bool may_intersect_segment(const Vec3& a, const Vec3& b, double margin) const;

 private:
  double beside(double lateral, double along) const {
    return lateral * cosine_ - along * sine_ - point_radius_;
  }

  Vec3 point_, axis_{0.0};
  double point_radius_, light_radius_, length_ = 0.0, sine_ = 0.0, cosine_ = 1.0;
  bool everything_ = false;
};

class SoftEdges {
 public:
  /// A segment, or with a radius a ball around a that stands for a whole triangle.
  struct Edge {
    Vec3 a, b;
    double radius = 0.0;
    bool may_intersect(const LightCone& cone, double margin) const {
      return radius > 0.0 ? cone.may_intersect_ball(a, radius + margin)
                          : cone.may_intersect_segment(a, b, margin);
    }
  };
  SoftEdges(const World& world, const raytrace::Topology& topology, const LightHull& hull,
            double position_error);

  /// Appends the edges whose boxes the cone may meet.
  void find(const LightCone& cone, std::vector<std::uint32_t>& found) const;
  const Edge& edge(std::uint32_t i) const { return edges_[i]; }
  std::size_t size() const { return edges_.size(); }
  std::uint64_t bytes() const { return edges_.size() * sizeof(Edge) + nodes_.size() * sizeof(Node); }

 private:
  struct Node {  // a ball
    Vec3 center;
    double radius;
    std::uint32_t first, count;  // of its edges
    std::uint32_t second;        // the children of an inner node: the next one and this; 0: a leaf
  };
  std::uint32_t build(std::uint32_t first, std::uint32_t count);

  std::vector<Edge> edges_;
  std::vector<Node> nodes_;
};

}  // namespace gnomon::hybrid
