// SPDX-License-Identifier: Apache-2.0
// Patch lists of list.comp and of classify.comp, compared with class bits and memory patch by patch.
#include "apps/verify/read_back.h"
#include "tests/support/cloud_rig.h"

#include <algorithm>
#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

using List = std::vector<uint32_t>;

// The patches that must be on each list, in ascending order.
struct Lists {
    List listed, guided, withoutHeld, withHeld;
};

Lists twin(const CloudRig& rig, const List& countsBefore) {
    const List masks = rig.masks();
    const auto classes = reference::pointClasses(rig.scene());
    uint32_t guides = 0;
    for (size_t c = 0; c < classes.size(); ++c) {
        guides |= classes[c]->role == Role::Guidance ? 1u << c : 0u;
    }
    List seen(rig.layout().patches(), 0);
    for (size_t i = 0; i < masks.size(); ++i) {
        const size_t u = i % rig.camera().depth.width, v = i / rig.camera().depth.width;
        seen[v / 16 * rig.layout().across + u / 16] |= masks[i];
    }
    Lists lists;
    for (uint32_t patch = 0; patch < seen.size(); ++patch) {
        const uint32_t count = countsBefore.empty() ? 0 : countsBefore[patch];
        if (seen[patch] != 0 || count != 0) {
            lists.listed.push_back(patch);
            (count >> 16 != 0 ? lists.withHeld : lists.withoutHeld).push_back(patch);
        }
        if ((seen[patch] & guides) != 0) {
            lists.guided.push_back(patch);
        }
    }
    return lists;
}

List sorted(List::const_iterator begin, uint32_t count) {
    List out(begin, begin + count);
    std::ranges::sort(out);
    return out;
}

void checkLists(const CloudRig& rig, const Lists& expected) {
    const List list = verify::readBack<uint32_t>(vulkan().device, rig.cycle().work().list);
    const List bits = rig.listed();
    const shared::FrameCounters n = rig.counters();
    const uint32_t patches = rig.layout().patches(), subs = rig.plan().subPatchGroup;
    const auto groups = [&](uint32_t count) { return (count * 16 + subs - 1) / subs; };
    CHECK(sorted(list.begin(), n.patchGroups.x) == expected.listed);
    CHECK(n.subPatchGroups.x == groups(n.patchGroups.x));
    if (rig.plan().moments) {
        CHECK(sorted(list.begin() + patches, n.guidedGroups.w) == expected.guided);
        CHECK(n.guidedGroups.x == (rig.plan().lists() ? groups(n.guidedGroups.w) : n.guidedGroups.w));
    } else {
        CHECK((n.guidedGroups.x == 0 && n.guidedGroups.w == 0));
    }
    if (rig.plan().hold && rig.plan().lists()) {
        CHECK(sorted(list.begin() + 2 * patches, n.withoutHeldGroups.w) == expected.withoutHeld);
        CHECK(n.withoutHeldGroups.x == groups(n.withoutHeldGroups.w));
        CHECK(sorted(list.begin() + 3 * patches - n.withHeldGroups.w, n.withHeldGroups.w) ==
              expected.withHeld);
        CHECK(n.withHeldGroups.x == groups(n.withHeldGroups.w));
    }
    const auto has = [](const List& among, uint32_t patch) {
        return std::ranges::binary_search(among, patch);
    };
    size_t wrong = 0;
    for (uint32_t patch = 0; patch < patches; ++patch) {
        wrong += ((bits[patch] & shared::kPatchListed) != 0) != has(expected.listed, patch);
        wrong += ((bits[patch] & shared::kPatchGuided) != 0) != has(expected.guided, patch);
        wrong += rig.plan().hold && !rig.plan().lists() &&
                 ((bits[patch] & shared::kPatchHolding) != 0) != has(expected.withHeld, patch);
    }
    CHECK(wrong == 0);
}

// A forbidden band over `share` of the rows and a guidance band over the rest; no depth in row `hidden`.
Image bands(const CameraInfo& camera, double share, int hidden) {
    const auto rows = static_cast<int>(camera.depth.height);
    const int last = static_cast<int>(share * rows);
    Image image = drawnImage(
        camera, [&](int, int v) { return v / 8 == hidden ? 0.0 : 0.6; }, 0xff808080);
    for (size_t i = 0; i < image.colour.size(); ++i) {
        const int v = static_cast<int>(i / camera.depth.width);
        image.colour[i] = v < last ? 0xff2020c0 : v < last + 3 ? 0xff20c0c0 : 0xff808080;
    }
    return image;
}

Scene bandScene(bool guidance, double hold) {
    Scene scene = plainScene();
    scene.holdSeconds = hold;
    scene.fixtures[0].hue = Band{330, 30};
    if (guidance) {
        scene.fixtures.push_back(guidanceClass("g"));
        scene.fixtures.back().hue = Band{40, 80};
    }
    return scene;
}

// Rows without depth in one frame are held in the next.
void runBands(const CloudRig::Change& change, const CameraInfo& camera, bool guidance, double hold) {
    CloudRig rig(bandScene(guidance, hold), camera, change);
    List counts;
    size_t holding = 0;
    for (const double share : {0.5, 0.5, 0.1, 1.0, 0.0, 0.0}) {
        rig.run(bands(camera, share, share == 0.5 && counts.empty() ? 99 : 1));
        const Lists expected = twin(rig, counts);
        checkLists(rig, expected);
        holding += expected.withHeld.size();
        counts = rig.plan().hold
                     ? verify::readBack<uint32_t>(vulkan().device, rig.cycle().work().memoryCounts)
                     : counts;
    }
    CHECK((holding > 0) == (hold > 0.0));
}

} // namespace

TEST_CASE("Each patch with work is listed once, with separate lists for guided and holding patches, in "
          "either pass that makes lists") {
    for (const bool byPixel : {false, true}) {
        const auto change = [&](Plan& plan) { plan.byPixel = plan.pack = byPixel; };
        for (const auto& size : {std::pair{100u, 60u}, {16u, 16u}, {1u, 1u}, {333u, 250u}}) {
            const uint32_t width = size.first,
                           height = size.second; // CAPTURE does not accept structured bindings
            CAPTURE(byPixel);
            CAPTURE(width);
            const CameraInfo camera = pinholeCamera(width, height);
            runBands(change, camera, true, height > 16 ? 10.0 : 0.0);
            runBands(change, camera, false, 0.0);
        }
    }
}

TEST_CASE("A patch's memory is read only while it holds points") {
    const CameraInfo camera = pinholeCamera(100, 60);
    bool byPixel = false;
    SUBCASE("listed apart") {}
    SUBCASE("asked one by one") {
        byPixel = true;
    }
    CloudRig rig(bandScene(false, 0.1), camera, [=](Plan& plan) { plan.byPixel = plan.pack = byPixel; });
    const auto holding = [&](int hidden) {
        rig.run(bands(camera, 1.0, hidden));
        return byPixel ? static_cast<uint32_t>(std::ranges::count_if(
                             rig.listed(), [](uint32_t bits) { return (bits & shared::kPatchHolding) != 0; }))
                       : rig.counters().withHeldGroups.w;
    };
    CHECK(holding(99) == 0);
    CHECK(holding(1) == 0); // rows 8 to 15 have no depth, so their points are held from now on
    CHECK(holding(1) == rig.layout().across);
    for (int frame = 0; frame < 5; ++frame) { // longer than the hold time
        holding(1);
    }
    CHECK(holding(1) == 0);
}
