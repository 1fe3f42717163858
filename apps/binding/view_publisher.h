// SPDX-License-Identifier: Apache-2.0
// What the writer of a realtime run tells through a view door: every turn, and every new fixture set.
#pragma once

#include "apps/binding/crossings.h"
#include "devices/bridge/view_door.h"

namespace fathom {

// One thread, the writer's.
class ViewPublisher {
public:
    // Throws BadInput.
    explicit ViewPublisher(const std::filesystem::path& path)
        : door_(path) {}

    void turn(const TurnRow& row) noexcept;
    // `set` must stay whole until the next call: an observer who comes later gets it then.
    void frame(const Fixtures& set) noexcept;

    const ViewDoor& door() const noexcept { return door_; }

private:
    void tellRegions() noexcept;

    static constexpr uint32_t kPollEvery = 16; // turns

    ViewDoor door_;
    const Fixtures* set_ = nullptr;
    uint64_t told_ = 0; // generation
    uint32_t turns_ = 0;
    fathom_door_state state_{};
    fathom_door_regions regions_{};
};

} // namespace fathom
