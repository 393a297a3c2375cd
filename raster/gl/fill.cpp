#include "raster/gl/fill.h"

#include <algorithm>

#include "scene/base/interruptible.h"
#include "scene/base/timing.h"

namespace gnomon::raster {
namespace {

class Stripes {
 public:
  explicit Stripes(const Gl& gl) : gl_(gl) { gl_->Enable(GL_SCISSOR_TEST); }
  ~Stripes() { gl_->Disable(GL_SCISSOR_TEST); }
  Stripes(const Stripes&) = delete;
  Stripes& operator=(const Stripes&) = delete;
  double draw_ms(int first, ImageSize stripe) const {
    const Stopwatch watch;
    gl_->Scissor(0, first, stripe.width, stripe.height);
    gl_->DrawArrays(GL_TRIANGLES, 0, 3);
    gl_->Finish();
    return watch.elapsed_ms();
  }

 private:
  const Gl& gl_;
};

}  // namespace

void fill(const Gl& gl, ImageSize size) {
  constexpr int first_pixels = 16384;
  constexpr double short_ms = 50.0;
  if (interruptible_work() == nullptr) return gl->DrawArrays(GL_TRIANGLES, 0, 3);
  const Stripes stripes(gl);
  int rows = std::max(2, first_pixels / size.width);
  for (int first = 0; first < size.height;) {
    leave_if_interrupted();
    const double took_ms = stripes.draw_ms(first, {size.width, rows});
    first += rows;
    if (took_ms < short_ms) rows = std::min(2 * rows, size.height);
  }
}

}  // namespace gnomon::raster
