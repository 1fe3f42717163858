// SPDX-License-Identifier: Apache-2.0
// The short run of the tests: every target reads every file of its corpus, which includes findings of earlier
// long runs, and then mutations of these. Works with any compiler. The long run that searches for new
// findings is `./run fuzz`.
//   fuzz_tests MUTATIONS [TARGET...]
#include "tests/fuzz/fuzz_target.h"

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include <fcntl.h>
#include <unistd.h>

#if defined(FATHOM_SANITIZED)
#include <sanitizer/common_interface_defs.h>
#endif

namespace {

using namespace fathom::testing;
using Input = std::vector<uint8_t>;

constexpr size_t kMaxBytes = 1 << 16;
const char* const kLastInput = "fuzz-finding";

const Input* current = nullptr; // for keepInput(), called by a signal or a sanitizer
pid_t own = 0;                  // a child process that crashes on a mesh rejects the input; not a finding

void keepInput() {
    if (::getpid() != own) {
        return;
    }
    const int file = ::open(kLastInput, O_CREAT | O_TRUNC | O_WRONLY, 0600);
    if (current != nullptr && file >= 0 && ::write(file, current->data(), current->size()) >= 0) {
        constexpr char kMessage[] = "the input is in the file fuzz-finding\n";
        [[maybe_unused]] const auto written = ::write(2, kMessage, sizeof kMessage - 1);
    }
}

void onAbort(int) {
    keepInput(); // returns to abort(), which ends the process
}

std::vector<Input> corpusOf(const FuzzTarget& target) {
    std::vector<std::filesystem::path> files;
    for (const auto& entry :
         std::filesystem::directory_iterator(std::filesystem::path("tests/fuzz/corpus") / target.name)) {
        files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    std::vector<Input> corpus;
    for (const auto& file : files) {
        std::ifstream in(file, std::ios::binary);
        corpus.emplace_back(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
    }
    return corpus;
}

class Mutator {
public:
    explicit Mutator(const std::vector<Input>& corpus)
        : corpus_(corpus) {}

    Input next() {
        Input input = corpus_[below(corpus_.size())];
        for (size_t i = 1 + below(4); i-- > 0;) {
            change(input);
        }
        input.resize(std::min(input.size(), kMaxBytes));
        return input;
    }

private:
    size_t below(size_t n) { return n == 0 ? 0 : static_cast<size_t>(random_() % n); }

    void change(Input& input) {
        const size_t at = below(input.size());
        const auto place = [&] { return input.begin() + static_cast<long>(at); };
        switch (below(7)) {
        case 0: // flip a bit
            if (!input.empty()) {
                input[at] ^= static_cast<uint8_t>(1u << below(8));
            }
            break;
        case 1: // truncate
            input.resize(at);
            break;
        case 2: // remove bytes
            input.erase(place(), place() + static_cast<long>(std::min(input.size() - at, 1 + below(8))));
            break;
        case 3: { // repeat bytes
            const Input again(place(),
                              place() + static_cast<long>(std::min(input.size() - at, 1 + below(64))));
            input.insert(place(), again.begin(), again.end());
            break;
        }
        case 4: { // overwrite with an extreme number
            constexpr uint64_t kExtremes[] = {0,          ~0ull, 0x7fffffff, 0x80000000, 0x7ff8000000000000,
                                              0x7f800000, 1};
            const uint64_t value = kExtremes[below(std::size(kExtremes))];
            for (size_t i = 0, size = size_t{1} << below(4); i < size && at + i < input.size(); ++i) {
                input[at + i] = static_cast<uint8_t>(value >> (8 * i));
            }
            break;
        }
        case 5: { // insert a difficult token
            constexpr const char* kWords[] = {"nan", "-1", "1e999", "4294967296", "../../", "[",
                                              "{",   "\n", " ",     "&a *a",      "0"};
            const std::string word = kWords[below(std::size(kWords))];
            input.insert(place(), word.begin(), word.end());
            break;
        }
        default: { // append the rest of another input
            const Input& other = corpus_[below(corpus_.size())];
            const auto from = other.begin() + static_cast<long>(below(other.size()));
            input.resize(at);
            input.insert(input.end(), from, other.end());
        }
        }
    }

    const std::vector<Input>& corpus_;
    std::mt19937_64 random_{20130613};
};

bool run(const FuzzTarget& target, const Input& input) {
    current = &input;
    return runFuzzTarget(target, input);
}

} // namespace

int main(int argc, char** argv) {
    own = ::getpid();
    const long mutations = argc > 1 ? std::strtol(argv[1], nullptr, 10) : 1000;
    std::signal(SIGABRT, onAbort);
#if defined(FATHOM_SANITIZED)
    __sanitizer_set_death_callback(keepInput);
#endif
    size_t passed = 0, failed = 0, runs = 0;
    for (const FuzzTarget& target : fuzzTargets()) {
        if (argc > 2 && std::find(argv + 2, argv + argc, std::string(target.name)) == argv + argc) {
            continue;
        }
        const std::vector<Input> corpus = corpusOf(target);
        size_t taken = 0, mutatedTaken = 0;
        for (const Input& input : corpus) {
            taken += run(target, input) ? 1 : 0;
            ++passed;
        }
        if (taken == 0) { // a corpus of rejected inputs exercises nothing
            std::fprintf(stderr, "ERROR: fuzz target %s: no input of its corpus is taken\n", target.name);
            ++failed;
            continue;
        }
        Mutator mutator(corpus);
        const long asked = mutations / target.dear;
        for (long i = 0; i < asked; ++i) {
            mutatedTaken += run(target, mutator.next()) ? 1 : 0;
        }
        runs += corpus.size() + static_cast<size_t>(asked);
        ++passed;
        std::printf("%-14s %zu of %zu seeds taken, %zu of %ld mutations\n", target.name, taken, corpus.size(),
                    mutatedTaken, asked);
    }
    std::printf("%zu runs\nfuzz: %zu passed, %zu failed\n", runs, passed, failed);
    return failed > 0 ? 1 : 0;
}
