#include "scene/files/defaults.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "scene/files/made_view.h"
#include "scene/files/material_notes.h"
#include "scene/files/pictures/image_io.h"
#include "scene/files/polygon.h"
#include "scene/files/shadow_variants.h"
#include "scene/shapes/closed_mesh.h"
#include "scene/shapes/solid.h"

namespace gnomon {
namespace {

constexpr double coplanar_share = 1e-6;  // of the diagonal
constexpr double framed_aspect = 4.0 / 3.0;

// Upward and downward areas of the scene's triangles, projected to the ground; and how much of the upward
// area lies flat near the bottom.
struct Footprint {
  double up = 0.0, down = 0.0, floor = 0.0;  // as seen from above and below
  double area = 0.0;                         // of all triangles
  // A triangle that faces up lies in the lowest plane itself; or one that faces down and shows its back.
  bool lowest_faces_up = false, lowest_shows_back = false;
};

Footprint footprint(const Scene& scene, const Aabb& bounds) {
  constexpr double floor_share = 0.1;  // of the height: a floor slab has some thickness
  constexpr double flat = 0.95;        // |n.y| of a horizontal triangle
  const double floor_top = bounds.min.y + floor_share * bounds.extent().y;
  const double lowest = bounds.min.y + coplanar_share * bounds.diagonal();
  const auto add = [&](Footprint& out, const PlacedTriangle& t) {
    const Vec3 n = 0.5 * t.normal();
    (n.y > 0.0 ? out.up : out.down) += std::abs(n.y);
    out.area += glm::length(n);
    const double top = std::max({t.a.y, t.b.y, t.c.y});
    if (top > floor_top || std::abs(n.y) < flat * glm::length(n)) return;
    if (n.y > 0.0) out.floor += n.y;
    if (top > lowest) return;
    (n.y > 0.0 ? out.lowest_faces_up : out.lowest_shows_back) |=
        n.y > 0.0 || shows_back(scene.materials[t.material]);
  };
  return over_placed_triangles(scene, Footprint{}, add, [](Footprint& out, const Footprint& more) {
    out.up += more.up, out.down += more.down, out.floor += more.floor, out.area += more.area;
    out.lowest_faces_up = out.lowest_faces_up || more.lowest_faces_up;
    out.lowest_shows_back = out.lowest_shows_back || more.lowest_shows_back;
  });
}

// Whether a back in the lowest plane is seen from above: a body without openings hides its own, unless it is of glass. Bodies
// of very many triangles take long to look through, and are taken for closed.
bool shows_lowest_back(const Scene& scene, const Aabb& bounds) {
  constexpr std::size_t most_triangles = 200'000;
  const double lowest = bounds.min.y + coplanar_share * bounds.diagonal();
  std::vector<char> closed(scene.meshes.size(), 0);
  for (const MeshInstance& instance : scene.instances) {
    const Mesh& mesh = scene.meshes[instance.mesh];
    if (closed[instance.mesh] != 0 || mesh.triangles.size() > most_triangles) continue;
    bool shown = false, through_glass = false;
    visit_placed(scene, instance, 0, mesh.triangles.size(), [&](const PlacedTriangle& t) {
      const Material& material = scene.materials[t.material];
      if (std::max({t.a.y, t.b.y, t.c.y}) > lowest || !shows_back(material)) return;
      shown = true, through_glass = through_glass || material.transmission > 0.0f;
    });
    if (through_glass || (shown && open_edges(mesh.positions, mesh.triangles) > 0)) return true;
    closed[instance.mesh] = static_cast<char>(shown);
  }
  return false;
}

// A floor covers half of the ground plan near the bottom; an open sheet (a terrain) covers most of it from anywhere, and
// is less steep than 60 degrees in the mean, which a body without a bottom is not.
bool has_own_ground(const Footprint& areas, const Aabb& bounds) {
  const double plan = bounds.extent().x * bounds.extent().z;
  const bool floor = areas.floor > 0.0 && areas.floor >= 0.5 * plan;
  const bool sheet = areas.up >= 0.8 * plan && areas.down <= 0.1 * areas.up && areas.up >= 0.5 * areas.area;
  return floor || sheet;
}

/// Returns what was made, in words.
std::string add_ground(Scene& scene, const Aabb& bounds) {
  const Footprint areas = footprint(scene, bounds);
  if (has_own_ground(areas, bounds)) return {};
  // A visible face in the ground's own plane would fight with it for the same depth.
  const bool fights = areas.lowest_faces_up || (areas.lowest_shows_back && shows_lowest_back(scene, bounds));
  const double drop = fights ? 1e-3 * bounds.diagonal() : 0.0;
  Material material = model_material("ground");
  material.diffuse = Vec3f(0.4f);  // darker than the neutral model, so that this stands out
  const Vec3 center = bounds.center();
  Shape ground{"ground", Plane{{center.x, bounds.min.y - drop, center.z}, {0.0, 1.0, 0.0}},
               static_cast<std::uint32_t>(scene.materials.size())};
  scene.materials.push_back(std::move(material));
  scene.shapes.push_back(std::move(ground));
  return fmt::format("a grey ground at y = {:g}, {} the model's lowest point", bounds.min.y - drop,
                     drop > 0.0 ? "just below" : "touching");
}

/// Returns what was made, in words.
std::string add_sun(Scene& scene, bool is_model) {
  const Light sun = default_sun(scene.camera);
  scene.lights.push_back(sun);
  std::string words = fmt::format("a directional light 'sun' along [{:.3f}, {:.3f}, {:.3f}]", sun.direction.x,
                                  sun.direction.y, sun.direction.z);
  if (!is_model) return words;
  scene.ambient = Vec3f(0.15f);
  scene.background = Vec3f(0.35f, 0.45f, 0.6f);
  return words + ", an ambient light of 0.15, a pale blue background";
}

/// From the sun nothing would come in. As bright as the sun is elsewhere at what is `typical` far away. Returns what was
/// made, in words.
std::string add_lamp(Scene& scene, const Vec3& position, double typical) {
  Light lamp;
  lamp.name = "lamp";
  lamp.type = LightType::point;
  lamp.position = position;
  lamp.intensity = Vec3f(static_cast<float>(std::pow(typical, 2.0)));
  scene.lights.push_back(lamp);
  scene.ambient = Vec3f(0.15f);
  return fmt::format(
      "a point light 'lamp' at [{:.3f}, {:.3f}, {:.3f}], where the sun would not come in, an "
      "ambient light of 0.15",
      position.x, position.y, position.z);
}

bool holds(const Aabb& box, const Vec3& p) {
  return glm::clamp(p, box.min, box.max) == p;
}

}  // namespace

Light default_sun(const Camera& camera) {
  const Vec3 up(0.0, 1.0, 0.0);
  const Vec3 forward = glm::normalize(camera.target - camera.eye);
  Vec3 right = glm::cross(forward, up);
  right = glm::length(right) > 1e-6 ? glm::normalize(right) : Vec3(1.0, 0.0, 0.0);
  const Vec3 back = glm::cross(right, up);  // horizontal, towards the camera
  Light sun;
  sun.name = "sun";
  sun.type = LightType::directional;
  sun.direction = -glm::normalize(-0.6 * right + 1.0 * up + 0.45 * back);
  sun.intensity = Vec3f(1.0f);
  return sun;
}

Aabb scene_bounds(const Scene& scene) {
  return over_points(
      scene, Aabb{}, [](Aabb& bounds, const Vec3& p) { bounds.grow(p); },
      [](Aabb& bounds, const Aabb& more) { bounds.grow(more); });
}

// Glass needs an inside: an index of refraction on one side of it. A thin sheet has none. Said once for each mesh.
void note_open_glass(Scene& scene) {
  const auto is_glass = [&](std::uint32_t material) {
    const Material& m = scene.materials[material];
    return m.transmission > 0.0f && !m.thin;
  };
  std::vector<char> told(scene.meshes.size(), 0);
  for (const MeshInstance& instance : scene.instances) {
    const Mesh& mesh = scene.meshes[instance.mesh];
    const bool glass = mesh.triangle_materials.empty() ? is_glass(instance.material)
                                                       : std::any_of(mesh.triangle_materials.begin(),
                                                                     mesh.triangle_materials.end(), is_glass);
    if (!glass || told[instance.mesh]) continue;
    told[instance.mesh] = 1;
    if (const std::uint64_t open = open_edges(mesh.positions, mesh.triangles); open > 0)
      scene.notes.push_back(
          fmt::format("The glass mesh '{}' is not closed ({} open edge{}): it has no inside to refract in.",
                      mesh.name, open, open == 1 ? "" : "s"));
  }
  for (const Shape& shape : scene.shapes)
    if (is_solid(shape.geometry) && !is_closed(shape.geometry) && is_glass(shape.material))
      scene.notes.push_back(
          fmt::format("The glass shape '{}' is open: it has no inside to refract in.", shape.name));
}

namespace {

/// Glowing surfaces are seen, and are no lights.
void note_emission(Scene& scene) {
  const auto glows = [&](std::uint32_t m) { return scene.materials[m].emission != Vec3f(0.0f); };
  std::vector<char> used(scene.materials.size(), 0);
  for (const MeshInstance& instance : scene.instances) {
    const Mesh& mesh = scene.meshes[instance.mesh];
    if (mesh.triangle_materials.empty()) used[instance.material] = 1;
    for (const std::uint32_t material : mesh.triangle_materials) used[material] = 1;
  }
  for (const Shape& shape : scene.shapes) used[shape.material] = 1;
  std::vector<std::string> names;
  for (std::uint32_t m = 0; m < scene.materials.size(); ++m)
    if (used[m] != 0 && glows(m)) names.push_back(scene.materials[m].name);
  if (names.empty()) return;
  const char* gathered = scene.indirect_samples > 0
                             ? "only the indirect light of the ray-traced picture gathers it"
                             : "nothing is lit by it";
  scene.notes.push_back(fmt::format("Emission is seen and casts no shadows: {} (material{} {}).", gathered,
                                    names.size() > 1 ? "s" : "", some_of(names)));
}

/// Shadows of such a light darken nothing, and are compared all the same.
void note_dark_lights(Scene& scene) {
  std::vector<std::string> names;
  for (const Light& light : scene.lights)
    if (light.intensity == Vec3f(0.0f)) names.push_back(light.name);
  if (names.empty()) return;
  scene.notes.push_back(fmt::format("{} no intensity: shadows are compared that no picture shows ({}).",
                                    names.size() > 1 ? "Lights have" : "A light has", some_of(names)));
}

/// The scene's bounds; of planes alone something like a room at the first one.
Aabb bounds_to_frame(const Scene& scene) {
  Aabb bounds = scene_bounds(scene);
  if (!bounds.empty()) return bounds;
  const Vec3 point = scene.shapes.empty() ? Vec3(0.0) : std::get<Plane>(scene.shapes.front().geometry).point;
  bounds.grow(point - Vec3(2.0));
  bounds.grow(point + Vec3(2.0));
  return bounds;
}

/// `why`: LoadedFile::why_none.
std::string made_note(const std::vector<std::string>& made, const std::string& why) {
  return fmt::format("Made, as {}: {}.", why, fmt::join(made, ", "));
}

/// Makes up what a scene lacks, from where its parts lie.
class Maker {
 public:
  Maker(Scene& scene, double aspect)
      : scene_(scene), aspect_(aspect), bounds_(bounds_to_frame(scene)), parts_(scene) {
    room_ = find_interior(scene, parts_, bounds_);
  }

