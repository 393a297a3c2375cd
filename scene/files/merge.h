// Appending one scene's parts to another's.
#pragma once

#include <cstdint>

#include "scene/scene.h"

namespace gnomon {

/// Where the appended parts begin.
struct MergeOffsets {
  std::uint32_t material = 0, texture = 0, mesh = 0;
};

/// Appends materials, textures, meshes and notes of `from`; with `placed`, its instances, shapes and lights
/// too. Camera and picture settings of `into` stay.
MergeOffsets merge_scene(Scene& into, Scene&& from, bool placed);

}  // namespace gnomon
