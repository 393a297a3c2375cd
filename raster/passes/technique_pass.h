// How a technique draws, and what it draws between the depth map and the shading (moments, blur, lists ...). A new technique
// names its TechniqueDrawing in its row and adds a file to shaders/technique/; the drawing says the rest. Private to raster.
#pragma once

#include <memory>
#include <span>

#include "raster/passes/depth_map_pass.h"
#include "raster/passes/shading_pass.h"

namespace gnomon::raster {

/// One light's turn with its depth map.
struct MapJob {
  const WorldBuffers& world;
  const Light& light;
  const LightView& view;
  const DepthMapPass& map;  ///< drawn already in draw()
  const MapOptions& options;
  /// For a technique that asks for the visibility buffer, which is drawn then.
  const View* camera = nullptr;
  const ShadingPass* camera_pass = nullptr;
  CasterBias caster_bias{};
};

/// What a technique draws between the depth map and the shading; counted and timed as part of the map.
class TechniquePass {
 public:
  TechniquePass() = default;
  TechniquePass(const TechniquePass&) = delete;
  TechniquePass& operator=(const TechniquePass&) = delete;
  virtual ~TechniquePass() = default;
  /// Makes (or keeps) what it needs. Error (graphics): out of memory.
  virtual Expected<void> prepare(const MapJob& job) = 0;
  virtual Expected<void> draw(const MapJob& job) = 0;
  /// It needs the visibility buffer, and no depth map: that is drawn for the records alone.
  virtual bool replaces_map() const { return false; }
  /// Binds what the technique's shader reads besides the depth map.
  virtual void bind_for_lookup() const = 0;
  /// Puts into the map read back what the shader looks up in its place.
  virtual void read(ShadowMap&) const {}
  virtual std::uint64_t texels() const = 0;  ///< drawn by draw()
  virtual std::uint64_t bytes() const = 0;   ///< device memory held
};

/// The first two are functions of the technique's own, or null.
struct TechniqueDrawing {
  /// Which shader turns the map into visibility; null: the hard test.
  TechniqueShader (*shader)(const MapOptions& options, const Light& light) = nullptr;
  /// Null where it looks up nothing but the depth map.
  std::unique_ptr<TechniquePass> (*make_pass)(Gl& gl, ProgramCache& programs) = nullptr;
  /// Stages that the pass begins with, and whether it is they that turn the map into visibility.
  std::span<const std::string_view> stages{};
  bool stages_decide = false;
  bool reads_gap = true;  ///< the visibility comes from light.glsl and gap.glsl, too
  /// Fits the map's faces; null: one window, or a cube about its light. `visible`: as of fit_map().
  Expected<LightView> (*fit)(const World& world, const Light& light, const Camera& camera, double aspect,
                             const MapOptions& options, std::span<const Vec3> visible) = nullptr;
  std::string_view map_define{};  ///< what shaders/light_map.glsl is to know of these faces
  Vec4 (*moments)(const FilterOptions& filter) = nullptr;  ///< LightBlock::moments; null: all 0
};

}  // namespace gnomon::raster
