// The depth map of a capture as the ladder reads maps: the matrices taken apart into a LightView, and the
// texels as stored depths of that view.
#pragma once

#include "judge/capture.h"
#include "judge/captured_test.h"
#include "raster/frame.h"

namespace gnomon::judge {

/// A layer's texels in its picture: rows from the bottom, and mirrored where the matrix was. Places beyond the layer are those
/// of its neighbours.
struct LayerTexels {
  CapturedRect rect;
  RowOrder rows = RowOrder::top_down;
  bool mirrored = false;
  ImageSize picture{};
  std::vector<float> numbers{};  ///< the picture's; kept of an atlas alone

  static constexpr std::size_t none = ~std::size_t{0};  ///< beyond the picture
  std::size_t at(int u, int v) const;
};

struct CapturedMap {
  raster::ShadowMap map;           ///< `primitive` holds no_id all over
  std::vector<LayerTexels> atlas;  ///< by face, where layers are parts of a picture; else empty
  StoredDepth stored = StoredDepth::zero_to_one;
  std::vector<float> captured_numbers;  ///< some of the layers' own, of texels that hold a caster
  double unit_world = 1.0;              ///< where is_linear(stored): world units in one of the stored numbers
  std::vector<CapturedCasterBias> caster_bias;  ///< by face
  std::vector<CapturedBias> bias;               ///< by face
  std::vector<CapturedSelect> select;           ///< by face; empty: the first that holds a place
  std::shared_ptr<CapturedTest> test;           ///< its parts and what it reads; the bias is not yet in it
};

/// Errors (bad input): a matrix that is singular, shears, or is not the light's (its rays run elsewhere).
Expected<void> check_map_matrices(const Capture& capture, const Light& light, const World& world);

/// Reads and checks the layers. Errors (bad input): those of check_map_matrices; a picture that cannot be read, is not
/// square or not of the others' size; values that are not finite, or beyond the convention's range.
Expected<CapturedMap> read_map(const Capture& capture, const Light& light, const World& world);

/// The capture with matrices and lengths of the scene's world in the place of its own; places are not touched.
Capture in_world_of_scene(Capture capture, const Mat3& scene_from_captured);

/// A distance or a depth along the axis, world units, as the view's stored depth; what lies beyond its far plane, and 0, is
/// nothing.
float stored_of_linear(const LightView& view, StoredDepth stored, int face, int u, int v, double value);

/// Returns the world units that a stored number stands for where is_linear(); 0 of the far end of a range, where nothing was drawn.
double linear_world(const std::optional<Vec2>& range, double stored);

/// The face of one matrix (right x up = -forward; `mirrored`: the matrix's x runs the other way), and for a
/// perspective matrix the place it looks from. The reason where it is no orthographic or symmetric
/// perspective projection.
struct MatrixFace {
  LightFace face;
  LightProjection projection = LightProjection::orthographic;
  Vec3 origin{0.0};
  bool mirrored = false;
};
/// The reason why the map of so many faces cannot be this light's: it looks from or along elsewhere.
std::optional<std::string> not_of_light(const MatrixFace& face, std::size_t faces, const Light& light,
                                        const World& world);

tl::expected<MatrixFace, std::string> take_apart(const Mat4& clip_from_world, StoredDepth convention);

}  // namespace gnomon::judge
