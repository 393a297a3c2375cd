// Animated PNG (the PNG specification's third edition, 2025, chapters 4.9 and 11.3.6), 8 bits, true colour. Every
// browser plays it, and programs that do not know of it show its first frame.
#pragma once

#include <string>
#include <vector>

#include "scene/base/expected.h"
#include "scene/image.h"

namespace gnomon {

class AnimatedPng {
 public:
  /// `fps` > 0; frames are shown for a whole number of milliseconds. The film begins again at its end.
  AnimatedPng(ImageSize size, double fps);
  /// Adds a frame; of later frames only what differs from the frame before is kept. The picture has the film's size.
  void add(const Rgb8Image& picture);
  /// The file. Error (internal): no frame was added.
  Expected<std::string> file() const;

 private:
  ImageSize size_;
  unsigned milliseconds_;
  Rgb8Image last_;
  std::vector<std::string> frames_;  ///< zlib streams
};

}  // namespace gnomon
