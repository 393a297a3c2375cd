// Quadrics, tori and implicit surfaces of a JSON scene. Each has a place ("center", or "base" and "axis") and
// may be rotated about it; lengths are world units.
#include <fmt/core.h>

#include "scene/files/json/json_parts.h"
#include "scene/files/read_file.h"
#include "scene/shapes/solid.h"

namespace gnomon {
namespace {

constexpr NumberRange length_range{0.0, max_coordinate, true};
constexpr NumberRange solid_radius_range{0.0, max_coordinate};

double require_length(const JsonObject& object, std::string_view key,
                      const NumberRange& range = length_range) {
  const auto node = object.require(key);
  return node ? node->as_number(range) : 1.0;
}

/// Columns to within rounding orthonormal, from a product of rotations.
Mat3 orthonormal(const Mat3& m) {
  const Vec3 z = glm::normalize(m[2]), x = glm::normalize(m[0] - glm::dot(m[0], z) * z);
  return {x, glm::cross(z, x), z};
}

/// "center" or "base", "axis" (default: y, up) and "rotate" about the place.
ShapeFrame read_frame(const JsonObject& object, std::string_view place) {
  ShapeFrame frame = frame_along(Vec3(0.0), Vec3(0.0, 1.0, 0.0));
  if (const auto axis = object.find("axis")) frame = frame_along(Vec3(0.0), axis->as_direction());
  if (const auto node = object.require(place)) frame.origin = node->as_vec3();
  if (const auto rotate = object.find("rotate"))
    frame.axes = orthonormal(Mat3(read_rotations(*rotate)) * frame.axes);
  return frame;
}

Quadric read_ellipsoid(const JsonNode& node) {
  const JsonObject object(node, {"center", "radii", "rotate"});
  Vec3 radii(1.0);
  if (const auto list = object.require("radii")) {
    const auto parts = list->as_array(3);
    for (std::size_t a = 0; a < parts.size() && a < 3; ++a)
      radii[static_cast<int>(a)] = parts[a].as_number(length_range);
  }
  // Along the world's axes unless rotated, so that the radii are its sizes in x, y and z.
  ShapeFrame frame;
  if (const auto center = object.require("center")) frame.origin = center->as_vec3();
  if (const auto rotate = object.find("rotate")) frame.axes = orthonormal(Mat3(read_rotations(*rotate)));
  return make_ellipsoid(frame, radii);
}

Quadric read_cylinder(const JsonNode& node) {
  const JsonObject object(node, {"base", "axis", "rotate", "radius", "height", "closed"});
  const ShapeFrame frame = read_frame(object, "base");
  return make_cylinder(frame, require_length(object, "radius"), require_length(object, "height"),
                       object.boolean("closed", true));
}

Quadric read_cone(const JsonNode& node) {
  const JsonObject object(node, {"base", "axis", "rotate", "radius", "top_radius", "height", "closed"});
  const ShapeFrame frame = read_frame(object, "base");
  const double radius = require_length(object, "radius", solid_radius_range);
  const double top = object.number("top_radius", 0.0, solid_radius_range);
  if (!node.errors().first && radius == 0.0 && top == 0.0)
    node.error("the cone has no width (got radius 0 and top_radius 0, allowed one of them > 0)");
  return make_cone(frame, radius, top, require_length(object, "height"), object.boolean("closed", true));
}

Quadric read_paraboloid(const JsonNode& node) {
  const JsonObject object(node, {"base", "axis", "rotate", "radius", "height", "closed"});
  const ShapeFrame frame = read_frame(object, "base");
  return make_paraboloid(frame, require_length(object, "radius"), require_length(object, "height"),
                         object.boolean("closed", true));
}

Quadric read_hyperboloid(const JsonNode& node) {
  const JsonObject object(node, {"center", "axis", "rotate", "radius", "waist", "gap", "height", "closed"});
  const ShapeFrame frame = read_frame(object, "center");
  const double radius = require_length(object, "radius"), height = require_length(object, "height");
  const bool closed = object.boolean("closed", true);
  const std::string_view form = object.exactly_one({"waist", "gap"});
  if (form == "gap")
    return make_two_bowls(frame, radius, require_length(object, "gap", {0.0, height, false, true}), height,
                          closed);
  const double waist = form.empty() ? 0.0 : require_length(object, "waist", {0.0, radius, false, true});
  return make_hyperboloid(frame, radius, waist, height, closed);
}

Torus read_torus(const JsonNode& node) {
  const JsonObject object(node, {"center", "axis", "rotate", "major_radius", "minor_radius"});
  Torus torus;
  torus.frame = read_frame(object, "center");
  torus.major = require_length(object, "major_radius");
  torus.minor = require_length(object, "minor_radius", {0.0, torus.major, true, true});
  return torus;
}

Expression read_function(const JsonNode& node) {
  const std::string text = node.as_string();
  if (node.errors().first) return {};
  auto parsed = parse_expression(text);
  if (parsed) return std::move(*parsed);
  node.error(fmt::format("at character {} of \"{}\": {}", parsed.error().column, printable(text),
                         parsed.error().reason));
  return {};
}

Implicit read_implicit(const JsonNode& node) {
  const JsonObject object(node, {"function", "box", "center", "rotate", "closed"});
  Implicit implicit;
  if (const auto center = object.find("center")) implicit.frame.origin = center->as_vec3();
  if (const auto rotate = object.find("rotate"))
    implicit.frame.axes = orthonormal(Mat3(read_rotations(*rotate)));
  implicit.closed = object.boolean("closed", false);
  if (const auto box = object.require("box")) {
    const auto corners = box->as_array(2);
    if (corners.size() == 2) implicit.box = {corners[0].as_vec3(), corners[1].as_vec3()};
    const Vec3 size = implicit.box.extent();
    if (!node.errors().first && !(size.x > 0.0 && size.y > 0.0 && size.z > 0.0))
      box->error("is empty (needs two corners, the first below the second on every axis)");
  }
  if (const auto function = object.require("function")) {
    implicit.function = read_function(*function);
    implicit.text = function->is(JsonValue::Type::string) ? function->value().text : "";
  }
  return implicit;
}

}  // namespace

ShapeGeometry read_solid(std::string_view kind, const JsonNode& node) {
  if (kind == "ellipsoid") return read_ellipsoid(node);
  if (kind == "cylinder") return read_cylinder(node);
  if (kind == "cone") return read_cone(node);
  if (kind == "paraboloid") return read_paraboloid(node);
  if (kind == "hyperboloid") return read_hyperboloid(node);
  if (kind == "torus") return read_torus(node);
  return read_implicit(node);
}

}  // namespace gnomon