  void add_camera() {
    if (room_) {
      scene_.camera = room_->camera;
      looked_at_ = room_->contents;
    } else {
      MadeView view = find_view(scene_, parts_, bounds_, aspect_);
      scene_.camera = view.camera;
      looked_at_ = std::move(view.looked_at);
      in_shell_ = view.in_shell;
    }
    const Vec3& eye = scene_.camera.eye;
    made_.push_back(fmt::format("a camera at [{:.3f}, {:.3f}, {:.3f}]{}", eye.x, eye.y, eye.z, where()));
  }

  void add_light(bool is_model) {
    if (const auto lamp = find_lamp()) {
      made_.push_back(add_lamp(scene_, *lamp, typical_distance(*lamp)));
      return;
    }
    made_.push_back(add_sun(scene_, is_model));
    if (!is_model) return;
    if (std::string ground = add_ground(scene_, bounds_); !ground.empty()) made_.push_back(std::move(ground));
  }

  void add_note(bool with_camera, const std::string& why) {
    std::string note = made_note(made_, why);
    if (with_camera) note += " " + casting_words();
    scene_.notes.push_back(std::move(note));
  }

 private:
  std::string where() const {
    if (room_) return room_->open != Vec3(0.0) ? " before the open side of a room" : " inside a closed room";
    return in_shell_ ? " inside of what is closed around the rest" : "";
  }

