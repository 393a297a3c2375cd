// The camera's passes. First comes the visibility buffer (which primitive each pixel shows). Then one
// full-screen pass per light works out the receiver, tests its shadow and adds its light (Burns and Hunt
// 2013). Private to raster.
#pragma once

#include <map>
#include <memory>

#include "raster/external_visibility.h"
#include "raster/frame.h"
#include "raster/world/world_buffers.h"

namespace gnomon::raster {

class ShadingPass {
 public:
  ShadingPass(Gl& gl, ProgramCache& programs);

  /// Makes (or keeps) the images: of the whole picture what the camera sees, of some rows what is shaded. Error
  /// (graphics): out of memory.
  Expected<void> prepare(ImageSize size, const PictureRows& rows, bool with_records);
  void set_camera(const WorldBuffers& world, const View& view);
  /// Fills the visibility buffer. A SmallDrawing leaves it to be filled again.
  Expected<void> draw_visibility(const WorldBuffers& world, const View& view);
  /// Whether the visibility buffer holds what draw_visibility() would draw.
  bool shows(const WorldBuffers& world, const View& view) const;
  /// Adds a light to the picture, or with `trial`, to an image that nobody reads (for timing). What it records goes
  /// where the next drawing of a light records.
  Expected<void> draw_light(const WorldBuffers& world, const ShadePermutation& permutation, bool trial);
  /// Does so in some of the rows that are shaded, counted from the first of these.
  Expected<void> draw_light(const WorldBuffers& world, const ShadePermutation& permutation, bool trial,
                            const PictureRows& rows);
  /// What draw_visibility() took for this view, by those who timed it.
  Times& times(const WorldBuffers& world, const View& view);

  void bind_visibility() const;
  /// Returns the size of what is shaded.
  ImageSize size() const { return {size_.width, rows_.count}; }
  const PictureRows& rows() const { return rows_; }
  /// All of them, as draw_light() counts them.
  PictureRows all_rows() const { return {0, rows_.count}; }
  void read_color(ColorImage& out) const;
  /// Reads the positions of everything that the visibility buffer shows, in world space.
  std::vector<Vec3> read_positions(const World& world, const View& view) const;
  void read_primitives(Image<std::uint32_t>& out) const;
  /// What the last light drawn with ShadePermutation::records wrote.
  void read_records(LightRecord& record) const;
  /// The visibility that it wrote.
  void read_drawn_visibility(Image<float>& out) const;

 private:
  Expected<void> prepare_seen(ImageSize size);
  Expected<void> prepare_shaded(ImageSize size, bool with_records);
  /// Where records go, and the light's share of the picture into `radiance`.
  Framebuffer record_target(const Texture2D& radiance) const;
  Expected<void> prepare_trial();
  Expected<void> draw_shapes(const WorldBuffers& world, const View& drawn);

  /// All that the visibility buffer's contents depend on, its size apart.
  struct Seen {
    Vec3 eye, right, up, forward, reference;
    Vec4 extent;  ///< the tangents, and half of an orthographic picture
    bool operator==(const Seen&) const = default;
  };
  static Seen seen_by(const WorldBuffers& world, const View& view);

  Gl* gl_;
  ProgramCache* programs_;
  Buffer camera_block_;
  std::optional<Seen> seen_;   ///< of the whole visibility buffer
  std::optional<Seen> timed_;  ///< what times_ are of
  Times times_;
  ImageSize size_;    ///< of the picture
  PictureRows rows_;  ///< that are shaded
  Texture2D visibility_, solid_distance_, depth_, color_, record_, flags_, drawn_visibility_, trial_color_;
  Framebuffer visibility_target_, color_target_, record_target_, trial_target_, trial_record_target_;
};

// The bridge to a visibility that is worked out outside OpenGL: the visibility buffer read back, the answer
// uploaded. Private to raster.

class ExternalPass {
 public:
  explicit ExternalPass(Gl& gl) : gl_(&gl) {}
  void use(Technique technique, std::shared_ptr<ExternalVisibility> visibility) {
    asked_[technique] = std::move(visibility);
  }
  /// Error (internal): none was given for the technique.
  Expected<void> check(Technique technique) const;

  Expected<void> prepare(const VisibilityRequest& request, bool changed) {
    return asked_.at(request.options.technique)->prepare(request, changed);
  }
  /// After ShadingPass::draw_visibility: the image that the technique's shader reads.
  Expected<void> find(const VisibilityRequest& request, const ShadingPass& shading);
  void bind_for_lookup() const;
  ExternalCosts costs(const VisibilityRequest& request, bool counted) const {
    return asked_.at(request.options.technique)->costs(request, counted);
  }

 private:
  Gl* gl_;
  std::map<Technique, std::shared_ptr<ExternalVisibility>> asked_;
  Image<std::uint32_t> primitive_;
  Image<float> image_;
  Texture2D texture_;
};

}  // namespace gnomon::raster
