// The pictures of a film of shadows, for its page and its files. All show what the first frame's camera sees, so that
// nothing moves but the shadows.
#pragma once

#include "scene/files/pictures/apng.h"
#include "studies/shimmer/shimmer.h"

namespace gnomon::studies {

/// The colour of a flip by its label: that of the still label which stands for the step.
glm::u8vec3 flip_colour(std::size_t label, compare::Ladder ladder);

/// What the first frame's camera sees with no shadow at all, as films are drawn on. The scene's camera is moved there
/// and back.
Expected<Rgb8Image> unshadowed_picture(Scene& scene, raster::Renderer& renderer,
                                       const ShimmerOptions& options);

/// A pixel of a film: the unshadowed picture, darkened where visibility is less than 1.
glm::u8vec3 film_colour(const glm::u8vec3& unshadowed, float visibility);

struct FilmOfLight {
  /// By frame, PNG. seen: red V6, green V0, 0 … 255; blue, from the lowest bit: V1 … V5 (more than one half), counted,
  /// outside the map. flips: the label + 1 in red, 0 where none, of the step that led to the frame.
  std::vector<std::string> seen, flips;
  AnimatedPng drawn, truth, flipped;
};

class FilmRecorder {
 public:
  FilmRecorder(Rgb8Image unshadowed, double fps) : base_(std::move(unshadowed)), fps_(fps) {}
  Expected<void> add(const ShimmerFrame& frame);
  const Rgb8Image& unshadowed() const { return base_; }
  const std::vector<FilmOfLight>& lights() const { return lights_; }

 private:
  Expected<void> add_light(const ShimmerLight& light, compare::Ladder ladder, FilmOfLight& film);
  Rgb8Image base_;
  double fps_;
  std::vector<FilmOfLight> lights_;
};

/// How often each receiver flips, on magma up to the most; black where none is compared.
Rgb8Image flip_heat_map(const ShimmerLight& light);

}  // namespace gnomon::studies