  /// Whether the camera is in the room, or looks into it.
  bool looks_into_room() const {
    if (!room_ || holds(bounds_, scene_.camera.eye)) return room_.has_value();
    const double out = glm::dot(scene_.camera.eye - bounds_.center(), room_->open);
    return out > 0.5 * glm::dot(bounds_.extent(), glm::abs(room_->open));
  }

  /// The room's, or one beside what is looked at where the sun does not reach that; none where it does.
  std::optional<Vec3> find_lamp() const {
    if (looks_into_room()) return room_->lamp;
    if (!in_shell_) return std::nullopt;
    const Light sun = default_sun(scene_.camera);
    return glm::mix(scene_.camera.target, scene_.camera.eye, 0.7) -
           0.5 * glm::distance(scene_.camera.eye, scene_.camera.target) * sun.direction;
  }
  double typical_distance(const Vec3& lamp) const {
    constexpr double of_walls = 0.35;  // of the diagonal
    return in_shell_ ? glm::distance(lamp, scene_.camera.target) : of_walls * bounds_.diagonal();
  }

  /// Nothing casts on anything where all lies in one plane.
  bool is_one_plane() const {
    const Vec3 e = scene_bounds(scene_).extent();
    const bool flat = std::min({e.x, e.y, e.z}) <= coplanar_share * bounds_.diagonal();
    return flat && std::none_of(scene_.shapes.begin(), scene_.shapes.end(), [](const Shape& shape) {
             return std::holds_alternative<Plane>(shape.geometry);
           });
  }

