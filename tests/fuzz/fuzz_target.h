// What every fuzz target offers, besides libFuzzer's own entry point: inputs worth mutating. A target runs
// under libFuzzer (clang, GNOMON_FUZZ) or under fuzz_replay.cpp, which replays its seeds and a fixed series
// of mutations of them with any compiler. A target aborts, with a line on stderr, on anything that must not
// be.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "scene/base/expected.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace gnomon::fuzz {

/// Well-formed inputs of the target, small.
std::vector<std::string> seeds();

/// Loads the bytes as a file with this extension (".obj"), confined to its folder. Aborts unless the outcome
/// is a sound scene or a one-line error of a kind that a file may cause.
void load_as(std::string_view extension, const std::uint8_t* data, std::size_t size);
/// Loads a file that is there.
void load(const std::string& path);

/// A folder for all of a process's inputs, gone with it.
const std::string& folder();
/// The bytes as a file of that folder; its path.
std::string put(const std::string& name, std::string_view bytes);
/// Counts a file that was read (no error), or one that was refused. Aborts unless that is with one line and for a
/// reason that lies in the file.
void note_read(const Error* error);

/// What was read so far.
struct LoadCounts {
  std::size_t tried = 0, loaded = 0;
  std::string last_error;
};
const LoadCounts& load_counts();

/// Ends the process for the fuzzer to see.
[[noreturn]] void broken(const std::string& what);

}  // namespace gnomon::fuzz
