// SPDX-License-Identifier: Apache-2.0
// Everything of a session into a folder that `fathom replay FOLDER/scene.yaml` plays: pictures, hand, wrench
// and the settings in force.
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

// What the fixtures of a recording are, at its start or from an edit on.
struct RecordedScene {
    std::string text;           // of a scene file
    std::vector<uint32_t> held; // rows of classes that are held still
};

// A TUM RGB-D folder with hand.csv (raw poses and buttons), wrench.csv and touches.csv (what the hand felt,
// turn_log.h) and scene.yaml; where fixtures were edited meanwhile, also with edits.csv and the scenes that
// it names (apps/binding/scene_edits.h).
// Frame j of a replay comes at j / 30 s, so the times of hand and wrench are bent to that, frame by frame.
// PNG files are written on a thread of the writer's; pictures that it cannot keep up with are counted in
// lost(). A session that is killed leaves a shorter recording; so does a disk that is full, which ends it.
class Recorder final : public RunSink {
public:
    ~Recorder() override { stop(); }

    // Window thread. scene: the text of its file in force. Waits for what was recorded before. Throws Error
    // that names what cannot be written.
    void start(const std::filesystem::path& folder, const std::string& scene, const CameraInfo& camera,
               const RecordedScene& edited = {});
    // Window thread: the fixtures from change `number` on (PublishedFrame::edit), those of start() being
    // `edited`. Nothing when it is not recording.
    void edit(uint64_t number, RecordedScene scene);
    // No more is recorded; returns while pictures that wait are still written. Nothing when it is not
    // recording.
    void stop();
    bool recording() const { return recording_.load(); }
    bool writing() const; // still, after stop()
    // Window thread: waits until all is on disk. After it the folder is whole.
    void finish();
    // Why the last recording ended by itself; empty = it did not.
    std::string failure() const;
    uint64_t lost() const { return lost_.load(); }
    uint64_t images() const { return images_.load(); }

    // Writer thread of the run.
    void frame(const PublishedFrame& frame, const Fixtures& set) override;
    void query(const QueryNote&) override {}
    void step(const TickRow& row, const PublishedFrame*, bool, std::span<const uint32_t>) override;

private:
    template <class Job>
    void orFail(const Job& job); // with mutex_ held
    void openFiles(const std::filesystem::path& folder);
    void addImage(const PublishedFrame& frame, const Fixtures& set);
    void addEdit(const PublishedFrame& frame);
    void putEdit(uint64_t image, bool still);
    void flushTurns(double from, double to, double start, double scale);
    void putTurn(const TickRow& row, double t);
    int64_t imageOf(int64_t frame) const; // of this recording; -1 = from before it

    std::atomic<bool> recording_{false};
    std::atomic<uint64_t> lost_{0}, images_{0};
    mutable std::mutex mutex_; // of everything below; window and writer thread
    std::unique_ptr<RecordingWriter> writer_;
    std::string failure_;
    std::deque<TickRow> ticks_;                        // since the last picture
    std::deque<std::pair<int64_t, uint64_t>> numbers_; // of late pictures: index in the run, in the recording
    double lastCapture_ = -1.0, lastWritten_ = -1.0;
    LineFile hand_, wrench_, touches_, edits_;
    std::filesystem::path folder_;
    RecordedScene edited_;                                    // in force
    std::deque<std::pair<uint64_t, RecordedScene>> upcoming_; // by number of the change
    uint32_t scenes_ = 0;                                     // files scene-N.yaml
    bool still_ = false;
};

} // namespace fathom::operate