  std::string casting_words() const {
    if (is_one_plane()) return "Nothing that the picture shows casts a shadow.";
    Sketch sketch(make_view(scene_.camera, sketch_size));
    sketch.draw(scene_, parts_, true, false, [](std::uint32_t) { return true; });
    const double share =
        sketch.share([&](std::uint32_t part) { return looked_at_[part] != 0 && parts_.all()[part].casts; });
    if (share == 0.0) return "Nothing that the picture shows casts a shadow.";
    return fmt::format("What casts shadows fills {:.2g} % of the picture.", 100.0 * share);
  }

  Scene& scene_;
  double aspect_;
  Aabb bounds_;
  SceneParts parts_;
  std::optional<Interior> room_;
  std::vector<char> looked_at_;
  bool in_shell_ = false;
  std::vector<std::string> made_;
};

}  // namespace

Scene add_defaults(LoadedFile loaded) {
  Scene& scene = loaded.scene;
  const bool needs_light = scene.lights.empty();
  const bool needs_surroundings = loaded.is_model && needs_light;
  if (!loaded.has_camera || needs_surroundings) {
    Maker maker(scene, framed_aspect);
    if (!loaded.has_camera) maker.add_camera();
    if (needs_light) maker.add_light(loaded.is_model);
    maker.add_note(!loaded.has_camera, needs_light ? loaded.why_none : LoadedFile{}.why_none);
  } else if (needs_light) {
    scene.notes.push_back(made_note({add_sun(scene, loaded.is_model)}, loaded.why_none));
  }
  if (scene.materials.empty()) scene.materials.push_back(model_material("default"));
  note_open_glass(scene);
  note_emission(scene);
  note_shadow_flags(scene);
  note_dark_lights(scene);
  return std::move(scene);
}

Material model_material(std::string name, bool has_colors) {
  Material material;
  material.name = std::move(name);
  material.diffuse = Vec3f(has_colors ? 1.0f : 0.7f);
  return material;
}

Vec4f linear_color(const Vec3f& srgb, float alpha) {
  const auto linear = [](float v) { return linear_from_srgb(std::clamp(v, 0.0f, 1.0f)); };
  return {linear(srgb.x), linear(srgb.y), linear(srgb.z), std::clamp(alpha, 0.0f, 1.0f)};
}

}  // namespace gnomon
