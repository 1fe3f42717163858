// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/button_map.h"
#include "apps/operate/pilot_hand.h"
#include "engine/types/haptic_device.h"
#include "tests/support/refusal.h"
#include "tests/support/scratch_folder.h"

#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::operate;

namespace {

const std::atomic<bool> kNoSignal{false};

constexpr ButtonBits kNative{1, 4, 0}; // guidance, clutch, no jaws

// A hand whose buttons the test presses.
struct PressedHand final : HapticDevice {
    uint32_t buttons = 0;
    bool present = true;
    HandSample read(double) noexcept override { return {{}, buttons, present}; }
    void write(const Wrench&, double) noexcept override {}
};

} // namespace

TEST_CASE("A mapped button does what was chosen, its old use and the replaced button do nothing") {
    CHECK(translated(0b10101, kNative, kNative) == 0b10101);
    const ButtonBits chosen{16, 4, 0};
    CHECK(translated(16, kNative, chosen) == 1);
    CHECK(translated(1, kNative, chosen) == 0);
    CHECK(translated(16 | 4 | 2 | 32, kNative, chosen) == (1 | 4 | 2 | 32));
    const ButtonBits swapped{4, 1, 0};
    CHECK(translated(4, kNative, swapped) == 1);
    CHECK(translated(1, kNative, swapped) == 4);
}

TEST_CASE(
    "A button with another use, the dead-man switch and two buttons at once are refused with the reason") {
    ButtonMap map(kNative);
    CHECK(map.choose(ButtonUse::Guidance, 4) == "button 3 is clutch already: give that another button first");
    CHECK(map.choose(ButtonUse::Guidance, 2).find("dead-man") != std::string::npos);
    CHECK(map.choose(ButtonUse::Guidance, 8 | 16) == "press one button alone");
    CHECK(map.choose(ButtonUse::Jaws, 8) == "this scene has no jaws");
    CHECK(map.chosen() == kNative);
    CHECK(map.choose(ButtonUse::Clutch, 8).empty());
    CHECK(map.choose(ButtonUse::Guidance, 4).empty()); // free now
    CHECK(map.chosen() == ButtonBits{4, 8, 0});
}

TEST_CASE("A mapping is read as it was saved, and a bad file is rejected in one line") {
    const testing::ScratchFolder folder;
    const auto file = buttonFile(folder.path() / "demo.yaml");
    CHECK(file.filename() == "demo.buttons.json");
    ButtonMap map(kNative), read(kNative);
    read.load(file); // none
    CHECK(read.chosen() == kNative);
    REQUIRE(map.choose(ButtonUse::Clutch, 8).empty());
    REQUIRE(map.choose(ButtonUse::Guidance, 4).empty());
    map.save(file);
    read.load(file);
    CHECK(read.chosen() == map.chosen());
    const auto refusal = [&](const std::string& text) -> std::string {
        std::ofstream(file) << text;
        return testing::refusalOf([&] { read.load(file); });
    };
    CHECK(refusal("[]").find("content: no JSON object") != std::string::npos);
    CHECK(refusal(R"({"clutch": 3})").find("clutch: 3 (allowed: one bit") != std::string::npos);
    CHECK(refusal(R"({"clutch": "x"})").find("clutch: \"x\"") != std::string::npos);
    CHECK(refusal(R"({"clutch": 8, "guidance": 8})").find("clutch: 8") != std::string::npos);
    CHECK(refusal(std::string(5000, ' ')).find("at most 4096 bytes") != std::string::npos);
    CHECK(refusal(R"({"clutch": 16})").empty());
    CHECK(read.chosen() == ButtonBits{1, 16, 0});
}

TEST_CASE("While a button is mapped, pressing it has no effect; the dead-man switch keeps its own") {
    PressedHand device;
    GatedHand hand(device, nullptr, kNative, kNoSignal);
    hand.setForces(true);
    device.buttons = 1;
    CHECK(hand.read(0.0).buttons == 1);
    CHECK(hand.takePressed() == 1);
    CHECK(hand.takePressed() == 0); // still down, not pressed again
    hand.capture(true);
    device.buttons = 8 | kDeadManOpen;
    CHECK(hand.read(0.001).buttons == kDeadManOpen);
    CHECK(hand.takePressed() == (8 | kDeadManOpen));
    CHECK(hand.buttonsDown() == (8 | kDeadManOpen));
    hand.choose({8, 4, 0});
    hand.capture(false);
    device.buttons = 8;
    CHECK(hand.read(0.002).buttons == 1);
    hand.choose({1, 8, 0});
    device.present = false; // gone: it holds the engine's clutch
    device.buttons = 4 | kDeadManOpen;
    CHECK(hand.read(0.003).buttons == (4 | kDeadManOpen));
    CHECK(hand.takePressed() == 0);
}

TEST_CASE("Forces go off when the window says nothing for 2 s, and at once after a signal") {
    PressedHand device;
    std::atomic<bool> signal{false};
    GatedHand hand(device, nullptr, kNative, signal);
    const auto off = [&](double t) { return (hand.read(t).buttons & kDeadManOpen) != 0; };
    CHECK(off(0.0));
    double t = 5.0;
    for (int i = 0; i < 100; ++i) { // the window answers every 0.5 s
        t += 0.5;
        hand.setForces(true);
        CHECK_FALSE(off(t));
    }
    CHECK_FALSE(off(t + 1.9));
    CHECK_FALSE(hand.takeSilence());
    CHECK(off(t + 2.1));
    CHECK(off(t + 60.0));
    CHECK(hand.takeSilence());
    CHECK_FALSE(hand.takeSilence());
    hand.setForces(true); // what the window decides to do is its own matter
    CHECK_FALSE(off(t + 60.1));
    signal.store(true);
    CHECK(off(t + 60.101));
    hand.setForces(false);
    CHECK(off(t + 90.0)); // off already
    CHECK_FALSE(hand.takeSilence());
}
