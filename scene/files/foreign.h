// Models in formats that the project does not read itself: assimp, in a process of its own, makes glTF of them.
#pragma once

#include "scene/files/formats.h"

namespace gnomon {

/// Whether read_foreign() reads it: .stl .fbx .dae .3ds .x3d .3mf.
bool is_foreign(std::string_view extension);

/// What to do about a format that is not read at all (".blend": export it from there as .glb); empty for others.
std::string_view foreign_hint(std::string_view extension);

/// Reads the file by way of glTF. The program `assimp` (Debian: assimp-utils) gets two minutes of processor time, 4 GB of
/// memory and no file to write but memory; what it cannot read is an error with its own words, that it is not there one of
/// ErrorKind::bad_input. A note says what glTF by assimp lacks. `folder` is where its textures lie.
Expected<LoadedFile> read_foreign(const std::string& file, const std::string& folder,
                                  const LoadOptions& options);

}  // namespace gnomon
