// SPDX-License-Identifier: Apache-2.0
// Everything of a session into a folder that `fathom replay FOLDER/scene.yaml` plays: pictures, hand, wrench
// and the settings in force.
#pragma once

#include "apps/operate/snapshots.h"

#include <condition_variable>
#include <deque>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <thread>

namespace fathom::operate {

// A TUM RGB-D folder with hand.csv (raw poses and buttons), wrench.csv and touches.csv (what the hand felt,
// turn_log.h) and scene.yaml.
// Frame j of a replay comes at j / 30 s, so the times of hand and wrench are bent to that, frame by frame.
// PNG files are written on a thread of this object's own; pictures that it cannot keep up with are counted in
// lost().
class Recorder final : public RunSink {
public:
    ~Recorder() override { stop(); }

    // Window thread. scene: the text of its file in force. Throws Error that names what cannot be written.
    void start(const std::filesystem::path& folder, const std::string& scene, const CameraInfo& camera);
    // Whole files on return; where: the folder. Nothing when it is not recording.
    void stop();
    bool recording() const { return recording_.load(); }
    uint64_t lost() const { return lost_.load(); }
    uint64_t pictures() const { return pictures_.load(); }

    // Writer thread of the run.
    void frame(const PublishedFrame& frame, const Fixtures& set) override;
    void query(const QueryNote&) override {}
    void turn(const TurnRow& row, const PublishedFrame*, bool, std::span<const uint32_t>) override;

private:
    struct Picture {
        std::vector<uint16_t> depth;
        std::vector<uint32_t> colour;
        Pose baseTcamera;
    };
    void writePictures();
    void flushTurns(double from, double to, double start, double scale);
    void putTurn(const TurnRow& row, double t);
    int64_t pictureOf(int64_t frame) const; // of this recording; -1 = from before it

    std::filesystem::path folder_;
    CameraInfo camera_;
    std::atomic<bool> recording_{false};
    std::atomic<uint64_t> lost_{0}, pictures_{0};
    std::mutex mutex_; // of everything below; window, writer and PNG thread
    std::condition_variable more_;
    std::deque<Picture> waiting_;
    std::deque<TurnRow> turns_;                        // since the last picture
    std::deque<std::pair<int64_t, uint64_t>> numbers_; // of late pictures: index in the run, in the recording
    double lastCapture_ = -1.0, lastWritten_ = -1.0;
    bool ending_ = false;
    std::ofstream hand_, wrench_, touches_, index_, poses_;
    std::thread thread_;
};

} // namespace fathom::operate
