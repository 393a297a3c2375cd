// A fuzz target without a fuzzer: its seeds, the files named on the command line (each crash once found is
// kept as one), and a fixed series of mutations of both. The same arguments make the same inputs.
// Usage: fuzz_replay_NAME [--mutations N] [--seed N] [--save FILE] [FILE...]
//        fuzz_replay_NAME --write-seeds DIR       a corpus for libFuzzer to begin with
// The input at work is kept in FILE of --save, so that one that crashes can be kept.
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <random>
#include <sstream>

#include "fuzz_target.h"

namespace {

using Bytes = std::string;
using Random = std::mt19937_64;

std::size_t below(Random& random, std::size_t n) {
  return n == 0 ? 0 : static_cast<std::size_t>(random() % n);
}

// What loaders stumble over: numbers at the ends of their types, unbalanced marks, words that are no numbers.
constexpr const char* fragments[] = {
    "-1", "4294967295", "1e400", "NaN", "Infinity", "0",  "1e-320", "[[[[", "}",
    "\"", "\\u",        "\xff",  "\n",  " ",        "-0", "1e30",   "../",  "99999999999999999999",
    "//", "null"};

void flip_byte(Bytes& bytes, Random& random) {
  if (bytes.empty()) return;
  bytes[below(random, bytes.size())] = static_cast<char>(random());
}
void remove_range(Bytes& bytes, Random& random) {
  const std::size_t from = below(random, bytes.size());
  bytes.erase(from, 1 + below(random, 16));
}
void repeat_range(Bytes& bytes, Random& random) {
  const std::size_t from = below(random, bytes.size());
  const std::size_t to = below(random, bytes.size());
  bytes.insert(to, bytes.substr(from, 1 + below(random, 64)));
}
void insert_fragment(Bytes& bytes, Random& random) {
  const std::size_t to = below(random, bytes.size() + 1);
  bytes.insert(to, fragments[below(random, std::size(fragments))]);
}
// The number at a random place becomes another one.
void replace_number(Bytes& bytes, Random& random) {
  const std::size_t from = bytes.find_first_of("0123456789", below(random, bytes.size()));
  if (from == Bytes::npos) return;
  const std::size_t to = bytes.find_first_not_of("0123456789.eE+-", from);
  bytes.replace(from, (to == Bytes::npos ? bytes.size() : to) - from,
                fragments[below(random, std::size(fragments))]);
}
void cut_off(Bytes& bytes, Random& random) {
  bytes.resize(below(random, bytes.size()));
}

Bytes mutated(Bytes bytes, Random& random) {
  using Mutation = void (*)(Bytes&, Random&);
  constexpr Mutation mutations[] = {flip_byte,       remove_range,   repeat_range,
                                    insert_fragment, replace_number, replace_number};
  const std::size_t count = 1 + below(random, 4);
  for (std::size_t i = 0; i < count && !bytes.empty(); ++i)
    mutations[below(random, std::size(mutations))](bytes, random);
  if (below(random, 16) == 0 && !bytes.empty()) cut_off(bytes, random);
  return bytes;
}

Bytes read(const char* path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    std::fprintf(stderr, "cannot read %s\n", path);
    std::exit(2);
  }
  std::ostringstream out;
  out << file.rdbuf();
  return out.str();
}

struct Options {
  std::size_t mutations = 400;
  std::uint64_t seed = 1;
  std::string save;
  std::vector<Bytes> inputs = gnomon::fuzz::seeds();
};

Options parse(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; ++i) {
    const bool value = i + 1 < argc;
    if (value && std::strcmp(argv[i], "--mutations") == 0)
      options.mutations = std::strtoull(argv[++i], nullptr, 10);
    else if (value && std::strcmp(argv[i], "--seed") == 0)
      options.seed = std::strtoull(argv[++i], nullptr, 10);
    else if (value && std::strcmp(argv[i], "--save") == 0)
      options.save = argv[++i];
    else
      options.inputs.push_back(read(argv[i]));
  }
  return options;
}

int write_seeds(const std::string& folder) {
  int i = 0;
  for (const Bytes& seed : gnomon::fuzz::seeds()) {
    std::ofstream file(folder + "/seed" + std::to_string(i++), std::ios::binary);
    if (!(file << seed) || !file.flush()) {
      std::fprintf(stderr, "cannot write to %s\n", folder.c_str());
      return 4;
    }
  }
  return 0;
}

void run(const Bytes& bytes, const Options& options) {
  if (!options.save.empty()) std::ofstream(options.save, std::ios::binary) << bytes;
  LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 3 && std::strcmp(argv[1], "--write-seeds") == 0) return write_seeds(argv[2]);
  const Options options = parse(argc, argv);
  for (const Bytes& input : gnomon::fuzz::seeds()) run(input, options);
  const gnomon::fuzz::LoadCounts& counts = gnomon::fuzz::load_counts();
  if (counts.loaded != counts.tried) gnomon::fuzz::broken("a seed is refused: " + counts.last_error);
  for (const Bytes& input : options.inputs) run(input, options);
  Random random(options.seed);
  for (std::size_t i = 0; i < options.mutations && !options.inputs.empty(); ++i)
    run(mutated(options.inputs[i % options.inputs.size()], random), options);
  std::printf("%zu inputs and %zu mutations of them", options.inputs.size(), options.mutations);
  if (counts.tried != 0) std::printf(": %zu of %zu files load", counts.loaded, counts.tried);
  std::printf("\n");
}
