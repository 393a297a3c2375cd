// What a technique draws between the depth map and the shading (moments, blur, lists ...). A new technique
// adds a case to technique_shader(), a file to shaders/technique/ and, if it needs one, a TechniquePass.
// Private to raster.
#pragma once

#include <memory>

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

/// Null for a technique that looks up nothing but the depth map.
std::unique_ptr<TechniquePass> make_technique_pass(Gl& gl, ProgramCache& programs, Technique technique);

}  // namespace gnomon::raster
