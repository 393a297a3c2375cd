// What a command of the program costs: a process of its own, as a user starts it.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"

namespace gnomon::bench {

using Words = std::vector<std::string>;

/// Of one process: seconds by the clock and of the processor, and the most memory that it held at a time, bytes.
struct Cost {
  double wall = 0.0, processor = 0.0, memory = 0.0;
};

/// Of two processes one after the other.
Cost operator+(const Cost& a, const Cost& b);

/// Runs the program with these words; ends the benchmark where it fails.
Cost cost_of(Words words);

/// The least of several runs, each by itself: other programs only ever add.
struct Least {
  Cost cost{1e30, 1e30, 1e30};
  void add(const Cost& run);
};

/// Writes the scene as binary glTF, and returns the path; ends the benchmark where it cannot.
std::string written_glb(const Scene& scene, const std::string& path);

}  // namespace gnomon::bench
