#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <vector>

#include "fuzz/fuzz_target.h"

// A fuzzer for every day, where there is no libFuzzer:  fuzz_env SEEDS [MUTATIONS]
// runs a target over all seeds and then over seeded mutations of them, the same ones every time. It
// fails by a crash, an exception, a law that does not hold, an input that takes 20 s or 4 GB.

namespace {

using Bytes = std::vector<std::uint8_t>;

std::vector<Bytes> read_seeds(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());  // the order of the folder is not the same everywhere
  std::vector<Bytes> seeds;
  for (const auto& path : paths) {
    std::ifstream file(path, std::ios::binary);
    seeds.emplace_back(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
  }
  return seeds;
}

class Mutator {
 public:
  explicit Mutator(const std::vector<Bytes>& seeds) : seeds_(seeds) {}

  Bytes operator()() {
    Bytes bytes = seeds_[below(seeds_.size())];
    for (std::size_t i = 1 + below(4); i > 0; --i) mutate(bytes);
    return bytes;
  }

 private:
  std::size_t below(std::size_t n) { return n == 0 ? 0 : std::size_t(random_() % n); }

  void mutate(Bytes& bytes) {
    const auto at = [&](std::size_t i) { return bytes.begin() + std::ptrdiff_t(i); };
    const std::size_t n = bytes.size(), from = below(n), length = std::min(n - from, below(32));
    switch (below(7)) {
      case 0:  // flip a bit
        if (n > 0) bytes[from] ^= std::uint8_t(1U << below(8));
        break;
      case 1:  // another byte
        if (n > 0) bytes[from] = std::uint8_t(below(256));
        break;
      case 2:  // cut a piece out
        bytes.erase(at(from), at(from + length));
        break;
      case 3: {  // a piece twice
        const Bytes piece(at(from), at(from + length));
        bytes.insert(at(below(n)), piece.begin(), piece.end());
        break;
      }
      case 4:  // cut the end off
        bytes.resize(from);
        break;
      case 5: {  // the end of another seed
        const Bytes& other = seeds_[below(seeds_.size())];
        bytes.resize(from);
        bytes.insert(bytes.end(), other.begin() + std::ptrdiff_t(below(other.size())), other.end());
        break;
      }
      default: {  // a word that readers trip over
        constexpr std::string_view words[] = {"0", "-1", "1e308",      "nan", "1000000000",
                                              "'", "/",  ",",          "9*",  "9*9*9",
                                              "-", "\n", "2147483648", "*"};
        const std::string_view word = words[below(std::size(words))];
        bytes.insert(at(from), word.begin(), word.end());
      }
    }
  }

  const std::vector<Bytes>& seeds_;
  std::mt19937_64 random_{20130601};
};

void run(const Bytes& bytes) {
  alarm(20);  // an input that hangs ends the program
  (void)LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) return std::fprintf(stderr, "usage: %s SEEDS [MUTATIONS]\n", argv[0]), 2;
#if !defined(__SANITIZE_ADDRESS__)  // which takes terabytes of addresses
  const rlimit memory{.rlim_cur = rlim_t{4} << 30, .rlim_max = rlim_t{4} << 30};
  setrlimit(RLIMIT_AS, &memory);
#endif
  const std::vector<Bytes> seeds = read_seeds(argv[1]);
  if (seeds.empty()) return std::fprintf(stderr, "%s: no seeds\n", argv[1]), 2;
  for (const Bytes& seed : seeds) run(seed);
  const long mutations = argc > 2 ? std::atol(argv[2]) : 0;
  Mutator mutated(seeds);
  for (long i = 0; i < mutations; ++i) {
    const Bytes bytes = mutated();
    if (const char* name = std::getenv("ASDIC_FUZZ_KEEP"))  // the last one is what failed
      std::ofstream(name, std::ios::binary)
          .write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
    run(bytes);
  }
  std::printf("%zu seeds, %ld mutations\n", seeds.size(), mutations);
  return 0;
}
