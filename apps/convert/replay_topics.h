// SPDX-License-Identifier: Apache-2.0
// The results of a replay, as topics of the same file as its frames.
#pragma once

#include "apps/convert/replay_csv.h"
#include "devices/bag/mcap_writer.h"

#include <filesystem>
#include <optional>

namespace fathom {

// /fathom/wrench, /fathom/tool_pose and /fathom/device_pose of every tick; /fathom/regions of every frame
// that has a file of `replay --save-fixtures`. Frame "base". Ticks are placed between the stamps of the
// frames as they are between the frames of the replay. One thread.
class ReplayTopics {
public:
    // The writer must outlive it. sourceFrames: Camera::frameCount() of the source. Throws BadInput for a
    // folder without haptics.csv and frames.csv, and for a replay of frames beyond those of the source.
    ReplayTopics(const std::filesystem::path& folder, McapWriter& writer, uint32_t sourceFrames);

    // Call with each frame, in order. index: of the source; stamp [s]: its capture time. Writes the ticks
    // before it, and its regions. Throws BadInput for a damaged file.
    void frame(uint32_t index, double stamp);
    // Writes the rest. Throws BadInput when the replay played no frame of this source. Warns when it did not
    // play all frames.
    void end();

private:
    struct Anchor {
        double played = 0.0, stamp = 0.0; // [s] of one frame: in the replay, and in the source
    };
    void ticksUntil(double played, const Anchor& to);
    void addTick(const std::vector<double>& tick, uint64_t time);
    void addRegions(uint32_t index, double stamp);

    std::filesystem::path folder_;
    McapWriter& writer_;
    ReplayCsv ticks_, frames_;
    std::optional<std::vector<double>> tick_, played_; // the next rows
    std::optional<Anchor> last_;
    uint64_t frameCount_ = 0, playedCount_ = 0; // of the source so far; those that the replay played
    uint16_t wrench_, tool_, device_, regions_;
};

} // namespace fathom
