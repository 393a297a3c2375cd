// What stands behind the JSON of a glTF file: the binary chunk of a GLB, files beside it (mapped into memory)
// and data URIs. Views that EXT_ or KHR_meshopt_compression packs are unpacked.
#pragma once

#include <deque>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scene/base/expected.h"
#include "scene/files/gltf/gltf_model.h"
#include "scene/files/mapped_file.h"
#include "scene/load.h"

namespace gnomon {

// The GLB container (glTF 2.0, section 4).

struct GlbChunks {
  std::string_view json;
  std::optional<std::string_view> binary;
};

bool is_glb(std::string_view bytes);
Expected<GlbChunks> read_glb(std::string_view bytes, const std::string& file);

/// An image as its file holds it, encoded.
struct GltfImage {
  std::size_t index = 0;     ///< of images
  std::string name;          ///< the file's name for it, or its path, or images[i]
  std::string uri;           ///< as written; empty for what lies inside the file
  std::string_view bytes{};  ///< empty where the file is not there
};

class GltfData {
 public:
  /// `bytes`, the whole file, must outlive the result. Errors (bad_input): a buffer that is missing, shorter
  /// than its byteLength or outside the allowed folders; a packed view that is not sound.
  static Expected<GltfData> open(const GltfDocument& document, std::string_view bytes,
                                 const std::string& folder, const LoadOptions& options);

  /// The bytes of bufferViews[index], all of them.
  std::string_view view(std::size_t index) const { return views_[index].bytes; }
  std::size_t view_count() const { return views_.size(); }
  /// Bytes from one element of the view to the next; 0: they lie close together.
  std::size_t stride(std::size_t index) const { return views_[index].stride; }
  const LoadOptions& options() const { return *options_; }
  std::size_t image_count() const { return images_.size(); }
  /// Reads the file the first time. Error: the path is not allowed, or the file cannot be read.
  Expected<GltfImage> image(std::size_t index);
  /// Another view, for what was made from the others; its index.
  std::size_t add_view(std::vector<char> bytes);

 private:
  struct View {
    std::string_view bytes{};
    std::size_t stride = 0;
  };
  GltfData(const GltfDocument& document, std::string_view bytes, std::string folder,
           const LoadOptions& options)
      : document_(&document), bytes_(bytes), folder_(std::move(folder)), options_(&options) {}
  Expected<void> open_buffers();
  Expected<void> open_views();
  Expected<std::string_view> open_buffer(std::size_t index);
  Expected<std::string_view> open_uri(const std::string& uri, const std::string& field);
  tl::unexpected<Error> error(std::string field, std::string reason) const;

  const GltfDocument* document_;
  std::string_view bytes_;
  std::string folder_;
  const LoadOptions* options_;
  std::deque<MappedFile> files_;           // they stay where they are, for the views
  std::deque<std::vector<char>> decoded_;  // data URIs and unpacked views
  std::vector<std::string_view> buffers_;
  std::vector<View> views_;
  std::vector<std::optional<GltfImage>> images_;
};

// What glTF files pack: primitives by Draco (KHR_draco_mesh_compression), bufferViews by meshoptimizer
// (EXT_meshopt_compression and KHR_meshopt_compression).

/// Unpacks such primitives and points their accessors to new views of plain data. Where the extension is not
/// required and a primitive brings its geometry unpacked too, that is taken. Errors (bad_input): data that is
/// damaged, or that claims more triangles or vertices than so many bytes can hold.
Expected<void> unpack_draco(GltfDocument& document, GltfData& data);

/// The bytes of the view, unpacked. `extension` is the view's object of that name; `buffers` are the file's;
/// `byte_length` is the view's own. The Error holds the reason alone. A size that the packed bytes cannot
/// fill is refused before anything is allocated.
Expected<std::vector<char>> unpack_meshopt(const JsonValue& extension,
                                           std::span<const std::string_view> buffers, double byte_length);

}  // namespace gnomon
