// Named arrays of a page's data: what each is predicted from, and all of them packed side by side on all
// cores.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "report/pixels/packing.h"
#include "scene/math.h"

namespace gnomon::report {

/// Numbers as the page rounds them.
std::uint32_t integer(double value);
/// integer(std::round(value))
std::uint32_t rounded(double value);

// All arrays of a page. Until they are packed their text is empty in the JSON, where nothing else is called
// "data".
class Packer {
 public:
  using Numbers = std::function<std::vector<std::uint32_t>()>;

  /// What is said of an array beside its text. `numbers`, `sources`, and what they refer to, must last until
  /// run().
  nlohmann::ordered_json add(const PackOptions& options, Numbers numbers, const Sources* sources = nullptr);
  std::size_t count() const { return jobs_.size(); }
  void run();
  /// The JSON with the texts of its arrays, the first of them that of job `first`.
  std::string filled(const nlohmann::ordered_json& json, std::size_t first) const;

 private:
  struct Job {
    PackOptions options;
    Numbers numbers;
    const Sources* sources;
    std::string text;
  };
  std::vector<Job> jobs_;
};

// Some of them, by name.
class Channels {
 public:
  /// `surface`: the sources of From::surface.
  explicit Channels(Packer& packer, const Sources* surface = nullptr) : packer_(packer), surface_(surface) {}

  /// `minus`: the channel that `value` has subtracted already, and the page adds again.
  template <class Value>
  void add(const std::string& name, std::size_t count, const PackOptions& options, const Value& value,
           std::string_view minus = {}) {
    json_[name] = packer_.add(
        options,
        [count, value] {
          std::vector<std::uint32_t> numbers(count);
          for (std::size_t i = 0; i < count; ++i) numbers[i] = value(i);
          return numbers;
        },
        surface_);
    if (!minus.empty()) json_[name]["minus"] = minus;
  }
  /// The numbers of a channel that is there.
  void add_same(const std::string& name, const std::string& as) { json_[name] = {{"same", as}}; }
  const nlohmann::ordered_json& json() const { return json_; }

 private:
  Packer& packer_;
  const Sources* surface_;
  nlohmann::ordered_json json_ = nlohmann::ordered_json::object();
};

}  // namespace gnomon::report
