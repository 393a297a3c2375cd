// Cameras for files that have none look at what casts shadows, and one note says what was made.
#include <fmt/format.h>

#include <algorithm>

#include "scene/camera.h"
#include "scene/load.h"
#include "tests/support/obj_box.h"
#include "tests/support/scene_files_support.h"

namespace gnomon {
namespace {

using test::box;
using test::level;
using test::loaded;

/// The corners of a box in the picture's coordinates, each from -1 to 1 where it is in the picture.
Aabb in_picture(const Scene& scene, const Vec3& low, const Vec3& high, ImageSize size = {160, 90}) {
  const View view = make_view(scene.camera, size);
  Aabb out;
  for (int i = 0; i < 8; ++i) {
    const Vec3 p = project_to_pixels(
        view, {(i & 1) ? high.x : low.x, (i & 2) ? high.y : low.y, (i & 4) ? high.z : low.z});
    out.grow(Vec3(2.0 * p.x / size.width - 1.0, 2.0 * p.y / size.height - 1.0, p.z));
  }
  return out;
}

/// Expects the box to be in the picture, and to be as high as this share of it at least.
void expect_framed(const Scene& scene, const Vec3& low, const Vec3& high, double share) {
  const Aabb seen = in_picture(scene, low, high);
  EXPECT_GE(seen.min.x, -1.0);
  EXPECT_GE(seen.min.y, -1.0);
  EXPECT_LE(seen.max.x, 1.0);
  EXPECT_LE(seen.max.y, 1.0);
  EXPECT_GT(seen.min.z, 0.0);
  EXPECT_GE(0.5 * (seen.max.y - seen.min.y), share);
}

std::string palm(int first) {
  return box({-0.3, 0.0, -0.3}, {0.3, 8.0, 0.3}, false, -1, first) +
         box({-3.0, 8.0, -3.0}, {3.0, 8.3, 3.0}, false, -1, first + 8);
}

// Whether the file names the sea or not, and whether a beach lies on it.
TEST(MadeView, APalmOnASeaIsNoDot) {
  const Vec3 low(-3.0, 0.0, -3.0), high(3.0, 8.3, 3.0);
  const std::string sea = level({-196.0, 0.0, -196.0}, 196.0, 196.0);
  expect_framed(loaded(sea + palm(4)), low, high, 0.3);
  expect_framed(loaded("o sea\n" + sea + "o palm\n" + palm(4)), low, high, 0.3);
  expect_framed(loaded(sea + level({-30.0, 0.1, -30.0}, 30.0, 30.0, 4) + palm(8)), low, high, 0.3);
}

std::string car(int first) {
  std::string out = box({-2.2, 0.4, -0.9}, {2.2, 1.0, 0.9}, false, -1, first) +
                    box({-1.2, 1.0, -0.8}, {1.0, 1.6, 0.8}, false, -1, first + 8);
  for (const double end : {-2.4, 2.2}) {
    first += 8;
    out += box({end, 0.45, -0.85}, {end + 0.2, 0.6, 0.85}, false, -1, first + 8);
  }
  return out;
}

TEST(MadeView, ACarOnAGroundIsSeenWhole) {
  const Vec3 low(-2.4, 0.4, -0.9), high(2.4, 1.6, 0.9);
  for (const double half : {3.0, 8.0, 40.0, 4000.0})
    expect_framed(loaded(level({-half, 0.0, -half}, half, half) + car(4)), low, high,
                  half < 8.0 ? 0.25 : 0.3);
  expect_framed(loaded(car(0)), low, high, 0.4);
}

// A house stays the house though its walls are larger than a lamp on it, and its roof flat.
TEST(MadeView, AHouseOnAGroundIsNotLeftOutForItsLamp) {
  const std::string house = level({-50.0, 0.0, -50.0}, 50.0, 50.0) +
                            box({-4.0, 0.0, -3.0}, {4.0, 3.0, 3.0}, false, -1, 4) +
                            box({-4.5, 3.0, -3.5}, {4.5, 3.2, 3.5}, false, -1, 12) +
                            box({-0.1, 1.0, 3.0}, {0.1, 1.2, 3.1}, false, -1, 20);
  expect_framed(loaded(house), {-4.5, 0.0, -3.5}, {4.5, 3.2, 3.5}, 0.4);
}

TEST(MadeView, ASingleObjectIsFramedAsEver) {
  const Scene scene = loaded(box({-1.0, 0.0, -1.0}, {1.0, 2.0, 1.0}, false));
  expect_framed(scene, {-1.0, 0.0, -1.0}, {1.0, 2.0, 1.0}, 0.7);
  EXPECT_NEAR(
      glm::dot(glm::normalize(scene.camera.eye - scene.camera.target), glm::normalize(Vec3(0.55, 0.5, 1.0))),
      1.0, 1e-12);
  EXPECT_TRUE(test::has_note(scene, "What casts shadows fills 26 % of the picture."));
}

TEST(MadeView, OneNoteSaysWhatWasMade) {
  const Scene scene = loaded(box({-1.0, 0.0, -1.0}, {1.0, 2.0, 1.0}, false));
  ASSERT_EQ(scene.notes.size(), 1u);
  for (const char* part : {"Made, as the file has none: a camera at [", ", a directional light 'sun' along [",
                           ", an ambient light of 0.15", ", a grey ground at y = 0, "})
    EXPECT_NE(scene.notes[0].find(part), std::string::npos) << part;
}

TEST(MadeView, WhereNothingCastsTheNoteSaysSo) {
  const char* none = "Nothing that the picture shows casts a shadow.";
  EXPECT_TRUE(test::has_note(loaded(level({-40.0, 0.0, -40.0}, 40.0, 40.0)), none));
  EXPECT_TRUE(test::has_note(loaded("v -1 0 1\nv 1 0 1\nv 1 0 -1\nf 1 2 3\n"), none));
  const Scene stands = loaded("v -1 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  EXPECT_FALSE(test::has_note(stands, none));
  expect_framed(stands, {-1.0, 0.0, 0.0}, {1.0, 1.0, 0.0}, 0.4);
}

TEST(MadeView, ARoomsContentsAreSeenAndLit) {
  const Vec3 low(-2.0, 0.0, -3.0), high(2.0, 2.5, 3.0);
  for (const bool inwards : {true, false}) {
    const Scene room =
        loaded(box(low, high, inwards) + box({-0.5, 0.0, -1.5}, {0.5, 0.8, -0.5}, false, -1, 8));
    EXPECT_EQ(glm::clamp(room.camera.eye, low, high), room.camera.eye) << inwards;
    expect_framed(room, {-0.5, 0.0, -1.5}, {0.5, 0.8, -0.5}, 0.1);
    ASSERT_EQ(room.lights.size(), 1u);
    EXPECT_EQ(glm::clamp(room.lights[0].position, low, high), room.lights[0].position) << inwards;
    EXPECT_TRUE(test::has_note(room, " inside a closed room, "));
  }
}

// The eye, the lamp and the only thing that casts are in the same of two rooms.
TEST(MadeView, OfTwoRoomsTheOneWithSomethingInItIsSeen) {
  const Scene rooms = loaded(box({-4.0, 0.0, -3.0}, {4.0, 2.5, 3.0}, true) +
                             box({-0.05, 0.0, -3.0}, {0.05, 2.5, 3.0}, false, -1, 8) +
                             box({-2.5, 0.0, -1.0}, {-1.5, 1.0, 0.0}, false, -1, 16));
  EXPECT_LT(rooms.camera.eye.x, -0.05);
  ASSERT_EQ(rooms.lights.size(), 1u);
  EXPECT_LT(rooms.lights[0].position.x, -0.05);
  EXPECT_GT(rooms.lights[0].position.x, -4.0);
  expect_framed(rooms, {-2.5, 0.0, -1.0}, {-1.5, 1.0, 0.0}, 0.1);
}

// A Cornell box, whichever of its sides is open.
TEST(MadeView, ARoomWithAnOpenSideIsLookedInto) {
  for (const int open : {0, 1, 3, 4, 5}) {
    const Scene room = loaded(box({-2.0, 0.0, -2.0}, {2.0, 4.0, 2.0}, true, open) +
                              box({-1.0, 0.0, -1.0}, {0.0, 2.0, 0.0}, false, -1, 8));
    const Vec3 way = room.camera.eye - room.camera.target;
    const double outwards = (open % 2 == 0 ? -1.0 : 1.0) * way[open / 2];
    EXPECT_GT(outwards, 0.8 * glm::length(way)) << open;
    ASSERT_EQ(room.lights.size(), 1u);
    EXPECT_EQ(room.lights[0].type, open == 3 ? LightType::directional : LightType::point) << open;
    expect_framed(room, {-1.0, 0.0, -1.0}, {0.0, 2.0, 0.0}, 0.1);
  }
}

// Scanned bodies hold scraps that nobody is to look at: here an octahedron with a floor in its middle.
TEST(MadeView, ABodyWithAScrapInsideIsSeenFromOutside) {
  const Scene body = loaded(
      "v 2 0 0\nv 0 0 -2\nv -2 0 0\nv 0 0 2\nv 0 2 0\nv 0 -2 0\nf 1 2 3 4\n"
      "f 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\nf 2 1 6\nf 3 2 6\nf 4 3 6\nf 1 4 6\n" +
      box({-0.4, 0.2, -0.4}, {0.4, 0.8, 0.4}, false, -1, 6));
  EXPECT_GT(glm::length(body.camera.eye), 4.0);
}

TEST(MadeView, TheSameFileGivesTheSameCamera) {
  const std::string obj = level({-196.0, 0.0, -196.0}, 196.0, 196.0) + palm(4);
  const Scene first = loaded(obj), second = loaded(obj);
  EXPECT_TRUE(first.camera == second.camera);
  EXPECT_EQ(first.notes, second.notes);
}

}  // namespace
}  // namespace gnomon
