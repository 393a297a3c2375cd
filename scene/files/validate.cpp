#include "scene/files/validate.h"

#include <fmt/core.h>

#include <algorithm>

#include "scene/base/parallel.h"
#include "scene/shapes/solid.h"

namespace gnomon {
namespace {

using Defect = std::optional<Error>;

Defect defect(std::string field, std::string reason) {
  Error error{ErrorKind::bad_input, std::move(reason)};
  error.field = std::move(field);
  return error;
}

bool coordinate(double v) {
  return std::abs(v) <= max_coordinate;
}  // false for NaN
bool coordinates(const Vec3& v) {
  return coordinate(v.x) && coordinate(v.y) && coordinate(v.z);
}
bool finite(const Vec3f& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}
bool radiance(const Vec3f& v) {
  return finite(v) && v.x >= 0.0f && v.y >= 0.0f && v.z >= 0.0f;
}
bool fraction(float v) {
  return v >= 0.0f && v <= 1.0f;
}
bool is_unit(const Vec3& v) {
  return std::abs(glm::length(v) - 1.0) < 1e-9;
}

Defect position_defect(std::string field, const Vec3& v) {
  return defect(std::move(field),
                fmt::format("position (got [{:g}, {:g}, {:g}], allowed up to {:g} in magnitude)", v.x, v.y,
                            v.z, max_coordinate));
}

Defect mesh_defect(const Mesh& mesh, const std::string& path, std::size_t materials) {
  const std::size_t count = mesh.positions.size();
  const auto first_bad = [](const auto& values, const auto& is_good) {
    return first_where(values.size(), [&](std::size_t i) { return !is_good(values[i]); });
  };
  if (const std::size_t i = first_bad(mesh.positions, coordinates); i < count)
    return position_defect(fmt::format("{}.positions[{}]", path, i), mesh.positions[i]);
  if (!mesh.normals.empty() && mesh.normals.size() != count)
    return defect(path + ".normals",
                  fmt::format("one per vertex is needed (got {}, allowed {})", mesh.normals.size(), count));
  if (!mesh.uvs.empty() && mesh.uvs.size() != count)
    return defect(path + ".uvs",
                  fmt::format("one per vertex is needed (got {}, allowed {})", mesh.uvs.size(), count));
  if (!mesh.colors.empty() && mesh.colors.size() != count)
    return defect(path + ".colors",
                  fmt::format("one per vertex is needed (got {}, allowed {})", mesh.colors.size(), count));
  const auto is_color = [](const Vec4f& c) { return radiance(Vec3f(c)) && fraction(c.a); };
  if (const std::size_t i = first_bad(mesh.colors, is_color); i < mesh.colors.size())
    return defect(fmt::format("{}.colors[{}]", path, i), "is not finite and >= 0 with an alpha of 0 to 1");
  if (const std::size_t i = first_bad(mesh.normals, finite); i < mesh.normals.size())
    return defect(fmt::format("{}.normals[{}]", path, i), "is not finite");
  const auto is_uv = [](const Vec2f& uv) { return std::isfinite(uv.x) && std::isfinite(uv.y); };
  if (const std::size_t i = first_bad(mesh.uvs, is_uv); i < mesh.uvs.size())
    return defect(fmt::format("{}.uvs[{}]", path, i), "is not finite");
  const auto is_triangle = [&](const std::array<std::uint32_t, 3>& t) {
    return t[0] < count && t[1] < count && t[2] < count;
  };
  if (const std::size_t i = first_bad(mesh.triangles, is_triangle); i < mesh.triangles.size()) {
    const auto& t = mesh.triangles[i];
    const auto index = *std::find_if(t.begin(), t.end(), [&](std::uint32_t v) { return v >= count; });
    return defect(fmt::format("{}.triangles[{}]", path, i),
                  fmt::format("vertex index out of range (got {}, allowed 0 to {})", index,
                              static_cast<std::int64_t>(count) - 1));
  }
  const auto& of_triangles = mesh.triangle_materials;
  if (!of_triangles.empty() && of_triangles.size() != mesh.triangles.size())
    return defect(path + ".triangle_materials", "one per triangle is needed");
  if (first_bad(of_triangles, [&](std::uint32_t m) { return m < materials; }) < of_triangles.size())
    return defect(path + ".triangle_materials", "material index out of range");
  return std::nullopt;
}

Defect material_defect(const Material& m, const std::string& path, std::size_t textures) {
  const auto bad = [&](std::string_view key, std::string_view allowed) {
    return defect(fmt::format("{}.{}", path, key), fmt::format("out of range (allowed {})", allowed));
  };
  if (!radiance(m.diffuse)) return bad("diffuse", "finite, >= 0");
  if (!radiance(m.specular)) return bad("specular", "finite, >= 0");
  if (!radiance(m.emission)) return bad("emission", "finite, >= 0");
  if (!radiance(m.absorption)) return bad("absorption", "finite, >= 0");
  if (!(m.shininess > 0.0f) || !std::isfinite(m.shininess)) return bad("shininess", "> 0");
  if (!(m.ior > 0.0f) || !std::isfinite(m.ior)) return bad("ior", "> 0");
  if (!fraction(m.mirror)) return bad("mirror", "0 to 1");
  if (!fraction(m.transmission)) return bad("transmission", "0 to 1");
  if (!fraction(m.roughness)) return bad("roughness", "0 to 1");
  if (!fraction(m.alpha)) return bad("alpha", "0 to 1");
  if (!(m.alpha_cutoff >= 0.0f)) return bad("alpha_cutoff", ">= 0");
  const auto sound = [&](std::uint32_t texture, const TextureTransform& t) {
    return (texture == no_id || texture < textures) && std::isfinite(t.offset.x) &&
           std::isfinite(t.offset.y) && std::isfinite(t.scale.x) && std::isfinite(t.scale.y) &&
           std::isfinite(t.rotation);
  };
  if (!sound(m.diffuse_texture, m.texture_transform))
    return bad("texture", "an existing texture with a finite transform");
  if (!sound(m.emission_texture, m.emission_transform))
    return bad("emission_texture", "an existing texture with a finite transform");
  return std::nullopt;
}

/// Triangles and vertices of the world, where instances lie one behind the other, have numbers of 32 bits.
Defect count_defect(const Scene& scene) {
  std::uint64_t triangles = scene.shapes.size(), vertices = 0;
  for (const MeshInstance& instance : scene.instances) {
    triangles += scene.meshes[instance.mesh].triangles.size();
    vertices += scene.meshes[instance.mesh].positions.size();
  }
  constexpr std::uint64_t most = no_id - 1;
  if (triangles <= most && vertices <= most) return std::nullopt;
  return defect("instances",
                fmt::format("are too many in all (got {} primitives with {} vertices, allowed {} "
                            "of each)",
                            triangles, vertices, most));
}

Defect instance_defect(const Scene& scene, const MeshInstance& instance, const std::string& path) {
  if (instance.mesh >= scene.meshes.size()) return defect(path + ".mesh", "there is no such mesh");
  const Mesh& mesh = scene.meshes[instance.mesh];
  if (mesh.triangle_materials.empty() && instance.material >= scene.materials.size())
    return defect(path + ".material", "there is no such material");
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row)
      if (!coordinate(instance.world_from_object[column][row]))
        return defect(path + ".matrix",
                      fmt::format("is not finite or above {:g} in magnitude", max_coordinate));
  if (is_singular(Mat3(instance.world_from_object)))
    return defect(path + ".matrix", "is singular: it flattens the mesh");
  const auto placed = [&](std::size_t i) {
    return Vec3(instance.world_from_object * Vec4(mesh.positions[i], 1.0));
  };
  const std::size_t count = mesh.positions.size();
  if (const std::size_t i = first_where(count, [&](std::size_t v) { return !coordinates(placed(v)); });
      i < count)
    return position_defect(path, placed(i));
  return std::nullopt;
}

// The readers and makers see to the rest.
Defect solid_defect(const ShapeGeometry& solid, const std::string& path) {
  const Aabb box = world_box(solid);
  if (!coordinates(box.min)) return position_defect(path, box.min);
  if (!coordinates(box.max)) return position_defect(path, box.max);
  const Vec3 size = local_box(solid).extent();
  if (!(size.x > 0.0 && size.y > 0.0 && size.z > 0.0)) return defect(path, "has no size");
  if (const auto* implicit = std::get_if<Implicit>(&solid))
    if (implicit->function.steps.empty()) return defect(path + ".function", "is empty");
  return std::nullopt;
}

Defect shape_defect(const Shape& shape, const std::string& path, std::size_t materials) {
  if (shape.material >= materials) return defect(path + ".material", "there is no such material");
  if (const auto* sphere = std::get_if<Sphere>(&shape.geometry)) {
    if (!coordinates(sphere->center)) return position_defect(path + ".sphere.center", sphere->center);
    if (!(sphere->radius > 0.0) || !coordinate(sphere->radius))
      return defect(path + ".sphere.radius", "out of range (allowed > 0)");
    return std::nullopt;
  }
  if (is_solid(shape.geometry)) return solid_defect(shape.geometry, path);
  const Plane& plane = std::get<Plane>(shape.geometry);
  if (!coordinates(plane.point)) return position_defect(path + ".plane.point", plane.point);
  if (!is_unit(plane.normal)) return defect(path + ".plane.normal", "is not of unit length");
  return std::nullopt;
}

Defect extent_defect(const Light& light, const std::string& path) {
  const auto bad = [&](std::string_view key, std::string_view allowed) {
    return defect(fmt::format("{}.{}", path, key), fmt::format("out of range (allowed {})", allowed));
  };
  if (light.shadow_samples < 1 || light.shadow_samples > max_shadow_samples)
    return bad("shadow_samples", fmt::format("1 to {}", max_shadow_samples));
  const bool directional = light.type == LightType::directional;
  if (!std::holds_alternative<PointShape>(light.extent) && is_sun_shape(light.extent) != directional)
    return defect(path, "a sun's disc is for directional lights, and they have no other extent");
  LightExtent shape = light.extent;
  for (const ShapeMeasure& measure : shape_measures(shape)) {
    const std::string key =
        directional ? std::string(measure.key) : fmt::format("{}.{}", shape_name(shape), measure.key);
    switch (measure.kind) {
      case ShapeMeasure::Kind::angle:
        if (!(*measure.number >= 0.0 && *measure.number <= 0.5 * pi)) return bad(key, "0 to 90 degrees");
        break;
      case ShapeMeasure::Kind::length:
        if (!(*measure.number >= 0.0 && coordinate(*measure.number))) return bad(key, ">= 0");
        break;
      case ShapeMeasure::Kind::normal:
        if (!is_unit(*measure.vector)) return bad(key, "unit length");
        break;
      case ShapeMeasure::Kind::side:
        if (!coordinates(*measure.vector)) return bad(key, "finite sides");
        break;
    }
  }
  return std::nullopt;
}

Defect light_defect(const Light& light, const std::string& path) {
  if (!radiance(light.intensity)) return defect(path + ".intensity", "out of range (allowed finite, >= 0)");
  if (light.type != LightType::directional && !coordinates(light.position))
    return position_defect(path + ".position", light.position);
  if (light.type != LightType::point && !is_unit(light.direction))
    return defect(path + ".direction", "is not of unit length");
  const bool cone =
      light.inner_angle >= 0.0 && light.inner_angle < light.outer_angle && light.outer_angle < 0.5 * pi;
  if (light.type == LightType::spot && !cone)
    return defect(
        path + ".outer_angle",
        fmt::format("half-angles of the cone (got {:g} and {:g} degrees, allowed 0 <= inner < outer < 90)",
                    light.inner_angle * 180.0 / pi, light.outer_angle * 180.0 / pi));
  return extent_defect(light, path);
}

}  // namespace

