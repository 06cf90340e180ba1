/// Runs a fuzz target where libFuzzer does not exist: each file of a corpus that libFuzzer has
/// found natively, and then changes of these files. Equal arguments give equal runs.
///
///   node fuzz_vdag.js RUNS SEED CORPUS_FOLDER [LAST_INPUT_FILE]
///
/// LAST_INPUT_FILE gets each input before it runs, so that the one that ends the program stays.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "support/temp_dir.hpp"

namespace {

constexpr std::size_t kMaxBytes = 4096;  // libFuzzer's default
std::mt19937 rng;

std::size_t below(std::size_t count) { return rng() % count; }

}  // namespace

extern "C" {

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size) {
  for (std::size_t changes = 1 + below(4); changes > 0; --changes) {
    const std::size_t at = size == 0 ? 0 : below(size), length = 1 + below(8);
    switch (size == 0 ? 0 : below(6)) {
      case 0:  // inserts random bytes
        for (std::size_t i = 0; i < length && size < max_size; ++i, ++size) {
          std::copy_backward(data + at, data + size, data + size + 1);
          data[at] = static_cast<std::uint8_t>(rng());
        }
        break;
      case 1:  // erases bytes
        size = static_cast<std::size_t>(
            std::copy(data + std::min(size, at + length), data + size, data + at) - data);
        break;
      case 2:  // copies bytes over others
        for (std::size_t i = 0, from = below(size); i < length; ++i)
          data[(at + i) % size] = data[(from + i) % size];
        break;
      case 3:
        data[at] = below(2) == 0 ? 0xff : 0;
        break;
      case 4:
        data[at] ^= static_cast<std::uint8_t>(1 << below(8));
        break;
      default:
        data[at] = static_cast<std::uint8_t>(data[at] + below(9) - 4);
    }
  }
  return size;
}

__attribute__((weak)) std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                                          std::size_t max_size, unsigned) {
  return LLVMFuzzerMutate(data, size, max_size);
}

}  // extern "C"

int main(int argc, char** argv) {
  if (argc < 4) {
    std::fprintf(stderr, "%s RUNS SEED CORPUS_FOLDER [LAST_INPUT_FILE]\n", argv[0]);
    return 1;
  }
  rng.seed(static_cast<unsigned>(std::atoi(argv[2])));
  std::set<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::directory_iterator(argv[3])) paths.insert(entry.path());
  std::vector<std::string> inputs = {{}};
  for (const auto& path : paths) inputs.push_back(voxdag::read_text(path));
  const auto run = [&](const std::string& input) {
    if (argc > 4) voxdag::write_text(argv[4], input);
    LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(input.data()), input.size());
  };
  for (const std::string& input : inputs) run(input);
  for (long left = std::atol(argv[1]); left > 0; --left) {
    std::string input = inputs[below(inputs.size())].substr(0, kMaxBytes);
    const std::size_t size = input.size();
    input.resize(kMaxBytes);
    input.resize(LLVMFuzzerCustomMutator(reinterpret_cast<std::uint8_t*>(input.data()), size,
                                         kMaxBytes, static_cast<unsigned>(rng())));
    run(input);
    // A grown corpus reaches what one change of a seed does not.
    if (below(16) == 0) inputs[below(inputs.size())] = std::move(input);
  }
  std::printf("%zu files, %s changed ones\n", paths.size(), argv[1]);
  return 0;
}
