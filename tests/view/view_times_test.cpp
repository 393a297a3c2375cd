// What shadows take on the GPU, from clocks that answer late, lose count, or are coarse.
#include <gtest/gtest.h>

#include <deque>

#include "lab/view/work/shadow_times.h"

namespace gnomon::lab {
namespace {

/// Answers in order; with nothing left, not yet.
class Told final : public raster::Renderer {
 public:
  explicit Told(std::deque<raster::ShadowSpans> answers) : answers_(std::move(answers)) {}
  Expected<raster::RasterFrame> render(const raster::RasterOptions&,
                                       std::span<const std::uint32_t>) override {
    return raster::RasterFrame{};
  }
  std::optional<raster::ShadowSpans> take_spans() override {
    if (late_ = !late_; late_ || answers_.empty()) return std::nullopt;  // every second turn
    const raster::ShadowSpans answer = answers_.front();
    answers_.pop_front();
    return answer;
  }
  void use_external_visibility(raster::Technique, std::shared_ptr<raster::ExternalVisibility>) override {}
  const raster::ContextInfo& info() const override { return info_; }

 private:
  std::deque<raster::ShadowSpans> answers_;
  raster::ContextInfo info_;
  bool late_ = false;
};

/// Takes turns until all is known, and keeps how many drawings were asked for each time.
struct Timed {
  ShadowTimer timer;
  std::vector<int> drawings;
  int turns = 0;
  void take(Told& renderer, std::uint64_t revision) {
    const auto known = [&] { return timer.times() && timer.times()->revision == revision; };
    for (turns = 0; turns < 100 && !known(); ++turns)
      ASSERT_TRUE(timer.take_turn(revision, renderer, [&](int so_often) -> Expected<void> {
        drawings.push_back(so_often);
        return {};
      }));
  }
};

TEST(ShadowTimes, AreMediansOfRunsThatTheClockCanTell) {
  // Once 3 ms, so ten drawings a run; in steps of 0.1 ms.
  const raster::ShadowSpans first{true, true, 1.0, 1.5, 0.5}, lost{};
  Told renderer({first,
                 {true, true, 4.0, 9.0, 6.0},
                 lost,
                 {true, true, 4.2, 9.5, 6.0},
                 {true, true, 3.9, 9.0, 6.1},
                 {true, true, 4.1, 9.1, 6.0},
                 {true, true, 40.0, 90.0, 6.0}});
  Timed timed;
  timed.take(renderer, 7);
  EXPECT_EQ(timed.drawings, (std::vector{1, 10, 10, 10, 10, 10, 10})) << "what was lost is drawn again";
  EXPECT_EQ(timed.turns, 15) << "a turn that asks first, then two a run";
  const auto times = timed.timer.times();
  ASSERT_TRUE(times);
  EXPECT_TRUE(times->by_device);
  EXPECT_EQ(times->map.runs.size(), 5u);
  EXPECT_DOUBLE_EQ(times->map.median(), 0.41);
  EXPECT_NEAR(times->lookups().median, 0.3, 1e-12) << "0.9 less 0.6, the least of each";
  EXPECT_NEAR(times->step_ms, 0.1, 1e-12);
}

TEST(ShadowTimes, InSoftwareAreOfThreeRunsStripByStrip) {
  raster::LightRecord drawn;
  drawn.map_pass.runs = {5.0};
  drawn.strips = {{{{4.0}}, {{3.0}}}, {{{6.0}}, {{4.0}}}};
  ShadowTimer timer;
  timer.take_run(1, drawn);
  for (int run = 0; run < 3; ++run) {
    EXPECT_FALSE(timer.knows(2));
    timer.take_run(2, drawn);
  }
  ASSERT_TRUE(timer.knows(2));
  EXPECT_EQ(timer.times()->map.runs.size(), 3u) << "those of the state before are forgotten";
  EXPECT_EQ(timer.times()->strips.size(), 2u);
  EXPECT_DOUBLE_EQ(timer.times()->lookups().median, 3.0);
  EXPECT_EQ(timer.times()->step_ms, 0.0);
}

TEST(ShadowTimes, OfAStateThatIsLeftAreForgotten) {
  const raster::ShadowSpans run{true, false, 10.0, 10.0, 10.0}, other{true, false, 2.0, 2.0, 2.0};
  Told renderer({run, run, run});
  Timed timed;
  for (int turn = 0; turn < 4; ++turn)
    ASSERT_TRUE(timed.timer.take_turn(1, renderer, [](int) { return Expected<void>{}; }));
  Told next({other, other, other, other, other, other});
  timed.take(next, 2);
  const auto times = timed.timer.times();
  ASSERT_TRUE(times);
  EXPECT_EQ(times->revision, 2u);
  EXPECT_EQ(times->map.runs.size(), 5u);
  EXPECT_DOUBLE_EQ(times->map.most(), 2.0 / times->drawings);
  EXPECT_FALSE(times->by_device);
}

}  // namespace
}  // namespace gnomon::lab
