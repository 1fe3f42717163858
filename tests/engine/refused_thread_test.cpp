// SPDX-License-Identifier: Apache-2.0
// A system that starts no more threads (RLIMIT_NPROC, a limit of processes of a container). Not under
// sanitizers, which replace pthread_create themselves.
#include "tests/engine/wall_world.h"

#include <cerrno>
#include <dlfcn.h>
#include <doctest/doctest.h>
#include <pthread.h>
#include <string_view>

#ifndef FATHOM_SANITIZED

using namespace fathom;
using namespace fathom::testing;

namespace {

thread_local int refusedThread = 0; // number of the std::thread, from now, that is refused; 0 = none

// Drivers start threads, too.
bool isStdThread(const void* caller) {
    Dl_info from{};
    return ::dladdr(caller, &from) != 0 &&
           std::string_view(from.dli_fname).find("libstdc++") != std::string_view::npos;
}

} // namespace

extern "C" __attribute__((visibility("default"))) int
pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*run)(void*), void* argument) {
    static const auto kNext =
        reinterpret_cast<decltype(&pthread_create)>(::dlsym(RTLD_NEXT, "pthread_create"));
    if (refusedThread > 0 && isStdThread(__builtin_return_address(0)) && --refusedThread == 0) {
        return EAGAIN;
    }
    return kNext(thread, attributes, run, argument);
}

TEST_CASE("Whichever thread cannot be started, an engine ends those that were, and throws") {
    int refused = 0; // threads of an engine
    for (bool opened = false; !opened; ++refused) {
        refusedThread = refused + 1;
        try {
            const Engine engine(wallScene(), smallCamera());
            opened = true;
        } catch (const Error&) {
        }
    }
    refusedThread = 0;
    CHECK(refused > 3); // frames, contacts, clearance
}

#endif
