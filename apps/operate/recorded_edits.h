// SPDX-License-Identifier: Apache-2.0
// The edited fixtures of a recording: edits.csv and the scenes that it names (apps/binding/scene_edits.h).
#pragma once

#include "devices/recorded/line_file.h"
#include "engine/run/channels.h"

#include <deque>
#include <filesystem>
#include <string>
#include <vector>

namespace fathom::operate {

// The fixtures of a recording at its start or after an edit.
struct RecordedScene {
    std::string text;                 // text of a scene file
    std::vector<uint32_t> frozenRows; // rows of frozen classes
};

// One thread at a time. Every call throws Error that names the file.
class RecordedEdits {
public:
    // Begins a recording. The files are made at the first edit.
    void begin(const std::filesystem::path& folder, const RecordedScene& scene);
    // The fixtures from change `number` on (PublishedFrame::edit).
    void add(uint64_t number, RecordedScene scene) { upcoming_.emplace_back(number, std::move(scene)); }
    // The frame that becomes image number `image`.
    void frame(const PublishedFrame& frame, uint64_t image);

private:
    void put(uint64_t image);

    std::filesystem::path folder_;
    LineFile file_;
    RecordedScene active_;                                    // the active fixtures
    std::deque<std::pair<uint64_t, RecordedScene>> upcoming_; // by number of the change
    uint32_t scenes_ = 0;                                     // files scene-N.yaml
    bool allFrozen_ = false;                                  // PublishedFrame::allFrozen of the last frame
};

} // namespace fathom::operate
