// SPDX-License-Identifier: Apache-2.0
// Entry point of libFuzzer. --target=NAME selects the target; other options go to libFuzzer.
#include "tests/fuzz/fuzz_target.h"

#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace {

const fathom::testing::FuzzTarget* chosen = nullptr; // global, because libFuzzer calls two C functions

}

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
    for (int i = 1; i < *argc; ++i) {
        for (const auto& target : fathom::testing::fuzzTargets()) {
            if (std::strcmp((*argv)[i], (std::string("--target=") + target.name).c_str()) == 0) {
                chosen = &target;
            }
        }
    }
    if (chosen == nullptr) {
        std::fprintf(stderr, "--target: missing (allowed:");
        for (const auto& target : fathom::testing::fuzzTargets()) {
            std::fprintf(stderr, " %s", target.name);
        }
        std::fprintf(stderr, ")\n");
        std::exit(2);
    }
    return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    fathom::testing::runFuzzTarget(*chosen, {data, size});
    return 0;
}
