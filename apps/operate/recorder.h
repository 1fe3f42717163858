// SPDX-License-Identifier: Apache-2.0
// Records a session into a folder that `fathom replay FOLDER/scene.yaml` plays: frames, hand, wrench and the
// active settings.
#pragma once

#include "apps/operate/snapshots.h"
#include "devices/recorded/line_file.h"
#include "devices/recorded/recording_writer.h"

#include <atomic>
#include <deque>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>

namespace fathom::operate {

// The fixtures of a recording at its start or after an edit.
struct RecordedScene {
    std::string text;           // text of a scene file
    std::vector<uint32_t> held; // rows of frozen classes
};

// Writes a TUM RGB-D folder with scene.yaml, hand.csv (raw poses and buttons), and wrench.csv and touches.csv
// (tick_log.h). Edited fixtures add edits.csv and the scenes it names (apps/binding/scene_edits.h).
// Frame j of a replay comes at j / 30 s, so the times of hand and wrench are scaled to that per frame. A
// thread of the writer writes the PNG files; lost() counts frames that it had no time for. A killed session
// leaves a shorter recording; a full disk ends the recording.
class Recorder final : public RunSink {
public:
    ~Recorder() override { stop(); }

    // Window thread. scene: text of the active scene file. Waits for the previous recording. Throws Error
    // that names the file.
    void start(const std::filesystem::path& folder, const std::string& scene, const CameraInfo& camera,
               const RecordedScene& edited = {});
    // Window thread: the fixtures from change `number` on (PublishedFrame::edit). Ignored when not recording.
    void edit(uint64_t number, RecordedScene scene);
    // Ends the recording and returns while queued frames are still written. Ignored when not recording.
    void stop();
    bool recording() const { return recording_.load(); }
    bool writing() const; // queued frames after stop()
    // Window thread: waits until everything is on disk.
    void finish();
    // Why the last recording failed; empty = it did not.
    std::string failure() const;
    uint64_t lost() const { return lost_.load(); }
    uint64_t images() const { return images_.load(); }

    // Writer thread of the run.
    void frame(const PublishedFrame& frame, const Fixtures& set) override;
    void query(const QueryNote&) override {}
    void step(const TickRow& row, const PublishedFrame*, bool, std::span<const uint32_t>) override;

private:
    template <class Job>
    void orFail(const Job& job); // call with mutex_ held
    void openFiles(const std::filesystem::path& folder);
    void addImage(const PublishedFrame& frame, const Fixtures& set);
    void addEdit(const PublishedFrame& frame);
    void putEdit(uint64_t image, bool still);
    void flushTicks(double from, double to, double start, double scale);
    void putTick(const TickRow& row, double t);
    int64_t imageOf(int64_t frame) const; // frame index in this recording; -1 = from before it

    std::atomic<bool> recording_{false};
    std::atomic<uint64_t> lost_{0}, images_{0};
    mutable std::mutex mutex_; // guards all members below; window and writer thread
    std::unique_ptr<RecordingWriter> writer_;
    std::string failure_;
    std::deque<TickRow> ticks_;                        // since the last frame
    std::deque<std::pair<int64_t, uint64_t>> numbers_; // index in run, in recording
    double lastCapture_ = -1.0, lastWritten_ = -1.0;
    LineFile hand_, wrench_, touches_, edits_;
    std::filesystem::path folder_;
    RecordedScene edited_;                                    // the active fixtures
    std::deque<std::pair<uint64_t, RecordedScene>> upcoming_; // by number of the change
    uint32_t scenes_ = 0;                                     // files scene-N.yaml
    bool still_ = false;
};

} // namespace fathom::operate
