// SPDX-License-Identifier: Apache-2.0
#include "engine/model/reader_process.h"

#include "engine/types/error.h"

#include <csignal>
#include <doctest/doctest.h>
#include <stdexcept>
#include <vector>

using namespace fathom;

namespace {

ReaderEnd endOf(const std::function<void()>& work) {
    const auto read = [&](int) {
        work();
        return true;
    };
    return runReader("x.dae", {read, [](int) { return true; }});
}

#ifdef __SANITIZE_ADDRESS__
// Reads one past the end, through a volatile to hide it from the compiler.
void readBeyond() {
    const std::vector<int> four(4, 1);
    const volatile size_t beyond = 4;
    const volatile int seen = four.data()[beyond];
    static_cast<void>(seen);
}
#endif

} // namespace

TEST_CASE("A reader killed by a signal reports which, and one that exits normally reports none") {
    CHECK(endOf([] {}).signal == 0);
    CHECK(endOf([] { ::raise(SIGSEGV); }).signal == SIGSEGV);
    CHECK(broken("mesh reader", endOf([] { ::raise(SIGABRT); })) == "breaks the mesh reader (signal 6)");
}

#ifdef __SANITIZE_ADDRESS__
TEST_CASE("A sanitizer report of a reader is a finding, unless it occurred in the library") {
    CHECK_THROWS_AS(endOf(readBeyond), std::logic_error);
    CHECK(endOf([] {
              const LibraryAtWork library;
              readBeyond();
          }).signal == 0);
    CHECK_THROWS_AS(endOf([] {
                        { const LibraryAtWork library; }
                        readBeyond();
                    }),
                    std::logic_error);
}
#endif
