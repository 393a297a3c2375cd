// Triangles of glTF meshes: every primitive mode, indexed or not; morph targets and skins in the pose that the
// file is stored in. Points and lines are skipped, with a note.
#pragma once

#include <set>
#include <string>

#include "scene/base/expected.h"
#include "scene/files/gltf/gltf_data.h"
#include "scene/files/gltf/gltf_materials.h"
#include "scene/scene.h"

namespace gnomon {

class GltfAccessor;

/// What shapes a mesh before a node places it.
struct GltfPose {
  std::vector<double> weights{};  ///< of the morph targets; those that are missing are 0
  std::vector<Mat4> joints{};     ///< joint_transforms(); empty: no skin
};

/// Where all triangles are of one material, `material`, the mesh has no list of them.
struct GltfMesh {
  Mesh mesh;
  std::uint32_t material = 0;
};

class GltfMeshReader {
 public:
  /// Primitives without a material get `default_material`. All of these must outlive the reader.
  GltfMeshReader(const gltf::Model& model, const GltfData& data, const TexcoordSets& sets,
                 std::uint32_t default_material, const std::string& file)
      : model_(model), data_(data), sets_(sets), default_material_(default_material), file_(file) {}

  /// One without triangles is empty.
  Expected<GltfMesh> read(std::size_t mesh, const GltfPose& pose);
  /// The model has primitives of points or lines.
  bool skipped_points() const { return skipped_ > 0; }
  void add_notes(Scene& scene) const;

 private:
  /// A primitive's part of a mesh: positions [first, first + count).
  struct Part {
    const gltf::Primitive& primitive;
    std::string path;
    std::size_t first = 0, count = 0;
  };
  tl::unexpected<Error> error(std::string field, std::string reason) const;
  GltfAccessor accessor(int index) const;
  Expected<void> add_primitive(Mesh& mesh, const gltf::Primitive& primitive, const GltfPose& pose,
                               std::string path);
  Expected<void> add_positions(Mesh& mesh, const Part& part) const;
  Expected<void> check_positions(const Mesh& mesh, const Part& part) const;
  void add_normals(Mesh& mesh, const Part& part);
  void add_uvs(Mesh& mesh, const Part& part);
  void add_colors(Mesh& mesh, const Part& part);
  void apply_targets(Mesh& mesh, const Part& part, const std::vector<double>& weights) const;
  void apply_skin(Mesh& mesh, const Part& part, const std::vector<Mat4>& joints);
  template <class Put>
  Expected<void> for_each_index(const Part& part, const Put& put) const;
  Expected<void> add_triangles(Mesh& mesh, const Part& part);
  std::uint32_t material_of(const gltf::Primitive& primitive) const;

  const gltf::Model& model_;
  const GltfData& data_;
  const TexcoordSets& sets_;
  std::uint32_t default_material_;
  const std::string& file_;
  std::set<std::uint32_t> coloured_{};  ///< materials of what has COLOR_0
  std::size_t skipped_ = 0, without_position_ = 0, bad_attributes_ = 0, lost_vertices_ = 0, unbound_ = 0;
};

}  // namespace gnomon
