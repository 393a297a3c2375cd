#include <cmath>
#include <nlohmann/json.hpp>

#include "functions/functions.h"
#include "scene/files/read_file.h"

namespace gnomon::functions {
namespace {

using Json = nlohmann::ordered_json;

/// JSON has no number for them.
Json number_json(float number) {
  if (std::isnan(number)) return "nan";
  if (std::isinf(number)) return number > 0.0f ? "inf" : "-inf";
  return number;
}

float number_of(const Json& json) {
  if (json.is_number()) return json.get<float>();
  const auto text = json.get<std::string>();
  if (text == "nan") return std::numeric_limits<float>::quiet_NaN();
  return (text == "inf" ? 1.0f : -1.0f) * std::numeric_limits<float>::infinity();
}

Json group_json(const Function& function, std::string_view name, const std::vector<raster::Answer>& answers) {
  const std::vector<Question>& questions = questions_of(function);
  Json given = Json::array(), right = Json::array();
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < questions.size(); ++i) {
    if (questions[i].group != name) continue;
    wrong += is_right(function, questions[i], answers[i]) ? 0 : 1;
    Json numbers = Json::array(), right_numbers = Json::array();
    for (std::size_t k = 0; k < size_of(function.kind); ++k)
      numbers.push_back(number_json(answers[i][k])), right_numbers.push_back(questions[i].right.value[k]);
    given.push_back(std::move(numbers)), right.push_back(std::move(right_numbers));
  }
  return {{"cases", name}, {"wrong", wrong}, {"answers", std::move(given)}, {"right", std::move(right)}};
}

}  // namespace

std::string answers_json(const Function& function, const std::vector<raster::Answer>& answers) {
  Json groups = Json::array();
  for (const std::string_view name : groups_of(function))
    groups.push_back(group_json(function, name, answers));
  const Json root = {
      {"schema", "gnomon/answers/1"}, {"function", function.name}, {"groups", std::move(groups)}};
  return root.dump() + "\n";
}

Expected<std::vector<raster::Answer>> read_answers(const Function& function, const std::string& path) {
  const auto text = read_file(path);
  if (!text) return fail(text.error());
  std::vector<raster::Answer> answers;
  try {
    const Json root = Json::parse(*text);
    for (const Json& group : root.at("groups"))
      for (const Json& numbers : group.at("answers")) {
        raster::Answer& answer = answers.emplace_back();
        for (std::size_t i = 0; i < numbers.size() && i < answer.size(); ++i)
          answer[i] = number_of(numbers[i]);
      }
  } catch (const nlohmann::json::exception& wrong) {
    return fail(Error{ErrorKind::internal, wrong.what(), path});
  }
  if (answers.size() != questions_of(function).size())
    return fail(Error{ErrorKind::internal, "holds other cases than this program's", path});
  return answers;
}

}  // namespace gnomon::functions
