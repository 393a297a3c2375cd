// The typed programs: what each draw call needs to know, so that no caller sees a uniform's name or location.
// Permutations are chosen by the effect plan and the technique. Private to raster.
#pragma once

#include <array>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "raster/options.h"
#include "raster/programs/expression_glsl.h"
#include "raster/programs/gl_program.h"
#include "raster/world/shape_bounds.h"
#include "scene/effects.h"
#include "scene/light_map/light_view.h"
#include "scene/world.h"

namespace gnomon::raster {

// Which shader of shaders/technique/ turns the map into visibility, and how it is specialised. Private to
// raster.

/// How shade.frag is specialised: no branch on the technique remains in it.
struct TechniqueShader {
  std::string name = "hard";         ///< of the file in shaders/technique/, without .glsl
  std::vector<std::string> defines;  ///< "NAME" or "NAME value"
  auto operator<=>(const TechniqueShader&) const = default;
};
/// "NAME value"
std::string define(const char* name, int value);
TechniqueShader technique_shader(const MapOptions& options, const Light& light);
/// What moments.frag is specialised by.
std::vector<std::string> moment_shader(const MapOptions& options, const Light& light, const LightView& view);

/// The define that holds the text of a range of implicit functions; empty for none.
std::string functions_define(const FunctionTable& table, std::size_t first, std::size_t count,
                             std::initializer_list<FunctionForm> forms);

/// The effects that change shader text.
struct SceneFeatures {
  bool textures = false, alpha_mask = false, specular = false, emission = false, smooth_normals = false;
  bool vertex_colors = false, unlit = false, single_sided = false;
  bool non_casters = false, non_receivers = false;
  bool quadrics = false, tori = false;
  bool instances = false;     ///< some parts of the world are kept instances
  FunctionTable functions{};  ///< of the implicit surfaces
  bool solids() const { return quadrics || tori || !functions.functions.empty(); }
};
SceneFeatures scene_features(const EffectPlan& plan, const World& world);

/// What a map's casters are moved by (Bias).
struct CasterBias {
  double constant_world = 0.0, slope = 0.0;
  double texel_world =
      0.0;  ///< where the constant is a multiple of each texel's own width, what it is for; else 0
  bool moves_casters() const { return constant_world != 0.0 || slope != 0.0; }
};

/// Triangles into the depth and, with `primitive_ids`, into the camera's image of primitive ids.
class TriangleProgram : public Program {
 public:
  struct Permutation {
    bool primitive_ids = false;
    bool alpha_mask = false;
    bool textures = false;                ///< of the alpha mask
    bool vertex_colors = false;           ///< of the alpha mask
    bool peel = false, reversed = false;  ///< only what lies behind a map's first layer
    bool caster_bias = false, perspective = false, warp = false;  ///< into a map whose casters have a bias
    bool instances = false, kept = false;  ///< the world has kept parts; this draws such a one
    auto operator<=>(const Permutation&) const = default;
  };
  static Expected<TriangleProgram> link(const Gl& gl, const Permutation& permutation);
  void set_clip_from_relative(const Mat4& matrix) const;
  /// The primitive id of the next draw call's first triangle.
  void set_first_primitive(std::uint32_t primitive) const;
  /// Sets, for a program of kept parts, where the next one lies, and the reference point.
  void set_part(const Mat4& world_from_object) const;
  void set_reference(const Vec3& reference) const;
  /// Sets, for a program that peels, the face of the first layer, and a step of its number format.
  void set_peel(int face, float step) const;
  /// Sets, for a program with the casters' bias, that bias and the face that is drawn.
  void set_caster_bias(const CasterBias& bias, int face) const;

 private:
  bool reads_primitive_ = false;
};

/// A pass's programs: [masked][kept]; those that the scene does not call for are null.
struct TrianglePrograms {
  std::array<std::array<const TriangleProgram*, 2>, 2> of{};
  /// Sets on all of them what TriangleProgram::set_peel does.
  void set_peel(int face, float step) const;
  void set_caster_bias(const CasterBias& bias, int face) const;
};

/// What an impostor program draws.
enum class ImpostorKind : std::uint8_t { sphere, plane, quadric, torus, implicit };
ImpostorKind impostor_kind(const Shape& shape);

/// One shape, ray-cast inside its bounding rectangle.
class ImpostorProgram : public Program {
 public:
  struct Permutation {
    bool camera = false;  ///< else a light's map
    ImpostorKind kind = ImpostorKind::plane;
    std::uint32_t function = 0;  ///< of an implicit surface
    bool perspective = false;
    bool warp = false, reversed = false;  ///< of a map (light_map.glsl)
    bool peel = false;                    ///< only what lies behind a map's first layer
    bool caster_bias = false;             ///< of a map
    bool alpha_mask = false;
    bool textures = false;
    auto operator<=>(const Permutation&) const = default;
  };
  static Expected<ImpostorProgram> link(const Gl& gl, const Permutation& permutation,
                                        const FunctionTable& functions);
  /// `in_frame`: see shape_in_frame().
  void set_shape(int index, const ClipRectangle& rectangle, const Vec4& in_frame) const;
  /// Sets the matrix of a solid; see solid_from_frame().
  void set_solid(const Mat4& solid_from_frame) const;
  /// Sets the face of a map.
  void set_face(int face, Cull cull) const;
  void set_peel(int face, float step) const;
  void set_caster_bias(const CasterBias& bias, int face) const;
};

/// One light's share of the picture.
struct ShadePermutation {
  bool no_light = false;
  bool first_light = false;
  bool records = false;
  LightType light = LightType::directional;
  bool slope_bias = false, normal_offset = false, receiver_plane = false;
  TechniqueShader technique{};
  auto operator<=>(const ShadePermutation&) const = default;
};
Expected<Program> link_shade_program(const Gl& gl, const ShadePermutation& permutation,
                                     const SceneFeatures& features);

/// Every permutation that was asked for so far, linked once.
class ProgramCache {
 public:
  ProgramCache(const Gl& gl, const SceneFeatures& features) : gl_(&gl), features_(features) {}
  const SceneFeatures& features() const { return features_; }
  /// For opaque and masked triangles, of flattened parts and of kept ones; `textures`, `alpha_mask`, `instances` and
  /// `kept` of the permutation are filled in here.
  Expected<TrianglePrograms> triangles(TriangleProgram::Permutation permutation);
  /// For the world's i-th shape; `textures`, `alpha_mask`, `kind` and `function` of the permutation are filled in here.
  Expected<const ImpostorProgram*> impostor(const World& world, std::size_t shape,
                                            ImpostorProgram::Permutation permutation);
  Expected<const Program*> shade(const ShadePermutation& permutation);
  /// A fragment shader over the whole viewport.
  Expected<const Program*> fullscreen(const std::string& fragment, const std::vector<std::string>& defines);
  /// What reads one of these files is linked anew when it is next asked for.
  void forget(const std::set<std::string>& files);

 private:
  const Gl* gl_;
  SceneFeatures features_;
  std::map<TriangleProgram::Permutation, TriangleProgram> triangles_;
  std::map<ImpostorProgram::Permutation, ImpostorProgram> impostors_;
  std::map<ShadePermutation, Program> shades_;
  std::map<std::pair<std::string, std::vector<std::string>>, Program> fullscreens_;
};

}  // namespace gnomon::raster
