// SPDX-License-Identifier: Apache-2.0
// What the writer of a realtime run tells through a view door: every turn, every new fixture set, and the
// shapes that people placed.
#pragma once

#include "devices/bridge/view_socket.h"
#include "engine/run/channels.h"
#include "engine/run/record_drain.h"

#include <mutex>
#include <vector>

namespace fathom {

inline constexpr const char* kViewEndpointHelp =
    "socket that sends every tick and fixture set to observers (devices/bridge)";

// One thread, the writer's, but for setShapes() and forget().
class ViewPublisher {
public:
    // Throws BadInput.
    explicit ViewPublisher(const std::filesystem::path& path)
        : endpoint_(path) {}

    void step(const TickRow& row);
    // `set` must stay whole until the next call: an observer who comes later gets it then.
    void frame(const Fixtures& set);

    // In force from now on. Any thread; waits for a writer that copies them.
    void setShapes(std::span<const Shape> shapes);
    // The set last given goes away: while no run is on.
    void forget() noexcept { set_ = nullptr; }

    const ViewSocket& endpoint() const noexcept { return endpoint_; }

private:
    void tellRegions() noexcept;
    void tellFixtures();
    bool shapesAreOthers(); // than those told

    static constexpr uint32_t kPollEvery = 16; // turns

    ViewSocket endpoint_;
    const Fixtures* set_ = nullptr;
    uint64_t told_ = 0; // generation
    uint32_t ticks_ = 0;
    fathom_door_state state_{};
    fathom_door_regions regions_{};
    fathom_door_fixtures fixtures_{};
    std::vector<fathom_door_fixture> rows_;
    std::mutex mutex_; // of the two below
    std::vector<Shape> shapes_;
    bool othersThanTold_ = false;
};

// Hands everything on to one sink, and tells it at the door where there is one.
class PublishedSink final : public RunSink {
public:
    // Both outlive this; null: no door.
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
