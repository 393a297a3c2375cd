// A capture as the rasterizer's frame: what the ladder, the pictures and the page read.
#pragma once

#include "judge/captured_map.h"
#include "judge/receivers.h"
#include "judge/stored_format.h"

namespace gnomon::judge {

/// A renderer's floats place a receiver that far from where doubles do, texels; and the last bits of a depth between 1/2 and 1,
/// with those of the matrix that made it.
inline constexpr double lookup_rounding_texels = 0.02, lookup_rounding_stored = 0x1p-22;

/// What a capture does not say of its map and is found in its numbers and its picture.
struct MapFacts {
  StoredFormat format{};
  std::vector<LayerTexels> atlas{};  ///< CapturedMap::atlas
  /// Receivers that the renderer lights whatever the map holds: those behind the far plane; those whose depth of -1 to 1 lies
  /// below 0.
  bool lights_behind = false, lights_nearer_half = false;
};

struct FrameInput {
  const Capture& capture;
  const CapturedPictures& pictures;
  const World& world;
  const raytrace::Tracer& tracer;
  const Camera& camera;
  const raytrace::RayTracedFrame& traced;
  const Image<std::uint8_t>& elsewhere;  ///< Retraced::elsewhere
  double exposure = 1.0;                 ///< of both pictures
  const MapFacts& facts;
};

/// `map`: the capture's, or none. A pixel that the capture shows otherwise than Gnomon (other surface, nothing,
/// no light without shadows) gets another primitive than the receiver's, so that it is counted as silhouette.
Expected<raster::RasterFrame> make_frame(const FrameInput& input, std::optional<CapturedMap> map);

/// How far a place lies from the camera, world units: along the view's axis, or from the eye.
double from_camera(const View& view, bool by_distance, const Vec3& place);

/// By which distances the capture says that its layers are looked up; empty where it does not.
std::vector<CapturedSelect> captured_selects(const Capture& capture);

/// CapturedTest::faces: which face a pixel looks up; no_face where its distance is no layer's or more than half of its
/// shadow has faded. Empty where neither says anything.
Image<std::uint8_t> looked_up_faces(const FrameInput& input, const std::vector<CapturedSelect>& select,
                                    const std::optional<CapturedFade>& fade);

/// Notes in the options that the map holds back faces in the place of the front faces before them, where it takes that to
/// explain its depths.
void find_culling(const FrameInput& input, raster::RasterFrame& frame);

/// Fills `record`'s gaps from its map and bias, and the other fields that follow from positions alone.
void fill_record(const FrameInput& input, const raster::Bias& bias, raster::LightRecord& record);

}  // namespace gnomon::judge
