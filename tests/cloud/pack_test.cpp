// SPDX-License-Identifier: Apache-2.0
// What the host reads, packed or beside the points, against the slots, one by one and in order.
#include "tests/support/cloud_rig.h"

#include <doctest/doctest.h>
#include <map>
#include <set>

using namespace fathom;
using namespace fathom::test;

namespace {

struct Expected {
    std::vector<reference::RegionSphere> spheres;
    std::vector<uint32_t> sources;
};

// Every sphere of the slots by patch, then layer, then slot.
Expected inOrder(const CloudRig& rig) {
    const std::vector<reference::RegionSphere> layers[2] = {
        rig.slotSpheres(false),
        rig.plan().hold ? rig.slotSpheres(true) : std::vector<reference::RegionSphere>()};
    const auto width = static_cast<uint32_t>(rig.width()),
               pixels = width * static_cast<uint32_t>(rig.height());
    const uint32_t across = rig.cycle().layout().across;
    std::vector<uint32_t> pixelOf(rig.cycle().layout().slots(), ~0u);
    for (uint32_t p = 0; p < pixels; ++p) {
        pixelOf[slotOfPixel(p % width, p / width, across)] = p;
    }
    Expected all;
    for (size_t place = 0; place < 2 * pixelOf.size(); ++place) {
        const size_t layer = place / 256 % 2, slot = place / 512 * 256 + place % 256;
        const uint32_t pixel = pixelOf[slot];
        if (pixel == ~0u || layers[layer].empty() || layers[layer][pixel].radius < 0.0) {
            continue;
        }
        all.spheres.push_back(layers[layer][pixel]);
        all.sources.push_back(pixel + (layer != 0 ? pixels : 0));
    }
    return all;
}

// The device's own choice is one of them only. A tree keeps slots beside what is packed.
CloudRig::Change packing(bool pack) {
    return [pack](Plan& plan) { plan.pack = plan.byPixel = plan.tree = pack; };
}

void checkPacked(const CloudRig& rig) {
    const Expected all = inOrder(rig);
    const RegionSpheres& host = rig.host().spheres;
    CHECK((rig.plan().query == Plan::Query::Gpu || rig.set().keys.empty()));
    REQUIRE(host.size() == all.spheres.size());
    CHECK((rig.counters().packedWords > 0) == (rig.plan().pack && !all.spheres.empty()));
    size_t wrong = 0;
    for (size_t i = 0; i < all.spheres.size(); ++i) {
        const reference::RegionSphere& s = all.spheres[i];
        const dvec3 centre = dvec3(host.x[i], host.y[i], host.z[i]) + rig.origin();
        wrong += centre != s.centre || host.radius[i] != s.radius || host.source[i] != all.sources[i] ||
                 (s.cls >= 0 && host.fixture[i] != static_cast<uint8_t>(s.cls));
    }
    CHECK(wrong == 0);
}

} // namespace

TEST_CASE("What the host reads has every sphere of every slot once, in order, at sizes that are not whole "
          "patches") {
    for (const glm::uvec2 size :
         std::initializer_list<glm::uvec2>{{1, 1}, {16, 16}, {17, 33}, {67, 41}, {320, 240}}) {
        const uint32_t width = size.x, height = size.y;
        CAPTURE(width);
        CAPTURE(height);
        const CameraInfo camera = pinholeCamera(width, height);
        for (const bool pack : {false, true}) {
            CloudRig rig(plainScene(), camera, packing(pack));
            rig.run(stressPicture(camera, width));
            checkPacked(rig);
        }
    }
}

TEST_CASE("Held spheres follow the seen ones of their patch, thinned ones are left out") {
    const CameraInfo camera = pinholeCamera(130, 70);
    Scene scene = plainScene();
    scene.holdSeconds = 1.0;
    scene.errorBudget = 0.001;
    bool pack = false;
    SUBCASE("read from slots") {}
    SUBCASE("packed") {
        pack = true;
    }
    CloudRig rig(scene, camera, packing(pack));
    const Picture whole = drawnPicture(camera, [](int u, int) { return 1.0 + 0.001 * u; });
    rig.run(whole);
    checkPacked(rig);
    Picture holes = whole;
    for (size_t p = 0; p < holes.depth.size(); p += 3) {
        holes.depth[p] = 0;
    }
    rig.run(holes);
    checkPacked(rig);
    CHECK(std::any_of(rig.host().spheres.source.begin(), rig.host().spheres.source.end(),
                      [](uint32_t source) { return source >= 130 * 70; }));
}

