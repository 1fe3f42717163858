// SPDX-License-Identifier: Apache-2.0
#include "devices/reconnector.h"

#include "tests/support/eventually.h"

#include <atomic>
#include <doctest/doctest.h>

#include <fcntl.h>
#include <unistd.h>

namespace fathom::testing {
namespace {

int openNothing() {
    return ::open("/dev/null", O_RDONLY | O_CLOEXEC);
}

bool isOpen(int descriptor) {
    return ::fcntl(descriptor, F_GETFD) >= 0;
}

TEST_CASE("A lost descriptor is closed on another thread, and the device is tried until it is back") {
    std::atomic<int> attempts{0}, given{-1};
    Reconnector reconnector([&] {
        given = ++attempts < 3 ? -1 : openNothing();
        return given.load();
    });
    CHECK(reconnector.take() == -1);
    CHECK(attempts.load() == 0); // nothing is lost
    const int lost = openNothing();
    reconnector.lose(lost);
    int found = -1;
    CHECK(eventually([&] { return (found = reconnector.take()) >= 0; }));
    CHECK(attempts.load() == 3);
    CHECK(found == given.load());
    CHECK((found == lost || !isOpen(lost))); // its number may be in use again
    CHECK(reconnector.take() == -1);
    ::close(found);
}

TEST_CASE("At its end a reconnector closes the device not taken, and the lost one without a reopen") {
    std::atomic<int> given{-1};
    const int lost = openNothing();
    {
        Reconnector reconnector([&] {
            const int next = openNothing();
            given = next;
            return next;
        });
        reconnector.lose(lost);
        CHECK(eventually([&] { return given.load() >= 0; }));
    }
    CHECK_FALSE(isOpen(given.load()));
    const int last = openNothing();
    {
        Reconnector never({});
        never.lose(last);
        CHECK(never.take() == -1);
    }
    CHECK_FALSE(isOpen(last));
}

TEST_CASE("A reconnector calls its other function in each round, also while nothing is lost") {
    std::atomic<int> rounds{0};
    const Reconnector reconnector([] { return -1; }, [&] { ++rounds; });
    CHECK(eventually([&] { return rounds.load() > 1; }));
}

} // namespace
} // namespace fathom::testing
