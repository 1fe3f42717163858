// SPDX-License-Identifier: Apache-2.0
// Frames that the device reads in the camera's memory, and frames that must be copied.
#include "devices/frame_slots.h"
#include "tests/support/cloud_rig.h"

#include <algorithm>
#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

// A camera's memory with a frame in it.
class Blocks {
public:
    Blocks(const CameraInfo& camera, uint32_t count)
        : slots_(camera.depth.pixels(), true, count) {}

    Frame next(const Image& image, uint32_t number = 0) {
        FrameSlot& slot = *slots_.acquire();
        std::copy(image.depth.begin(), image.depth.end(), slot.depth().begin());
        std::copy(image.colour.begin(), image.colour.end(), slot.colour().begin());
        Frame::Content content;
        content.index = number, content.sourceNumber = number, content.captureTime = number / 30.0;
        content.depth = slot.depth(), content.colour = slot.colour();
        latest_ = &slot;
        return slot.lend(content);
    }
    FrameSlot& latest() { return *latest_; }

private:
    FrameSlots slots_;
    FrameSlot* latest_ = nullptr;
};

bool canImport() {
    const uint64_t alignment = vulkan().device.facts().hostPointerAlignment;
    return alignment > 0 && alignment <= 4096;
}

struct Slots {
    Scene scene = classesScene(3);
    CameraInfo camera = pinholeCamera(90, 60);
    Plan plan = makePlan(scene, camera, 1, vulkan().device.facts());
    cloud::UploadSlots slots{vulkan().device, plan, camera};
    Image image = stressImage(camera, 3);

    cloud::UploadSlots::Choice choose(Blocks& from) { return slots.choose(from.next(image)); }
};

} // namespace

TEST_CASE("Frames read in place give the sets of copied ones, also after the camera was opened again") {
    for (const glm::uvec2 size : {glm::uvec2(123, 77), glm::uvec2(160, 90), glm::uvec2(1, 1)}) {
        CAPTURE(size.y);
        const CameraInfo camera = pinholeCamera(size.x, size.y);
        CloudRig inPlace(classesScene(3), camera);
        CloudRig copied(classesScene(3), camera, [](Plan& plan) { plan.inPlace = false; });
        CHECK(inPlace.plan().inPlace == canImport());
        auto blocks = std::make_unique<Blocks>(camera, 3);
        for (uint32_t k = 0; k < 12; ++k) {
            if (k == 6) { // new memory, possibly at the old address
                blocks = std::make_unique<Blocks>(camera, 2);
            }
            const Image image = stressImage(camera, k + 1);
            inPlace.cycle().process(blocks->next(image, k));
            copied.run(image);
            const auto lease = inPlace.cycle().sets().newest();
            CAPTURE(k);
            CHECK(lease->host.forbiddenBits == copied.host().forbiddenBits);
            CHECK(lease->host.spheres.x == copied.host().spheres.x);
            CHECK(lease->host.spheres.radius == copied.host().spheres.radius);
            CHECK(lease->host.spheres.source == copied.host().spheres.source);
        }
    }
}

TEST_CASE(
    "A frame in whole pages is not copied: the passes read what the camera has written until they run") {
    const CameraInfo camera = pinholeCamera(90, 60);
    Scene scene = classesScene(3);
    scene.holdSeconds = 0.0;
    for (const bool copies : {false, true}) {
        CloudRig rig(scene, camera, [&](Plan& plan) { plan.inPlace = plan.inPlace && !copies; });
        Blocks blocks(camera, 2);
        rig.cycle().upload(blocks.next(stressImage(camera, 3)));
        std::ranges::fill(blocks.latest().depth(), uint16_t{0});
        rig.cycle().submit();
        rig.cycle().finish();
        CHECK((rig.cycle().sets().newest()->host.spheres.size() == 0) == (canImport() && !copies));
    }
}

TEST_CASE("A camera's blocks are imported once each") {
    if (!canImport()) {
        return;
    }
    Slots rig;
    Blocks blocks(rig.camera, 2);
    const auto first = rig.choose(blocks), second = rig.choose(blocks);
    CHECK(first.slot == 1);
    CHECK(second.slot == 2);
    CHECK((first.isNew && second.isNew));
    CHECK(rig.slots[1].depth.imported());
    CHECK(rig.slots[1].colour.imported());
    for (int round = 0; round < 5; ++round) {
        const auto again = rig.choose(blocks);
        CHECK(again.slot == 1u + round % 2);
        CHECK_FALSE(again.isNew);
    }
}

