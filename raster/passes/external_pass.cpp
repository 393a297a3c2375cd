#include "raster/passes/external_pass.h"

#include "raster/bands.h"
#include "shaders/shared_constants.h"

namespace gnomon::raster {

Expected<void> ExternalPass::check() const {
  if (visibility_ != nullptr) return {};
  return fail(ErrorKind::internal, "the technique hybrid has nothing to ask for its visibility");
}

Expected<void> ExternalPass::find(const VisibilityRequest& request, const ShadingPass& shading) {
  shading.read_primitives(primitive_);
  if (auto* rows = dynamic_cast<ExternalRows*>(visibility_.get())) rows->set_first_row(shading.rows().first);
  if (!(image_.size == primitive_.size)) {
    image_ = Image<float>(primitive_.size);
    texture_ = Texture2D(*gl_, GL_R32F, primitive_.size);
  }
  if (auto ok = visibility_->find(request, primitive_, image_); !ok) return ok;
  texture_.write(GL_RED, GL_FLOAT, std::as_bytes(std::span(image_.data)));
  return gl_->check("uploading the visibility");
}

void ExternalPass::bind_for_lookup() const {
  texture_.bind(shaders::external_visibility_unit);
}

}  // namespace gnomon::raster
