// SPDX-License-Identifier: Apache-2.0
// Sends every tick, every new fixture set and the authored shapes of a realtime run through a view socket.
#pragma once

#include "devices/bridge/view_socket.h"
#include "engine/run/channels.h"
#include "engine/run/record_drain.h"

#include <mutex>
#include <vector>

namespace fathom {

inline constexpr const char* kViewEndpointHelp =
    "socket that sends every tick and fixture set to observers (devices/bridge)";

// Writer thread, except setShapes() and forget().
class ViewPublisher {
public:
    // Throws BadInput.
    explicit ViewPublisher(const std::filesystem::path& path)
        : endpoint_(path) {}

    void step(const TickRow& row);
    // `set` must stay valid until the next call, because an observer that connects later receives it.
    void frame(const Fixtures& set);

    // Active from now on. Any thread; waits while the writer copies them.
    void setShapes(std::span<const Shape> shapes);
    // Drops the last set. Call it only while no run is active.
    void forget() noexcept { set_ = nullptr; }

    const ViewSocket& endpoint() const noexcept { return endpoint_; }

private:
    void sendRegions() noexcept;
    void sendFixtures();
    bool shapesDiffer(); // true when the shapes differ from those sent

    static constexpr uint32_t kPollEvery = 16; // ticks

    ViewSocket endpoint_;
    const Fixtures* set_ = nullptr;
    uint64_t sent_ = 0; // generation of the last set that was sent
    uint32_t ticks_ = 0;
    fathom_door_state state_{};
    fathom_door_regions regions_{};
    fathom_door_fixtures fixtures_{};
    std::vector<fathom_door_fixture> rows_;
    std::mutex mutex_; // guards the two members below
    std::vector<Shape> shapes_;
    bool shapesChanged_ = false;
};

// Forwards everything to one sink, and to the socket if there is one.
class PublishedSink final : public RunSink {
public:
    // Both outlive this; null = no socket.
    PublishedSink(RunSink& next, ViewPublisher* view)
        : next_(next)
        , view_(view) {}
    void frame(const PublishedFrame& frame, const Fixtures& set) override {
        next_.frame(frame, set);
        if (view_ != nullptr) {
            view_->frame(set);
        }
    }
    void query(const QueryNote& note) override { next_.query(note); }
    void step(const TickRow& row, const PublishedFrame* obeyed, bool known,
              std::span<const uint32_t> behind) override {
        next_.step(row, obeyed, known, behind);
        if (view_ != nullptr) {
            view_->step(row);
        }
    }

private:
    RunSink& next_;
    ViewPublisher* view_;
};

} // namespace fathom
