#include "studies/sweep/sweep_line.h"

#include <fmt/core.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "scene/base/expected.h"
#include "scene/files/encodings.h"
#include "scene/files/read_file.h"

namespace gnomon::studies {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view checksum_key = "\"checksum\":\"";
constexpr std::size_t checksum_digits = 16;
constexpr std::string_view line_end = "\"}\n";
constexpr std::size_t seal_size = checksum_key.size() + checksum_digits + line_end.size();

/// Returns the checksum of the line without its seal, which begins after the comma or the opening brace.
std::string checksum(std::string_view line) {
  return sha256_hex(line).substr(0, checksum_digits);
}

}  // namespace

std::string path_in(const std::string& folder, std::string_view name) {
  return fmt::format("{}{}{}", folder, folder.ends_with('/') ? "" : "/", name);
}

Expected<std::string> read_as(ErrorKind kind, const std::string& path) {
  auto bytes = read_file(path);
  if (bytes) return bytes;
  Error error = bytes.error();
  error.kind = kind;
  return fail(std::move(error));
}

SweepHeader make_header(std::string configuration, std::size_t cells, Shard shard) {
  SweepHeader header;
  header.hash = sha256_hex(configuration);
  header.configuration = std::move(configuration);
  header.cells = cells;
  header.shard = shard;
  return header;
}

std::string header_json(const SweepHeader& header) {
  const Json json{{"schema", "gnomon/sweep/1"},
                  {"configuration_sha256", header.hash},
                  {"cells", header.cells},
                  {"shard", {{"part", header.shard.part}, {"of", header.shard.of}}},
                  {"configuration", Json::parse(header.configuration)}};
  return plain_lines(json.dump(2)) + "\n";
}

std::optional<std::size_t> cells_of_header(std::string_view text) {
  const Json json = Json::parse(text, nullptr, false);
  if (!json.is_object() || json.value("schema", Json()) != "gnomon/sweep/1") return std::nullopt;
  const Json cells = json.value("cells", Json());
  return cells.is_number_unsigned() ? std::optional(cells.get<std::size_t>()) : std::nullopt;
}

Expected<SweepHeader> read_header(const std::string& folder, ErrorKind unreadable) {
  const std::string path = path_in(folder, "sweep.json");
  const auto bytes = read_as(unreadable, path);
  if (!bytes) return fail(bytes.error());
  const Json json = Json::parse(*bytes, nullptr, false);
  const auto bad = [&path](std::string reason) {
    return fail(Error{ErrorKind::bad_input, std::move(reason), path});
  };
  if (!json.is_object()) return bad("not the configuration of a sweep");
  try {
    if (json.at("schema") != "gnomon/sweep/1") return bad("schema: unknown (allowed gnomon/sweep/1)");
    Shard shard{json.at("shard").at("part").get<int>(), json.at("shard").at("of").get<int>()};
    SweepHeader header =
        make_header(json.at("configuration").dump(), json.at("cells").get<std::size_t>(), shard);
    if (json.at("configuration_sha256") != header.hash) return bad("the configuration was changed by hand");
    return header;
  } catch (const Json::exception& error) {
    return bad(error.what());
  }
}

bool is_sealed(std::string_view line) {
  if (line.size() <= seal_size) return false;
  const std::string_view seal = line.substr(line.size() - seal_size);
  return seal.starts_with(checksum_key) && seal.ends_with(line_end) &&
         seal.substr(checksum_key.size(), checksum_digits) ==
             checksum(line.substr(0, line.size() - seal_size));
}

std::string sealed(const std::string& line) {
  if (is_sealed(line) || !line.ends_with("}\n")) return line;
  std::string out = line.substr(0, line.size() - 2);
  if (!out.ends_with('{')) out += ',';
  const std::string sum = checksum(out);
  return out.append(checksum_key).append(sum).append(line_end);
}

std::string axes_of_line(const Json& line) {
  if (!line.is_object() || !line.contains("lights")) return {};
  return line.value("axes", Json::object()).dump();
}

std::string drawer_of_line(const Json& line) {
  if (!line.is_object() || !line.contains("gl")) return {};
  return line["gl"].value("backend", "") + ", " + line["gl"].value("renderer", "");
}

}  // namespace gnomon::studies
