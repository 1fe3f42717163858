// SPDX-License-Identifier: Apache-2.0
// Starts and stops recordings of a live run as the console requests.
#pragma once

#include "apps/operate/console.h"
#include "apps/operate/disk_space.h"
#include "apps/operate/fixture_editor.h"
#include "apps/operate/recorder.h"
#include "apps/session/session.h"

namespace fathom::operate {

// Window thread.
class RecorderControl {
public:
    // in: folder for the folders of recordings.
    RecorderControl(std::filesystem::path in, Recorder& recorder, const Session& session)
        : in_(std::move(in))
        , recorder_(recorder)
        , session_(session) {}

    // Call once per window frame. After a stop, queued frames are still written while the window continues. A
    // disk that is nearly full stops the recording.
    void follow(Console& console, FixtureEditor& editor);

private:
    std::filesystem::path freshFolder();
    void start(Console& console, FixtureEditor& editor);
    void saved(Console& console);

    std::filesystem::path in_;
    Recorder& recorder_;
    const Session& session_;
    uint32_t number_ = 0; // of the last folder name tried
    std::string folder_;  // until all is on disk; empty = none
    DiskSpace disk_;
};

} // namespace fathom::operate
