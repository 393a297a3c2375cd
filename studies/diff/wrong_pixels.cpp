#include "studies/diff/wrong_pixels.h"

#include <unordered_map>
#include <unordered_set>

#include "compare/ladder/labels.h"
#include "compare/result/outputs.h"
#include "compare/result/palette.h"
#include "scene/files/pictures/image_io.h"

namespace gnomon::studies {
namespace {

using compare::Label;

std::uint32_t key_of(const glm::u8vec3& c) {
  return std::uint32_t{c.r} << 16 | std::uint32_t{c.g} << 8 | std::uint32_t{c.b};
}

/// Three channels round at steps of their own, hence so many errors above one half.
constexpr int error_steps = 1 << 16;
constexpr float error_at(int step) {
  return 0.5f + 0.5f * float(step) / float(error_steps);
}

/// Of pixels that are no error, and of wrong ones.
std::unordered_map<std::uint32_t, Label> label_of_colours() {
  std::unordered_map<std::uint32_t, Label> labels;
  for (int value = int(Label::uncertain); value < int(Label::right); ++value)
    labels.emplace(key_of(compare::label_colour(Label(value))), Label(value));
  for (std::size_t k = 1; k <= compare::class_count; ++k)
    for (const bool dark : {false, true})
      for (int step = 1; step <= error_steps; ++step)
        labels.emplace(key_of(compare::label_pixel(Label(k), dark, error_at(step))), Label(k));
  return labels;
}

std::unordered_set<std::uint32_t> colours_of_large_errors() {
  std::unordered_set<std::uint32_t> colours;
  for (int step = 1; step <= error_steps; ++step)
    colours.insert(key_of(compare::magma(double{error_at(step)})));
  return colours;
}

}  // namespace

Expected<Image<Label>> read_wrong_pixels(const PixelFiles& files) {
  static const std::unordered_map<std::uint32_t, Label> labels = label_of_colours();
  static const std::unordered_set<std::uint32_t> large = colours_of_large_errors();
  const auto label = read_texture(files.labels, true), error = read_texture(files.error, true);
  if (!label) return fail(label.error());
  if (!error) return fail(error.error());
  if (label->size != error->size)
    return fail(Error{ErrorKind::bad_input, "has another size than labels.png", files.error});
  Image<Label> out(label->size);
  for (std::size_t i = 0; i < out.data.size(); ++i) {
    const auto found = labels.find(key_of(glm::u8vec3(label->texels[i])));
    const Label read = found == labels.end() ? Label::right : found->second;
    const bool is_small = !large.contains(key_of(glm::u8vec3(error->texels[i])));
    out.data[i] = compare::has_cause(read) && is_small ? Label::right : read;
  }
  return out;
}

}  // namespace gnomon::studies