TEST_CASE("Frames outside whole pages are copied to one slot") {
    Slots rig;
    const Image& image = rig.image;
    Frame::Content content;
    content.depth = image.depth, content.colour = image.colour;
    const auto copy = [&] { return rig.slots.choose(Frame(content, nullptr)).slot; };
    CHECK(copy() == 0);
    CHECK(copy() == 0);
    // A block that belongs to another frame is not used.
    Blocks blocks(rig.camera, 1);
    const Frame other = blocks.next(image);
    content.depthMemory = other->depthMemory, content.colourMemory = other->colourMemory;
    CHECK(copy() == 0);
    CHECK_FALSE(rig.slots[0].depth.imported());
}

TEST_CASE("Colour alone is read in place when depth is in a driver's memory") {
    if (!canImport()) {
        return;
    }
    Slots rig;
    Blocks blocks(rig.camera, 1);
    Frame::Content content = *blocks.next(rig.image);
    content.depth = rig.image.depth, content.depthMemory = nullptr;
    const auto [slot, isNew] = rig.slots.choose(Frame(content, nullptr));
    CHECK(slot == 1);
    CHECK(isNew);
    CHECK_FALSE(rig.slots[1].depth.imported());
    CHECK(rig.slots[1].colour.imported());
}

TEST_CASE("Memory released by its camera makes room, and memory without room is copied") {
    if (!canImport()) {
        return;
    }
    constexpr uint32_t kMax = cloud::UploadSlots::kMax;
    Slots rig;
    auto gone = std::make_unique<Blocks>(rig.camera, 1);
    const std::weak_ptr<const void> memory = gone->next(rig.image)->depthMemory;
    CHECK(rig.choose(*gone).slot == 1);
    gone.reset();
    CHECK_FALSE(memory.expired()); // the slot keeps the memory, so its address cannot be reused
    Blocks many(rig.camera, kMax);
    CHECK(rig.choose(many).slot == 1);
    CHECK(memory.expired());
    for (uint32_t slot = 2; slot < kMax; ++slot) {
        CHECK(rig.choose(many).slot == slot);
    }
    CHECK(rig.choose(many).slot == 0);
}

TEST_CASE("Depth in a driver's memory is read in place again after its camera was replugged, with any colour "
          "memory") {
    if (!canImport()) {
        return;
    }
    Slots rig;
    Blocks colours(rig.camera, 5); // the camera's own colour blocks stay
    auto driver = std::make_unique<Blocks>(rig.camera, 4);
    const auto choose = [&] {
        const Frame depth = driver->next(rig.image), colour = colours.next(rig.image);
        Frame::Content content = *depth;
        content.colour = colour->colour, content.colourMemory = colour->colourMemory;
        return rig.slots.choose(Frame(content, nullptr));
    };
    for (int round = 0; round < 3; ++round) {
        for (int i = 0; i < 20; ++i) { // all combinations
            const auto [slot, isNew] = choose();
            CHECK(slot > cloud::UploadSlots::kCopied);
            CHECK(isNew);
        }
        CHECK_FALSE(choose().isNew);
        driver = std::make_unique<Blocks>(rig.camera, 4);
    }
}

TEST_CASE("If the device cannot import depth it is copied, and colour is still read in place") {
    if (!canImport()) {
        return;
    }
    Slots rig;
    Blocks blocks(rig.camera, 2);
    const auto choose = [&] {
        const Frame frame = blocks.next(rig.image);
        Frame::Content content = *frame;
        // A frame in the middle of a page, which no device can import.
        content.depth = content.depth.subspan(8);
        content.depthMemory = {content.depthMemory, content.depth.data()};
        return rig.slots.choose(Frame(content, nullptr));
    };
    rig.camera.depth.height -= 1; // enough data remains in the page
    CHECK(choose().slot == 0);
    const auto [slot, isNew] = choose();
    CHECK(slot == 1);
    CHECK(isNew);
    CHECK_FALSE(rig.slots[slot].depth.imported());
    CHECK(rig.slots[slot].colour.imported());
    choose();
    CHECK_FALSE(choose().isNew);
}
