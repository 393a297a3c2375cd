// The live figures of one page: what a lesson's marks ask for, as the data that the page's script
// (report/page/src/lessons) makes figures of. A mark of a name that is not known here keeps its picture.
#pragma once

#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "app/lessons/comparison.h"
#include "app/lessons/lesson_text.h"

namespace gnomon::app::lessons {

class PageFigures {
 public:
  explicit PageFigures(Console& console) : console_(console) {}

  /// Adds the figure of the next mark. Errors: of its scene and its settings.
  Expected<void> add(const LiveMark& mark);

  /// The page's data without its parts, JSON.
  std::string data() const;
  const std::vector<compare::DataPart>& parts() const { return parts_; }

 private:
  using Json = nlohmann::ordered_json;
  Expected<Json> bias(const LiveMark& mark);
  Expected<Json> map_size(const LiveMark& mark);
  Expected<Json> two_passes(const LiveMark& mark);
  Expected<SmallComparison> compare(const LiveMark& mark, const Settings& settings);
  /// The key of a comparison that is now among the page's; all its parts, or the light's alone as light `light`.
  std::string keep(const std::string& key, SmallComparison&& comparison, int light);

  Console& console_;
  Json figures_ = Json::array(), comparisons_ = Json::object(), words_ = Json::object();
  std::set<std::string> kept_;  ///< names of parts
  std::vector<compare::DataPart> parts_;
};

}  // namespace gnomon::app::lessons
