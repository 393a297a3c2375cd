// The lab in a page's worker (gnomon_worker.mjs): the engine of `gnomon serve`, on the worker's one thread. The worker hands the page's
// requests over, and gives the engine its turns.
#include <emscripten/em_js.h>
#include <emscripten/emscripten.h>

#include <exception>
#include <memory>

#include "lab/lessons/figures.h"
#include "lab/serve/lab_answers.h"
#include "lab/view/work/scene_source.h"
#include "lab/view/work/turns.h"
#include "scene/base/threads.h"

EM_JS_DEPS(gnomon_lab, "$UTF8ToString");
// Keeps an answer where the worker takes it.
EM_JS(void, gnomon_hand_over, (int status, const char* type, const char* body, unsigned size), {
  Module["answer"] = {status : status, type : UTF8ToString(type), body : HEAPU8.slice(body, body + size)};
});

namespace gnomon::lab {
namespace {

constexpr const char* folder = "/dropped";

struct Lab {
  std::unique_ptr<LabEngine> engine;
  std::unique_ptr<LabAnswers> answers;
};
Lab& lab() {
  static Lab one;
  return one;
}

void hand_over(const LabAnswer& answer) {
  gnomon_hand_over(answer.status, answer.type.c_str(), answer.body.data(),
                   static_cast<unsigned>(answer.body.size()));
}

LabAnswer begin(const std::string& scene, ImageSize size) {
  LabOptions options;
  options.scene = options.scene.named(scene);
  options.scene.settings = app::SettingsUse::sought;
  options.compare.raster.size = size;
  const auto map = first_map_options(options.scene);
  if (!map) return lab_refusal(map.error());
  options.compare.raster.map = *map;
  app::Console console(true);
  auto source = first_source(options, console);
  if (!source) return lab_refusal(source.error());
  auto engine = LabEngine::start(options, std::move(*source));
  if (!engine) return lab_refusal(engine.error());
  lab().engine = std::move(*engine);
  lab().answers = std::make_unique<LabAnswers>(*lab().engine, folder, std::chrono::milliseconds(0));
  return {200, "text/plain", ""};
}

/// A lesson's figure with other settings; the lab need not have begun.
LabAnswer compute_figure(const std::string& mark) {
  app::Console console(true);
  auto data = lessons::compute_figure(lessons::read_mark(mark), console);
  if (!data) return lab_refusal(data.error());
  return {200, "application/json", std::move(*data)};
}

/// "name=house.obj" of lines like it.
std::string line_value(const std::string& lines, const std::string& name) {
  const std::string begin = "\n" + name + "=";
  const std::size_t at = ("\n" + lines).find(begin);
  if (at == std::string::npos) return {};
  const std::size_t from = at + begin.size() - 1;
  return lines.substr(from, lines.find('\n', from) - from);
}

template <class Function>
void answered(const Function& function) {
  try {
    hand_over(function());
  } catch (const std::exception& error) {
    hand_over(lab_refusal(unforeseen(error)));
  }
}

}  // namespace
}  // namespace gnomon::lab

extern "C" {

/// Begins with a scene; the answer says whether there is one.
EMSCRIPTEN_KEEPALIVE void gnomon_lab_begin(const char* scene, int width, int height) {
  using namespace gnomon::lab;
  answered([&] { return begin(scene, {width, height}); });
}

/// `parameters`: lines of NAME=VALUE.
EMSCRIPTEN_KEEPALIVE void gnomon_lab_answer(const char* name, const char* parameters, const char* body,
                                            unsigned size) {
  using namespace gnomon::lab;
  const std::string lines = parameters;
  const auto parameter = [&](const char* key) { return line_value(lines, key); };
  answered([&] {
    return std::string_view(name) == "figure" ? compute_figure(parameter("mark"))
                                              : lab().answers->answer({name, parameter, {body, size}});
  });
}

/// Draws or compares what is next. Returns the number of the moment (LabMoment) after it.
EMSCRIPTEN_KEEPALIVE double gnomon_lab_turn() {
  using namespace gnomon::lab;
  take_turn();
  return static_cast<double>(lab().engine->wait(0, std::chrono::milliseconds(0)).number);
}
}
