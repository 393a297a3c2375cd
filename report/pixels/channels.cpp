#include "report/pixels/channels.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "scene/base/parallel.h"

namespace gnomon::report {

std::uint32_t integer(double value) {
  constexpr double limit = 2147483647.0;
  return std::isnan(value)
             ? 0u
             : static_cast<std::uint32_t>(static_cast<std::int32_t>(std::clamp(value, -limit, limit)));
}

// What is added is the largest number below one half, so that nothing else is rounded up with the halves.
// std::round is a call for each of some forty million numbers.
std::uint32_t rounded(double value) {
  constexpr double almost_half = 0.49999999999999994;
  return integer(value + std::copysign(almost_half, value));
}

nlohmann::ordered_json Packer::add(const PackOptions& options, Numbers numbers, const Sources* sources) {
  jobs_.push_back({options, std::move(numbers), sources, {}});
  constexpr std::array<std::string_view, 3> names{"nothing", "previous", "surface"};
  nlohmann::ordered_json json{{"bytes", options.bytes},
                              {"from", names[static_cast<std::size_t>(options.from)]}};
  if (options.unit != 1) json["unit"] = options.unit;
  json["data"] = "";
  return json;
}

void Packer::run() {
  parallel_tasks(jobs_.size(), [&](std::size_t i) {
    jobs_[i].text = packed(jobs_[i].numbers(), jobs_[i].options, jobs_[i].sources);
  });
}

std::string Packer::filled(const nlohmann::ordered_json& json, std::size_t first) const {
  constexpr std::string_view empty = "\"data\":\"\"";
  const std::string bare = json.dump();
  std::size_t size = bare.size(), copied = 0;
  for (std::size_t i = first; i < jobs_.size(); ++i) size += jobs_[i].text.size();
  std::string text;
  text.reserve(size);
  for (std::size_t at = bare.find(empty); at != std::string::npos; at = bare.find(empty, copied)) {
    const std::size_t place = at + empty.size() - 1;
    text.append(bare, copied, place - copied).append(jobs_[first++].text);
    copied = place;
  }
  return text.append(bare, copied);
}

}  // namespace gnomon::report
