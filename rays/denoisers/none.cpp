#include "rays/mean_history.h"

namespace gnomon::rays {
namespace {

template <std::size_t count>
class None final : public Denoiser<count> {
 public:
  None(int frames, ImageSize size) : history_(frames, size) {}
  std::uint64_t add(const NoisyFrame<count>& frame, Image<Signal<count>>& out) override {
    const std::uint64_t taps = history_.add(frame);
    out = history_.mean();
    return taps;
  }
  std::unique_ptr<Denoiser<count>> clone() const override { return std::make_unique<None>(*this); }
  std::uint64_t history_bytes() const override { return history_.bytes(); }

 private:
  MeanHistory<count> history_;
};

}  // namespace

template <std::size_t count>
std::unique_ptr<Denoiser<count>> make_none(int frames, ImageSize size) {
  return std::make_unique<None<count>>(frames, size);
}
template std::unique_ptr<Denoiser<alone>> make_none<alone>(int, ImageSize);
template std::unique_ptr<Denoiser<with_passengers>> make_none<with_passengers>(int, ImageSize);

}  // namespace gnomon::rays
