// What the lab shows as text: lines that keep numbers whole, and a frame's parts that add up.
#include <gtest/gtest.h>

#include "lab/view/window/frame_watch.h"
#include "lab/view/window/style.h"
#include "scene/base/timing.h"

namespace gnomon::lab {
namespace {

/// Each letter is as wide as the next.
std::string broken(std::string_view text, double width) {
  return broken_at_blanks(text, width, [](std::string_view part) { return double(part.size()); });
}

TEST(TextWrap, ANumberIsNotBrokenAtItsCommaOrPoint) {
  EXPECT_EQ(broken("acne: 2,985 pixels", 9.0), "acne:\n2,985\npixels");
  EXPECT_EQ(broken("bias 0.125 of", 7.0), "bias\n0.125\nof");
}

TEST(TextWrap, LinesAreAsLongAsTheyMayBe) {
  EXPECT_EQ(broken("a bb ccc d", 4.0), "a bb\nccc\nd");
  EXPECT_EQ(broken("a bb ccc d", 100.0), "a bb ccc d");
  EXPECT_EQ(broken("", 4.0), "");
}

TEST(TextWrap, WhatIsTooWideHasALineOfItsOwn) {
  EXPECT_EQ(broken("a longest b", 3.0), "a\nlongest\nb");
}

TEST(TextWrap, TheTextsOwnBreaksStay) {
  EXPECT_EQ(broken("a b\nc d", 3.0), "a b\nc d");
}

TEST(FrameWatch, ThePiecesOfAPartAddUp) {
  FrameWatch watch;
  for (const Stopwatch busy; busy.elapsed_ms() < 2.0;) {
  }
  watch.end(FramePart::panels);
  const double first = watch[FramePart::panels].wall_ms;
  EXPECT_GE(first, 2.0);
  watch.end(FramePart::swap);
  watch.end(FramePart::panels);
  EXPECT_GE(watch[FramePart::panels].wall_ms, first);
}

TEST(FrameWatch, ItsPartsAreAllOfIt) {
  FrameWatch watch;
  double sum = 0.0;
  for (const FramePart part : {FramePart::events, FramePart::panels, FramePart::swap, FramePart::panels})
    watch.end(part);
  for (const FramePart part : {FramePart::events, FramePart::panels, FramePart::swap}) {
    EXPECT_GE(watch[part].wall_ms, 0.0);
    sum += watch[part].wall_ms;
  }
  EXPECT_EQ(watch[FramePart::font].wall_ms, 0.0);
  EXPECT_DOUBLE_EQ(watch.sum().wall_ms, sum);
}

}  // namespace
}  // namespace gnomon::lab
