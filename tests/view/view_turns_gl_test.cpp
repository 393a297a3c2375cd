// What is given up where drawing and comparing take turns on one thread, as in a page: built with that platform's turns.cpp, so that
// each turn is this test's own.
#include "lab/view/work/turns.h"

#include "app/console.h"
#include "lab/serve/lab_engine.h"
#include "tests/view/view_thread_fixture.h"

namespace gnomon::lab {
namespace {

/// A turn to draw and one to compare.
void take_round() {
  take_turn();
  take_turn();
}
constexpr int many_rounds = 50;  // more than any comparison takes

bool has_all_labels(const Snapshot& shown, std::uint64_t revision) {
  return shown.outcome && !shown.outcome->preview && shown.outcome->revision == revision;
}

/// Asks for a state by its light, which calls for rays anew.
ViewState turned(const ViewState& from, std::uint64_t revision, double azimuth_degrees) {
  ViewState state = from;
  state.revision = revision;
  state.setup.lights.front() = app::LightPose{azimuth_degrees, 40.0, {}, {}};
  return state;
}

void ask(Lab& lab, const ViewState& state) {
  lab.thread().post(1, {state.revision, state.setup});
}

/// In how many rounds its labels come, when nothing else is asked for; lets the next round begin with drawing, which hands them out.
int rounds_to_labels(Lab& lab, const ViewState& state) {
  ask(lab, state);
  for (int rounds = 1; rounds < many_rounds; ++rounds) {
    take_turn();
    if (has_all_labels(*lab.thread().snapshot(), state.revision)) {
      take_turn();
      return rounds;
    }
    take_turn();
    if (has_all_labels(*lab.thread().snapshot(), state.revision)) {
      take_turn();
      return rounds_to_labels(lab, turned(state, state.revision + 1, 77.0));
    }
  }
  return many_rounds;
}

/// Whether the labels of a state that is left for another one after so many rounds still come.
bool labels_come(Lab& lab, int rounds, const ViewState& left, const ViewState& next) {
  ask(lab, left);
  for (int round = 0; round < rounds; ++round) take_round();
  ask(lab, next);
  bool come = has_all_labels(*lab.thread().snapshot(), left.revision);
  for (int round = 0; round < many_rounds; ++round) {
    take_round();
    come = come || has_all_labels(*lab.thread().snapshot(), left.revision);
  }
  EXPECT_TRUE(has_all_labels(*lab.thread().snapshot(), next.revision)) << "what was asked for last";
  return come;
}

// A round of the preview's rays, one of its labels, one of all rays and one of all labels, which the next one hands out.
TEST(Turns, LabelsOfAStateThatIsLeftAreGivenUpBeforeItsRaysAndAfterThem) {
  Lab lab("floating-box", {});
  for (int round = 0; round < many_rounds && !is_open(*lab.thread().snapshot()); ++round) take_round();
  const ViewState state = lab.state(*lab.thread().snapshot());
  ASSERT_EQ(rounds_to_labels(lab, turned(state, 10, 40.0)), 5);
  for (int rounds = 0; rounds < 6; ++rounds) {
    const std::uint64_t revision = 2 * static_cast<std::uint64_t>(rounds) + 20;
    const bool come = labels_come(lab, rounds, turned(state, revision, 3.0 * rounds),
                                  turned(state, revision + 1, 3.0 * rounds + 1.0));
    EXPECT_EQ(come, rounds >= 4) << "left after " << rounds << " rounds";
  }
}

/// A lab of acne-floor that is asked for one state after so many turns, and is then left to itself: the words of what it draws.
std::string words_at_rest(int turns_before) {
  LabOptions options;
  options.scene.name = "acne-floor";
  options.quiet = true;
  app::Console console(true);
  auto source = first_source(options, console);
  if (!source) return source.error().message();
  auto engine = LabEngine::start(options, std::move(*source));
  if (!engine) return engine.error().message();
  for (int turn = 0; turn < turns_before; ++turn) take_turn();
  const auto asked =
      (*engine)->ask({"page", "acne-floor", {"--size", "64x48", "--map-size", "64", "--bias", "2texel"}, {}});
  if (!asked) return asked.error().message();
  for (int round = 0; round < many_rounds; ++round) take_round();
  std::string text;
  for (const std::string& word : (*engine)->compare_words((*engine)->wait(0, std::chrono::milliseconds(0))))
    text += word + " ";
  return text;
}

// A link's state is asked for while the first scene is under way: the scene is opened twice then, and the state stays.
TEST(Turns, AWishThatComesBeforeTheFirstSceneIsKept) {
  for (const int turns : {0, 1, 2, 3, 8}) {
    const std::string words = words_at_rest(turns);
    EXPECT_NE(words.find("--map-size 64 "), std::string::npos) << turns << ": " << words;
    EXPECT_NE(words.find("--bias 2texel"), std::string::npos) << turns << ": " << words;
  }
}

}  // namespace
}  // namespace gnomon::lab
