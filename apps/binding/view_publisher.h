// SPDX-License-Identifier: Apache-2.0
// Sends every tick, every new fixture set and the placed shapes of a realtime run through a view socket.
#pragma once

#include "apps/binding/run_observer.h"
#include "apps/binding/shape_box.h"
#include "devices/bridge/view_socket.h"

#include <vector>

namespace fathom {

class ViewPublisher final : public RunObserver {
public:
    // Throws BadInput.
    explicit ViewPublisher(const std::filesystem::path& path)
        : endpoint_(path) {}

    void step(const TickRow& row) override;
    void frame(const HostFixtures& set) override;
    void setShapes(std::span<const Shape> shapes) override { newestShapes_.set(shapes); }
    void forget() noexcept override;

private:
    void offerUpdates();
    void offerRegions();
    void offerFixtures();

    static constexpr uint32_t kPollEvery = 16; // ticks

    ViewSocket endpoint_;
    const HostFixtures* set_ = nullptr;
    uint64_t offered_ = 0; // generation of the newest set that was offered
    uint32_t ticks_ = 0;
    fathom_door_state state_{};
    std::vector<fathom_door_fixture> rows_;
    std::vector<Shape> shapes_; // those offered last
    ShapeBox newestShapes_;
};

} // namespace fathom
