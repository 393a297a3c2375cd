// What a sweep left behind: sweep.json, sweep.jsonl and sweep_times.jsonl, parted by form feeds, as merge and the page
// read them and as a sweep that goes on does.
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "fuzz_target.h"
#include "studies/sweep/journal.h"
#include "studies/sweep/summary.h"

namespace {

using namespace gnomon;

std::string line(int cell) {
  return studies::sealed(
      R"({"schema":"gnomon/result/1","lights":[{"light":{"name":"sun","type":"directional"},"error":{"wrong":)" +
      std::to_string(cell) +
      R"(},"budget":[],"ladder":[]}],"gl":{"backend":"osmesa","renderer":"llvmpipe"},)"
      R"("size":{"width":2,"height":1},"costs":{},"axes":{"bias":)" +
      std::to_string(cell) + "}}\n");
}

studies::SweepHeader header() {
  return studies::make_header(R"({"axes":[{"name":"bias","values":["0","1"]}]})", 2, {});
}

}  // namespace

namespace {

/// The lines with checksums that fit what they have become.
std::string sealed_again(const std::string& lines) {
  std::istringstream in(lines);
  std::string out;
  for (std::string text; std::getline(in, text);) {
    const std::size_t seal = text.rfind(R"(,"checksum")");
    out += studies::sealed(text.substr(0, seal) + (seal == std::string::npos ? "\n" : "}\n"));
  }
  return out;
}

void check_folder() {
  const auto sweep = studies::read_sweep(fuzz::folder());
  fuzz::note_read(sweep ? nullptr : &sweep.error());
  if (sweep) {
    for (const std::string& text : sweep->lines)
      studies::drawer_of_line(nlohmann::ordered_json::parse(text, nullptr, false));
    if (const auto read = studies::summarise(*sweep); !read && read.error().kind != ErrorKind::bad_input)
      fuzz::broken("an error of another kind: " + read.error().message());
  }
  const auto journal =
      studies::Journal::open(fuzz::folder(), header(), {R"({"bias":0})", R"({"bias":1})"}, {0, 1});
  // What is no sweep's file is one that cannot be written.
  if (!journal && journal.error().kind != ErrorKind::bad_input && journal.error().kind != ErrorKind::usage &&
      journal.error().kind != ErrorKind::cannot_write)
    fuzz::broken("an error of another kind: " + journal.error().message());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  for (const bool again : {false, true}) {
    std::istringstream in(bytes);
    for (const char* name : {"sweep.json", "sweep.jsonl", "sweep_times.jsonl"}) {
      std::string part;
      std::getline(in, part, '\f');
      fuzz::put(name, again && std::string_view(name) != "sweep.json" ? sealed_again(part) : part);
    }
    check_folder();
  }
  return 0;
}

std::vector<std::string> gnomon::fuzz::seeds() {
  const std::string times = studies::sealed("{\"cell\":0}\n");
  return {studies::header_json(header()) + "\f" + line(0) + line(1) + "\f" + times + times,
          studies::header_json(header()) + "\f" + line(0) + "\f" + times};
}
