// Where camera and maps lie in the scene: what the page draws of them (report/page/src/layout_figure.ts), and what a window
// holds, as sentences.
#pragma once

#include <array>
#include <string>

#include "compare/comparison.h"
#include "compare/result/result_parts.h"

namespace gnomon::compare {

/// Corners of what a camera sees as far as the scene's finite part reaches. Four are at the eye or, of an orthographic
/// one, in the plane through it. Then come four far away; each four are in the order of corner_places.
std::array<Vec3, 8> camera_corners(const World& world, const Camera& camera, const ImageSize& size);

/// Makes "camera" of result.json: the eye, and eight corners of what it sees as far as the scene's finite part reaches, in
/// the order of corner_places. The bounds of that part stand beside them.
Json camera_json(const Comparison& comparison);
/// Makes "windows" of a light's map: the corners of each map; empty where the map is not known.
Json windows_json(const Comparison& comparison, const LightComparison& light);

/// Says in sentences whether the map holds the casters, and whether it holds what is seen, its shadows above all. Empty
/// where the map is not known.
std::string window_words(const Comparison& comparison, const LightComparison& light);

}  // namespace gnomon::compare