TEST_CASE("A picture without one point, with few over the corner of four patches, and with every point") {
    const CameraInfo camera = pinholeCamera(66, 50);
    for (const int points : {0, 16, 66 * 50}) {
        CAPTURE(points);
        CloudRig rig(plainScene(), camera, packing(true));
        rig.run(drawnPicture(camera, [&](int u, int v) {
            return points > 16 || (points == 16 && (u + 2) / 4 == 12 && (v + 2) / 4 == 8) ? 1.0 : 0.0;
        }));
        CHECK(rig.host().spheres.size() == static_cast<size_t>(points));
        checkPacked(rig);
    }
}

TEST_CASE("A set that several threads lay out is the one that a single thread lays out") {
    const CameraInfo camera = pinholeCamera(321, 243);
    bool pack = false;
    SUBCASE("read from slots") {}
    SUBCASE("packed") {
        pack = true;
    }
    const auto shared = [pack](uint32_t threads) {
        return [=](Plan& plan) {
            plan.pack = plan.byPixel = plan.tree = pack;
            plan.publishers = threads;
        };
    };
    Scene scene = classesScene(3);
    scene.holdSeconds = 1.0;
    CloudRig one(scene, camera, shared(1)), three(scene, camera, shared(3));
    for (uint64_t seed = 1; seed <= 6; ++seed) {
        Picture picture = stressPicture(camera, seed);
        for (size_t p = seed; seed > 1 && p < picture.depth.size(); p += 5) { // held ones, too
            picture.depth[p] = 0;
        }
        const FrameReport a = one.run(picture), b = three.run(picture);
        checkPacked(three);
        const RegionSpheres &s = one.host().spheres, &t = three.host().spheres;
        CHECK(s.size() > 8192); // more than two parts
        CHECK((s.x == t.x && s.y == t.y && s.z == t.z && s.radius == t.radius));
        CHECK((s.source == t.source && s.fixture == t.fixture));
        CHECK(a.counts.patches == b.counts.patches);
        CHECK(a.counts.classSpheres == b.counts.classSpheres);
        CHECK(a.counts.classPatches == b.counts.classPatches);
        CHECK(std::ranges::equal(one.set().grid.order(), three.set().grid.order()));
    }
}

TEST_CASE("Slots that a GPU query keeps for itself are packed the same, and each sphere knows its own") {
    const CameraInfo camera = pinholeCamera(90, 40);
    Scene scene = plainScene();
    scene.holdSeconds = 1.0;
    CloudRig rig(scene, camera, [](Plan& plan) {
        plan.query = Plan::Query::Gpu;
        plan.pack = plan.byPixel = plan.tree = true;
    });
    Picture picture = stressPicture(camera, 5);
    rig.run(picture);
    checkPacked(rig);
    for (size_t p = 0; p < picture.depth.size(); p += 3) { // held from now on
        picture.depth[p] = 0;
    }
    rig.run(picture);
    checkPacked(rig);
    const RegionSpheres& host = rig.host().spheres;
    REQUIRE(rig.set().keys.size() == host.size());
    size_t wrong = 0, held = 0;
    for (size_t i = 0; i < host.size(); ++i) {
        const uint32_t pixel = host.source[i] % (90 * 40), layer = host.source[i] / (90 * 40);
        const uint32_t slot = slotOfPixel(pixel % 90, pixel / 90, rig.layout().across);
        wrong += rig.set().keys[i] != slot / 256 * 512 + layer * 256 + slot % 256;
        held += layer;
    }
    CHECK(wrong == 0);
    CHECK(held > 0);
}

