#include "raster/gl/span_clock.h"

#include <limits>
#include <utility>

namespace gnomon::raster {
namespace {

/// What a query gives where the device lost count (GPU_DISJOINT_EXT, which platform/web asks), and where 32 bits of
/// nanoseconds are too few.
constexpr GLuint lost = std::numeric_limits<GLuint>::max();
constexpr double ms_per_ns = 1e-6;

}  // namespace

SpanClock::SpanClock(Gl& gl) : gl_(&gl) {
  GLint bits = 0;
  gl->GetQueryiv(GL_TIME_ELAPSED, GL_QUERY_COUNTER_BITS, &bits);
  of_device_ = bits > 0;
}

SpanClock::~SpanClock() {
  if (!queries_.empty()) (*gl_)->DeleteQueries(static_cast<GLsizei>(queries_.size()), queries_.data());
}

void SpanClock::restart() {
  asked_ = 0;
  clocked_ms_.clear();
}

void SpanClock::begin() {
  if (!of_device_) {
    (*gl_)->Finish();
    watch_ = Stopwatch();
    return;
  }
  if (asked_ == queries_.size()) (*gl_)->GenQueries(1, &queries_.emplace_back());
  (*gl_)->BeginQuery(GL_TIME_ELAPSED, queries_[asked_++]);
}

void SpanClock::end() {
  if (of_device_) return (*gl_)->EndQuery(GL_TIME_ELAPSED);
  (*gl_)->Finish();
  clocked_ms_.push_back(watch_.elapsed_ms());
}

std::optional<std::vector<double>> SpanClock::answer() {
  if (!of_device_) return std::exchange(clocked_ms_, {});
  GLuint there = GL_TRUE;
  for (std::size_t i = 0; i < asked_ && there != GL_FALSE; ++i)
    (*gl_)->GetQueryObjectuiv(queries_[i], GL_QUERY_RESULT_AVAILABLE, &there);
  if (there == GL_FALSE) return std::nullopt;
  std::vector<double> out;
  bool counted = true;
  for (std::size_t i = 0; i < asked_; ++i) {
    GLuint nanoseconds = lost;
    (*gl_)->GetQueryObjectuiv(queries_[i], GL_QUERY_RESULT, &nanoseconds);
    counted = counted && nanoseconds != lost;
    out.push_back(ms_per_ns * nanoseconds);
  }
  asked_ = 0;
  if (!counted) out.clear();
  return out;
}

}  // namespace gnomon::raster