bool is_singular(const Mat3& matrix) {
  // Against the volume that columns of these lengths could span, so that a small scale is not called
  // singular.
  const double volume = glm::length(matrix[0]) * glm::length(matrix[1]) * glm::length(matrix[2]);
  constexpr double flattest = 1e-12;
  return !(volume > 0.0) || !(std::abs(glm::determinant(matrix)) > flattest * volume);
}

std::optional<Error> find_camera_defect(const Camera& camera) {
  if (!coordinates(camera.eye)) return position_defect("camera.eye", camera.eye);
  if (!coordinates(camera.target)) return position_defect("camera.target", camera.target);
  if (!coordinates(camera.up)) return position_defect("camera.up", camera.up);
  if (camera.eye == camera.target)
    return defect("camera.target", "is the eye itself (allowed: another point)");
  if (camera.up == Vec3(0.0))
    return defect("camera.up", "has no direction (got [0, 0, 0], allowed a vector that is not zero)");
  const Vec3 forward = glm::normalize(camera.target - camera.eye);
  constexpr double narrowest = 1e-6;  // radians between up and the view: below, the frame is mostly rounding
  if (!(glm::length(glm::cross(forward, glm::normalize(camera.up))) > narrowest))
    return defect("camera.up", "is parallel to the view direction (allowed: across it)");
  if (!(camera.vertical_fov > 0.0) || !(camera.vertical_fov < pi))
    return defect("camera.vertical_fov",
                  fmt::format("out of range (got {:g} degrees, allowed 0 to 180, both excluded)",
                              camera.vertical_fov * 180.0 / pi));
  if (!(camera.orthographic_height >= 0.0) || !(camera.orthographic_height <= 1e12))
    return defect(
        "camera.orthographic_height",
        fmt::format("out of range (got {:g}, allowed above 0, to 1e12)", camera.orthographic_height));
  return std::nullopt;
}

