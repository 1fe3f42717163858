// SPDX-License-Identifier: Apache-2.0
// Starts and stops recordings of a live run as the console requests.
#pragma once

#include "apps/operate/console.h"
#include "apps/operate/disk_space.h"
#include "apps/operate/fixture_editor.h"
#include "apps/operate/last_seconds.h"
#include "apps/operate/recorder.h"
#include "apps/session/session.h"

#include <atomic>
#include <thread>

namespace fathom::operate {

// Window thread.
class RecorderControl {
public:
    // in: folder for the folders of recordings.
    RecorderControl(std::filesystem::path in, Recorder& recorder, const LastSeconds& last,
                    const Session& session)
        : in_(std::move(in))
        , recorder_(recorder)
        , last_(last)
        , session_(session) {}

    // Call once per window frame. After a stop, queued frames are still written while the window continues. A
    // disk that is nearly full stops the recording.
    void follow(Console& console, FixtureEditor& editor);
    // Waits until the last seconds are on disk, if they are being stored.
    void finish() { storing_ = {}; }

private:
    std::filesystem::path freshFolder() const;
    void start(Console& console, FixtureEditor& editor);
    void reportSaved(Console& console);
    void store(Console& console);
    void followStore(Console& console);

    std::filesystem::path in_;
    Recorder& recorder_;
    const LastSeconds& last_;
    const Session& session_;
    std::string folder_; // until all is on disk; empty = none
    DiskSpace disk_;

    Recorder past_;                   // records the last seconds
    std::string pastFolder_;          // until they are on disk; empty = none
    std::atomic<bool> pastFed_{true}; // past_ has received all of them
    std::jthread storing_;            // last, so that it ends before what it uses
};

} // namespace fathom::operate
