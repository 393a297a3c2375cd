// Rubrics of gnomon grade.
#include "fuzz_target.h"
#include "grade/rubric.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace gnomon;
  const std::string path = fuzz::put("rubric.json", {reinterpret_cast<const char*>(data), size});
  const auto rubric = grade::read_rubric(path);
  fuzz::note_read(rubric ? nullptr : &rubric.error());
  if (!rubric) return 0;
  if (rubric->checks.empty() || !(rubric->points() > 0.0) || !(rubric->limits.seconds > 0.0))
    fuzz::broken("a rubric without checks, points or time");
  for (std::size_t i = 0; i < rubric->checks.size(); ++i)
    for (const std::size_t needed : rubric->checks[i].needs)
      if (needed >= i) fuzz::broken("a check that needs a later one");
  return 0;
}

std::vector<std::string> gnomon::fuzz::seeds() {
  return {
      R"({
  // comments are allowed
  "schema": "gnomon/rubric/1", "title": "One of each", "text": "Write it.", "technique": "hard",
  "hand_in": ["technique/hard.glsl"], "limits": { "seconds": 20, "memory_mb": 2048 },
  "checks": [
    { "name": "draws", "points": 2, "kind": "draws", "hint": "Look.",
      "runs": [{ "scene": "thin-wall", "options": { "size": "240x135", "map-size": "512", "bias": "0.055" } }] },
    { "name": "few", "points": 1.5, "kind": "at_most", "measure": "missed_shadow", "at_most": "5%", "needs": ["draws"],
      "runs": [{ "scene": "fence", "options": {} }] },
    { "name": "same", "points": 3, "kind": "equals", "pixels": 40, "needs": ["draws", "few"],
      "runs": [{ "scene": "fence", "options": { "bias": "1texel" } }] },
    { "name": "quick", "points": 1, "kind": "time", "times": 2, "runs": [{ "scene": "fence", "options": {} }] }]
})",
      R"({ "schema": "gnomon/rubric/1", "title": "Functions", "language": "de", "limits": { "seconds": 5 },
  "hand_in": ["function/ray_box.glsl", "function/shadow_ray.glsl"],
  "checks": [
    { "name": "a", "points": 1, "kind": "answers", "function": "ray_box", "cases": "inside", "hint": "0" },
    { "name": "b", "points": 0.5, "kind": "answers", "function": "shadow_ray", "cases": "sun", "needs": ["a"] }]
})"};
}