std::optional<Error> find_geometry_defect(const Scene& scene) {
  for (std::size_t i = 0; i < scene.materials.size(); ++i)
    if (auto found =
            material_defect(scene.materials[i], fmt::format("materials[{}]", i), scene.textures.size()))
      return found;
  for (std::size_t i = 0; i < scene.textures.size(); ++i)
    if (scene.textures[i].texels.empty() ||
        scene.textures[i].texels.size() != scene.textures[i].size.pixels())
      return defect(fmt::format("textures[{}]", i), "has no texels");
  for (std::size_t i = 0; i < scene.meshes.size(); ++i)
    if (auto found = mesh_defect(scene.meshes[i], fmt::format("meshes[{}]", i), scene.materials.size()))
      return found;
  for (std::size_t i = 0; i < scene.instances.size(); ++i)
    if (auto found = instance_defect(scene, scene.instances[i], fmt::format("instances[{}]", i)))
      return found;
  for (std::size_t i = 0; i < scene.shapes.size(); ++i)
    if (auto found = shape_defect(scene.shapes[i], fmt::format("shapes[{}]", i), scene.materials.size()))
      return found;
  return count_defect(scene);
}

std::optional<Error> find_setting_defect(const Scene& scene) {
  for (std::size_t i = 0; i < scene.materials.size(); ++i)
    if (auto found =
            material_defect(scene.materials[i], fmt::format("materials[{}]", i), scene.textures.size()))
      return found;
  for (std::size_t i = 0; i < scene.shapes.size(); ++i)
    if (auto found = shape_defect(scene.shapes[i], fmt::format("shapes[{}]", i), scene.materials.size()))
      return found;
  if (auto found = find_camera_defect(scene.camera)) return found;
  if (scene.lights.empty()) return defect("lights", "there is none (allowed: at least one)");
  if (scene.materials.empty()) return defect("materials", "there is none (allowed: at least one)");
  for (std::size_t i = 0; i < scene.lights.size(); ++i)
    if (auto found = light_defect(scene.lights[i], fmt::format("lights[{}]", i))) return found;
  if (!radiance(scene.ambient)) return defect("ambient", "out of range (allowed finite, >= 0)");
  if (!radiance(scene.background)) return defect("background", "out of range (allowed finite, >= 0)");
  return std::nullopt;
}

}  // namespace gnomon