TEST_CASE("Packed spheres have the class that they have in their slots, in patches of one class and of "
          "several, seen and held") {
    const CameraInfo camera = pinholeCamera(150, 70);
    for (const uint32_t classes : {1u, 3u, 8u}) {
        CAPTURE(classes);
        Scene scene = classesScene(classes);
        scene.holdSeconds = 1.0;
        CloudRig packed(scene, camera, packing(true)), slots(scene, camera, packing(false));
        std::map<uint32_t, std::set<uint8_t>> ofPatch;
        bool held = false;
        for (const uint64_t seed : {3, 4, 5}) {
            Picture picture = stressPicture(camera, 3);
            for (size_t p = 0; seed > 3 && p < picture.depth.size(); p += seed) { // held ones, too
                picture.depth[p] = 0;
            }
            const FrameReport one = packed.run(picture), other = slots.run(picture);
            CHECK(one.counts.classSpheres == other.counts.classSpheres);
            CHECK(one.counts.classPatches == other.counts.classPatches);
            const RegionSpheres &a = packed.host().spheres, &b = slots.host().spheres;
            REQUIRE(a.source == b.source);
            CHECK(a.fixture == b.fixture);
            for (size_t i = 0; i < a.size(); ++i) {
                const uint32_t pixel = a.source[i] % (150 * 70);
                held = held || a.source[i] != pixel;
                ofPatch[pixel / 150 / 16 * 16 + pixel % 150 / 16].insert(a.fixture[i]);
            }
        }
        const auto several =
            std::ranges::count_if(ofPatch, [](const auto& patch) { return patch.second.size() > 1; });
        CHECK(held);
        CHECK((several > 0) == (classes > 1));
        CHECK((classes == 8 || several < static_cast<std::ptrdiff_t>(ofPatch.size())));
    }
}

TEST_CASE("From depths and whole steps of growth the host makes the very spheres that the device has: lenses, "
          "fans, poses, classes, thinned and held") {
    uint32_t grown = 0, held = 0, distorted = 0;
    bool holds = false;
    for (CloudCase& c : cloudCases()) {
        CAPTURE(c.name);
        holds = !holds;
        c.scene.holdSeconds = holds ? 1.0 : 0.0;
        CloudRig rig(c.scene, c.camera, packing(true));
        if (!rig.plan().spheres) {
            continue;
        }
        for (int frame = 0; frame < 2; ++frame) {
            const Pose pose{{0.1 * frame, 0.02, -0.3}, rotationExp({0.1, 0.2 * frame, -0.1})};
            rig.run(frame == 0 ? c.picture : stressPicture(c.camera, 7), -1.0, pose);
            checkPacked(rig);
            const RegionSpheres& s = rig.host().spheres;
            for (size_t i = 0; i < s.size(); ++i) {
                const FixtureClass& f = c.scene.fixtures[s.fixture[i]];
                const bool seen = s.source[i] < c.camera.depth.pixels();
                grown += seen && s.radius[i] > f.radius + 3.0 * c.scene.registrationSigma + 1e-6;
                held += !seen;
                distorted += seen && rig.plan().rays;
            }
        }
    }
    CHECK(grown > 100);
    CHECK(held > 100);
    CHECK(distorted > 100);
}

TEST_CASE("A picture in flight keeps the radii and the pose that its passes read") {
    const CameraInfo camera = pinholeCamera(50, 34);
    for (const bool pack : {false, true}) {
        CAPTURE(pack);
        CloudRig rig(plainScene(), camera, packing(pack));
        FrameCycle& cycle = rig.cycle();
        const Picture picture = drawnPicture(camera, [](int, int) { return 0.8; });
        const auto frame = [&](uint32_t index) {
            Frame::Content content;
            content.index = index, content.sourceNumber = index, content.captureTime = index / 30.0;
            content.depth = picture.depth, content.colour = picture.colour;
            content.baseTcamera = Pose{{0.1 * index, 0.0, 0.0}, {1.0, 0.0, 0.0, 0.0}};
            return Frame(content, nullptr);
        };
        cycle.upload(frame(1));
        cycle.submit();
        Scene wider = rig.scene();
        wider.fixtures[0].radius = 0.09;
        cycle.setScene(wider);
        cycle.upload(frame(2));
        const auto spheresOf = [&] {
            cycle.finish();
            const RegionSpheres& s = cycle.sets().newest()->host.spheres;
            REQUIRE(s.size() == 50 * 34);
            return std::pair(s.x[0], s.radius[0]);
        };
        const auto first = spheresOf();
        cycle.submit();
        const auto second = spheresOf();
        CHECK(first.second == 0.04f);
        CHECK(second.second == 0.09f);
        CHECK(second.first - first.first == doctest::Approx(0.1).epsilon(1e-5));
    }
}
