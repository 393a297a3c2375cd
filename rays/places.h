// Which pixels still show the place that they showed a frame ago: what a history is given up by.
#pragma once

#include "rays/guides.h"

namespace gnomon::rays {

class Places {
 public:
  /// Whether the history of the pixel is one of the place that it shows now: within half a pixel of it.
  bool stays(const Guides& now, int x, int y) const {
    if (!(before_.size == now.size)) return false;
    const Guide &here = now.at(x, y), &then = before_.at(x, y);
    return then.asked() && glm::length(here.place - then.place) <= 0.5f * here.footprint;
  }
  void keep(const Guides& guides) { before_ = guides; }

 private:
  Guides before_;
};

}  // namespace gnomon::rays
