// The bridge to a visibility that is worked out outside OpenGL: the visibility buffer read back, the answer
// uploaded. Private to raster.
#pragma once

#include <memory>

#include "raster/external_visibility.h"
#include "raster/passes/shading_pass.h"

namespace gnomon::raster {

class ExternalPass {
 public:
  explicit ExternalPass(Gl& gl) : gl_(&gl) {}
  void use(std::shared_ptr<ExternalVisibility> visibility) { visibility_ = std::move(visibility); }
  /// Error (internal): none was given.
  Expected<void> check() const;

  Expected<void> prepare(const VisibilityRequest& request, bool anew) {
    return visibility_->prepare(request, anew);
  }
  /// After ShadingPass::draw_visibility: the image that the technique's shader reads.
  Expected<void> find(const VisibilityRequest& request, const ShadingPass& shading);
  void bind_for_lookup() const;
  ExternalCosts costs(const VisibilityRequest& request, bool counted) const {
    return visibility_->costs(request, counted);
  }

 private:
  Gl* gl_;
  std::shared_ptr<ExternalVisibility> visibility_;
  Image<std::uint32_t> primitive_;
  Image<float> image_;
  Texture2D texture_;
};

}  // namespace gnomon::raster
