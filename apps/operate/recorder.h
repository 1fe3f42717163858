// SPDX-License-Identifier: Apache-2.0
// Records a session into a folder that `fathom replay FOLDER/scene.yaml` plays: frames, hand, wrench and the
// active settings.
#pragma once

#include "apps/operate/recorded_edits.h"
#include "apps/operate/recorded_ticks.h"
#include "devices/recorded/recording_writer.h"
#include "engine/run/record_drain.h"

#include <atomic>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>

namespace fathom::operate {

// Writes a TUM RGB-D folder with scene.yaml, hand.csv (raw poses and buttons), and wrench.csv and touches.csv
// (tick_log.h). Edited fixtures add edits.csv and the scenes it names (apps/binding/scene_edits.h).
// Frame j of a replay comes at j / 30 s, so the times of hand and wrench are scaled to that per frame. A
// thread of the writer writes the PNG files; lost() counts frames that it had no time for. While no frame
// comes for ten seconds, ticks are not recorded. A killed session leaves a shorter recording; a full disk
// ends the recording.
class Recorder final : public RunSink {
public:
    ~Recorder() override { stop(); }

    // Window thread. scene: text of the active scene file. Waits for the previous recording. Throws Error
    // that names the file.
    void start(const std::filesystem::path& folder, const std::string& scene, const CameraInfo& camera,
               const RecordedScene& edited = {});
    // Window thread: the fixtures from change `number` on (PublishedFrame::edit). Ignored when not recording.
    void edit(uint64_t number, RecordedScene scene);
    // Window thread: marks the next tick (event_marks.h). Ignored when not recording.
    void mark() { marked_.store(true); }
    // Ends the recording and returns while queued frames are still written. Ignored when not recording. why:
    // as failure(); empty = the pilot stopped it.
    void stop(const std::string& why = "");
    bool recording() const { return recording_.load(); }
    bool writing() const; // queued frames after stop()
    bool busy() const;    // frame() would skip a frame now: the disk is too slow
    // Window thread: waits until everything is on disk.
    void finish();
    // Why the last recording failed; empty = it did not.
    std::string failure() const;
    uint64_t lost() const { return lost_.load(); }
    uint64_t frames() const { return frames_.load(); }
    double seconds() const { return seconds_.load(); } // [s] from the first to the last frame
    uint64_t bytes() const;                            // on disk

    // Writer thread of the run.
    void frame(const PublishedFrame& frame, const HostFixtures& set) override;
    void query(const QueryNote&) override {}
    void step(const TickRow& row, const ObeyedSet&) override;

private:
    template <class Job>
    void orFail(const Job& job); // call with mutex_ held
    void endTicks();
    void addImage(const PublishedFrame& frame, const HostFixtures& set);

    std::atomic<bool> recording_{false};
    std::atomic<uint64_t> lost_{0}, frames_{0};
    std::atomic<double> seconds_{0.0};
    std::atomic<bool> marked_{false}; // the next tick
    mutable std::mutex mutex_;        // guards all members below; window and writer thread
    std::unique_ptr<RecordingWriter> writer_;
    std::string failure_;
    double firstCapture_ = 0.0, lastCapture_ = -1.0; // [s] of the first and last image, in the run
    uint64_t imageBytes_ = 0;                        // of a recording that is on disk
    RecordedTicks ticks_;
    RecordedEdits edits_;
};

} // namespace fathom::operate
