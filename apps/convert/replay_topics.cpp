// SPDX-License-Identifier: Apache-2.0
#include "apps/convert/replay_topics.h"

#include "apps/convert/message_time.h"
#include "apps/convert/regions_ply.h"
#include "apps/output/fixtures_ply.h"
#include "devices/bag/ros2_messages.h"
#include "engine/types/error.h"
#include "engine/types/log.h"
#include "engine/types/number_text.h"

#include <algorithm>
#include <cmath>

namespace fathom {

namespace {

constexpr const char* kBase = "base";

uint16_t replayChannel(McapWriter& writer, const std::string& topic, const std::string& type) {
    return writer.addChannel(topic, type, ros2::definition(type));
}

// Seven values from `at` on: position, then w x y z.
Pose poseOf(const std::vector<double>& row, size_t at) {
    return {{row[at], row[at + 1], row[at + 2]}, {row[at + 3], row[at + 4], row[at + 5], row[at + 6]}};
}

// Nothing in a replay's folder names its source. Of another one it may have too many frames.
void checkIndices(const std::filesystem::path& file, uint32_t sourceFrames) {
    ReplayCsv frames(file, {"index"});
    for (auto row = frames.next(); row && sourceFrames > 0; row = frames.next()) {
        if (!((*row)[0] < sourceFrames)) {
            throw BadInput(file.string(), "index", significant((*row)[0], 10),
                           "0 to " + std::to_string(sourceFrames - 1) +
                               ": the frames of the source, which the replay must have played");
        }
    }
}

} // namespace

ReplayTopics::ReplayTopics(const std::filesystem::path& folder, McapWriter& writer, uint32_t sourceFrames)
    : folder_(folder)
    , writer_(writer)
    , ticks_(folder / "haptics.csv",
             {"t_s",    "fx",     "fy",     "fz",      "tx",      "ty",      "tz",
              "tool_x", "tool_y", "tool_z", "tool_qw", "tool_qx", "tool_qy", "tool_qz",
              "dev_x",  "dev_y",  "dev_z",  "dev_qw",  "dev_qx",  "dev_qy",  "dev_qz"})
    , frames_(folder / "frames.csv", {"index", "t_s"})
    , tick_(ticks_.next())
    , played_(frames_.next())
    , wrench_(replayChannel(writer, "/fathom/wrench", "geometry_msgs/msg/WrenchStamped"))
    , tool_(replayChannel(writer, "/fathom/tool_pose", "geometry_msgs/msg/PoseStamped"))
    , device_(replayChannel(writer, "/fathom/device_pose", "geometry_msgs/msg/PoseStamped"))
    , regions_(replayChannel(writer, "/fathom/regions", "sensor_msgs/msg/PointCloud2")) {
    checkIndices(folder / "frames.csv", sourceFrames);
}

void ReplayTopics::addTick(const std::vector<double>& tick, uint64_t time) {
    constexpr size_t kWrench = 1, kTool = 7, kDevice = 14;
    const ros2::Header header{time, kBase};
    const auto vector = [&](size_t at) { return dvec3(tick[at], tick[at + 1], tick[at + 2]); };
    writer_.add(wrench_, time, ros2::wrench(header, vector(kWrench), vector(kWrench + 3)));
    writer_.add(tool_, time, ros2::pose(header, poseOf(tick, kTool)));
    writer_.add(device_, time, ros2::pose(header, poseOf(tick, kDevice)));
}

void ReplayTopics::addRegions(uint32_t index, double stamp) {
    const std::filesystem::path file = folder_ / fixturesFileName(index);
    if (std::filesystem::exists(file)) {
        const uint64_t time = messageTime(stamp);
        writer_.add(regions_, time, ros2::regions({time, kBase}, readRegionsPly(file)));
    }
}

// Ticks before `played` [s]: from the last frame's stamp towards that of `to`.
void ReplayTopics::ticksUntil(double played, const Anchor& to) {
    const Anchor from = last_.value_or(to);
    const double length = to.played - from.played;
    const double rate = length > 0.0 ? (to.stamp - from.stamp) / length : 1.0;
    for (; tick_ && (*tick_)[0] < played; tick_ = ticks_.next()) {
        const double stamp = from.stamp + rate * ((*tick_)[0] - from.played);
        addTick(*tick_, messageTime(std::max(0.0, stamp))); // ticks before a first frame at 0 s
    }
}

void ReplayTopics::frame(uint32_t index, double stamp) {
    while (played_ && (*played_)[0] < index) {
        played_ = frames_.next();
    }
    ++frameCount_;
    if (!played_ || (*played_)[0] != index) {
        return; // the replay did not use it
    }
    ++playedCount_;
    const Anchor now{(*played_)[1], stamp};
    ticksUntil(now.played, now);
    addRegions(index, stamp);
    last_ = now;
}

void ReplayTopics::end() {
    if (!last_) {
        throw BadInput((folder_ / "frames.csv").string(), "index", "no frame of this source",
                       "the replay of the source that is converted");
    }
    const Anchor rest = *last_;
    ticksUntil(HUGE_VAL, rest);
    if (playedCount_ < frameCount_) {
        log::warn("{}: the replay played {} of {} frames of the source; is it of the same source?",
                  (folder_ / "frames.csv").string(), playedCount_, frameCount_);
    }
}

} // namespace fathom
