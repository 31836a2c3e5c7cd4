// Runs a fuzz target without libFuzzer: first on each seed, then on mutations of the seeds.
//
//   X_fuzzer SEED_FOLDER_OR_FILE [MUTATIONS [RANDOM_SEED]]
//
// A crash or an uncaught exception ends the program. The last input then remains in ./X_fuzzer.last_input.

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "fuzz/fuzz_target.h"

namespace
{
namespace fs = std::filesystem;
using Bytes = std::string;

std::vector<Bytes> readSeeds(const fs::path& path)
{
  std::vector<fs::path> files;
  if (fs::is_directory(path))
    std::copy(fs::directory_iterator(path), fs::directory_iterator(), std::back_inserter(files));
  else
    files.push_back(path);
  std::sort(files.begin(), files.end());
  std::vector<Bytes> seeds;
  for (const fs::path& file : files)
  {
    std::ifstream stream(file, std::ios::binary);
    seeds.emplace_back(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>());
  }
  return seeds;
}

/// Makes changes that typically break formats: flipped bits, extreme numbers, wrong lengths, and parts that are lost,
/// repeated or taken from another seed.
class Mutator
{
 public:
  Mutator(const std::vector<Bytes>& seeds, unsigned seed) : seeds_(seeds), random_(seed) {}

  Bytes next()
  {
    Bytes bytes = any(seeds_);
    for (std::size_t i = 0, changes = 1 + below(4); i < changes; ++i)
      change(bytes);
    return bytes;
  }

 private:
  std::size_t below(std::size_t bound) { return bound == 0 ? 0 : random_() % bound; }
  const Bytes& any(const std::vector<Bytes>& list) { return list[below(list.size())]; }

  void change(Bytes& bytes)
  {
    static const std::vector<Bytes> tokens = {"nan",
                                              "1e999",
                                              "-1",
                                              "0",
                                              "99999999999999999999",
                                              "%2e%2e",
                                              "\"",
                                              "<",
                                              ">",
                                              "/",
                                              "\n",
                                              "- ",
                                              ": ",
                                              "{",
                                              "[",
                                              "&a ",
                                              "*a",
                                              "---\n",
                                              "..",
                                              "'",
                                              "<!--",
                                              "]]>",
                                              "\t",
                                              "\x80",
                                              "&#0;",
                                              std::string(4, '\0'),
                                              std::string(4, '\xff')};
    const std::size_t at = below(bytes.size() + 1);
    const std::size_t length = below(std::min<std::size_t>(bytes.size() - at, 64) + 1);
    switch (below(6))
    {
      case 0:
        if (at < bytes.size())
          bytes[at] = static_cast<char>(bytes[at] ^ (1 << below(8)));
        break;
      case 1:
        bytes.erase(at, length);
        break;
      case 2:
        bytes.insert(at, any(tokens));
        break;
      case 3:
        bytes.replace(at, length, any(tokens));
        break;
      case 4:
        bytes.insert(below(bytes.size() + 1), bytes.substr(at, length));
        break;
      default:
      {
        const Bytes& other = any(seeds_);
        const std::size_t from = below(other.size() + 1);
        bytes.replace(at, length, other.substr(from, below(128)));
      }
    }
  }

  const std::vector<Bytes>& seeds_;
  std::mt19937 random_;
};

void run(const std::string& program, const Bytes& bytes)
{
  std::ofstream(program + ".last_input", std::ios::binary)
      .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
}
}  // namespace

int main(int argc, char** argv)
{
  if (argc < 2)
  {
    std::fprintf(stderr, "usage: %s SEED_FOLDER_OR_FILE [MUTATIONS [RANDOM_SEED]]\n", argv[0]);
    return 2;
  }
  const std::vector<Bytes> seeds = readSeeds(argv[1]);
  const unsigned long mutations = argc > 2 ? std::strtoul(argv[2], nullptr, 10) : 0;
  const auto random_seed =
      argc > 3 ? static_cast<unsigned>(std::strtoul(argv[3], nullptr, 10)) : std::random_device{}();
  std::printf("%zu seeds, %lu mutations, random seed %u\n", seeds.size(), mutations, random_seed);
  std::fflush(stdout);
  if (seeds.empty())
    return 1;
  const std::string program = fs::path(argv[0]).filename().string();
  for (const Bytes& seed : seeds)
    run(program, seed);
  Mutator mutator(seeds, random_seed);
  for (unsigned long i = 0; i < mutations; ++i)
    run(program, mutator.next());
  fs::remove(program + ".last_input");
  return 0;
}
