// SPDX-License-Identifier: Apache-2.0
// What observers of the view socket get, at which pace they read.
#include "apps/binding/view_publisher.h"

#include "tests/devices/socket_rig.h"

#include <vector>

using namespace fathom;
using namespace fathom::testing;

namespace {

constexpr size_t kEveryPixel = 300000; // spheres of 640x480 pixels

HostFixtures viewedSet(uint64_t generation, size_t spheres) {
    HostFixtures set;
    set.frame = static_cast<int64_t>(generation);
    set.generation = generation;
    for (size_t i = 0; i < spheres; ++i) {
        set.spheres.add(dvec3(static_cast<double>(i), 0.0, 0.0), 0.01);
    }
    return set;
}

// Reads at its own pace, and checks that each set that begins also ends.
struct Viewer {
    explicit Viewer(const std::filesystem::path& path)
        : end(DeviceSocket::connect(path)) {}

    void read(size_t most) {
        union {
            fathom_door_header header;
            fathom_door_state state;
            fathom_door_regions regions;
            fathom_door_fixtures fixtures;
        } packet;
        for (size_t i = 0; i < most; ++i) {
            const SocketEvent event = end.receive(packet.regions, FATHOM_DOOR_REGIONS);
            if (event == SocketEvent::Empty) {
                return;
            }
            REQUIRE(event != SocketEvent::Closed);
            gaps += packet.header.sequence - sequence - 1;
            sequence = packet.header.sequence;
            states += packet.header.kind == FATHOM_DOOR_STATE ? 1 : 0;
            fixtures += packet.header.kind == FATHOM_DOOR_FIXTURES ? 1 : 0;
            if (event == SocketEvent::Packet) {
                take(packet.regions);
            }
        }
    }
    void take(const fathom_door_regions& part) {
        CHECK(part.first == received);
        CHECK((received == 0 || part.generation == begun));
        CHECK(part.spheres[part.count - 1].x == static_cast<float>(part.first + part.count - 1));
        begun = part.generation;
        received += part.count;
        if (received == part.total) {
            whole.push_back(begun);
            received = 0;
        }
    }

    DeviceSocket end;
    std::vector<uint64_t> whole; // generations of complete sets
    uint64_t begun = 0, received = 0, sequence = 0, gaps = 0, states = 0, fixtures = 0;
};

} // namespace

TEST_CASE(
    "An observer that reads once per displayed frame gets a set of every pixel whole, and loses no state") {
    const SocketFolder folder;
    ViewPublisher publisher(folder.endpoint());
    Viewer viewer(folder.endpoint());
    const HostFixtures set = viewedSet(1, kEveryPixel);
    publisher.frame(set);
    uint64_t ticks = 0;
    for (; ticks < 33 * 400 && viewer.whole.empty(); ++ticks) {
        publisher.step({});
        if (ticks % 33 == 32) {
            viewer.read(10000);
        }
    }
    CHECK(viewer.whole == std::vector<uint64_t>{1});
    for (int i = 0; i < 100; ++i, ++ticks) { // the same set is not sent again
        publisher.step({});
        viewer.read(10000);
    }
    CHECK(viewer.whole.size() == 1);
    CHECK(viewer.received == 0);
    CHECK(viewer.fixtures == 1);
    CHECK(viewer.states == ticks);
    CHECK(viewer.gaps == 0);
}

TEST_CASE("An observer that is slower than the sets skips whole sets, and ends with the newest one") {
    const SocketFolder folder;
    ViewPublisher publisher(folder.endpoint());
    Viewer slow(folder.endpoint()), fast(folder.endpoint()), stalled(folder.endpoint());
    constexpr uint64_t kSets = 30;
    HostFixtures before, now;
    for (uint64_t generation = 1; generation <= kSets; ++generation) {
        before = std::exchange(now, viewedSet(generation, kEveryPixel / 4));
        publisher.frame(now);
        before = {}; // only the newest set stays valid
        for (int i = 0; i < 33; ++i) {
            publisher.step({});
            slow.read(3);
            fast.read(10000);
        }
    }
    CHECK(eventually([&] {
        publisher.step({});
        slow.read(100);
        fast.read(10000);
        return !slow.whole.empty() && slow.whole.back() == kSets && fast.whole.back() == kSets;
    }));
    CHECK(slow.whole.size() < kSets);
    CHECK(slow.whole.size() > 3);
    CHECK(fast.whole.size() == kSets);
    CHECK(fast.gaps == 0);
    stalled.read(100000); // all of its full queue
    publisher.step({});
    stalled.read(1);
    CHECK(stalled.gaps > 0); // states that it lost
}

TEST_CASE("An observer that comes later gets the newest set, and none of a run that was forgotten") {
    const SocketFolder folder;
    ViewPublisher publisher(folder.endpoint());
    const auto tick = [&](Viewer& viewer) {
        for (int i = 0; i < 100; ++i) {
            publisher.step({});
            viewer.read(1000);
        }
    };
    Viewer first(folder.endpoint());
    const HostFixtures set = viewedSet(1, 1000);
    publisher.frame(set);
    tick(first);
    Viewer second(folder.endpoint());
    tick(second);
    CHECK(second.whole == std::vector<uint64_t>{1});
    CHECK(second.fixtures == 1);
    CHECK(second.gaps == 0);
    publisher.forget();
    Viewer third(folder.endpoint());
    tick(third);
    CHECK(third.whole.empty());
    const HostFixtures next = viewedSet(2, 1000);
    publisher.frame(next);
    tick(third);
    CHECK(third.whole == std::vector<uint64_t>{2});
    first.read(1000);
    CHECK(first.whole == std::vector<uint64_t>{1, 2});
}
