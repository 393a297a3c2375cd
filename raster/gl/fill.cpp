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
  void draw(int first, ImageSize stripe) const {
    gl_->Scissor(0, first, stripe.width, stripe.height);
    gl_->DrawArrays(GL_TRIANGLES, 0, 3);
  }
  double draw_ms(int first, ImageSize stripe) const {
    const Stopwatch watch;
    draw(first, stripe);
    gl_->Finish();
    return watch.elapsed_ms();
  }

 private:
  const Gl& gl_;
};

}  // namespace

void fill(const Gl& gl, ImageSize size) {
  fill(gl, size, {0, size.height});
}

void fill(const Gl& gl, ImageSize size, const PictureRows& rows) {
  constexpr int first_pixels = 16384;
  constexpr double short_ms = 50.0;
  const int end = std::min(rows.end(), size.height);
  const bool whole = rows.first == 0 && end == size.height;
  if (interruptible_work() == nullptr && whole) return gl->DrawArrays(GL_TRIANGLES, 0, 3);
  const Stripes stripes(gl);
  if (interruptible_work() == nullptr) return stripes.draw(rows.first, {size.width, end - rows.first});
  int count = std::max(2, first_pixels / size.width);
  for (int first = rows.first; first < end;) {
    leave_if_interrupted();
    const double took_ms = stripes.draw_ms(first, {size.width, std::min(count, end - first)});
    first += count;
    if (took_ms < short_ms) count = std::min(2 * count, size.height);
  }
}

}  // namespace gnomon::raster
