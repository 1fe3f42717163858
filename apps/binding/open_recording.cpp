// SPDX-License-Identifier: Apache-2.0
#include "apps/binding/open_recording.h"

#include "devices/bag/open_bag.h"
#include "devices/bag/split_recording.h"
#include "devices/pcd/pcd_camera.h"
#include "devices/recorded/recorded_camera.h"
#include "engine/types/error.h"
#include "engine/types/read_file.h"
#include "engine/types/stand_in.h"

#include <array>

namespace fathom {

namespace {

enum class Kind { Unknown, Messages, Cloud };

constexpr const char* kKinds =
    "a recording folder, a ROS bag (.bag), MCAP (.mcap), a ROS 2 database (.db3), "
    "a recording of an Azure Kinect (.mkv), an organised cloud (.pcd, .ply), or a live camera: "
    "v4l2:auto, v4l2:/dev/videoN, openni2, ros2:depth=TOPIC";

struct KnownFile {
    std::string_view ending, begin;
    Kind kind;
};
constexpr std::array kFiles{KnownFile{".bag", "#ROSBAG", Kind::Messages},
                            KnownFile{".mcap", "\x89MCAP0\r\n", Kind::Messages},
                            KnownFile{".db3", "SQLite format 3", Kind::Messages},
                            KnownFile{".mkv", "\x1a\x45\xdf\xa3", Kind::Messages},
                            KnownFile{".pcd", "# .PCD", Kind::Cloud},
                            KnownFile{".ply", "ply\n", Kind::Cloud},
                            KnownFile{".ply", "ply\r\n", Kind::Cloud}};

Kind kindOf(const std::filesystem::path& file) {
    const std::string ending = endingOf(file);
    const std::string begin = firstBytes(file, 16);
    for (const KnownFile& known : kFiles) {
        if (begin.starts_with(known.begin)) {
            return known.kind;
        }
    }
    for (const KnownFile& known : kFiles) {
        if (ending == known.ending) {
            return known.kind;
        }
    }
    return Kind::Unknown;
}

constexpr const char* kOptions =
    "depth=, colour=, info=, intrinsics=, extrinsics=, scale=, start= and duration= after the file name";

// Names an unknown option where the file is there without it.
void checkExists(const std::string& file) {
    std::error_code failed;
    if (std::filesystem::exists(file, failed)) {
        return;
    }
    const size_t equals = file.rfind('='), comma = file.rfind(',', equals);
    for (size_t end = comma; equals != std::string::npos && end != std::string::npos && end > 0;
         end = file.rfind(',', end - 1)) {
        if (std::filesystem::exists(file.substr(0, end), failed)) {
            throw BadInput("--source", file.substr(end + 1), "unknown", kOptions);
        }
    }
    if (kindOf(file) != Kind::Unknown) {
        throw BadInput(file, "file", "missing", kKinds);
    }
}

bool isRos2Folder(const std::filesystem::path& folder) {
    return !std::filesystem::exists(folder / "intrinsics.json") && isRos2Recording(folder);
}

bool isMessages(const std::filesystem::path& file) {
    std::error_code failed;
    return std::filesystem::is_directory(file, failed) ? isRos2Folder(file) : kindOf(file) == Kind::Messages;
}

} // namespace

std::unique_ptr<MessageFile> openMessages(const std::string& source) {
    const std::string file = parseSource(source).file;
    checkExists(file);
    return isMessages(file) ? openMessageFile(file) : nullptr;
}

std::unique_ptr<Camera> openRecording(const SourceRequest& request) {
    const std::filesystem::path file = request.file;
    checkExists(request.file);
    std::error_code failed;
    if (std::filesystem::is_directory(file, failed)) {
        if (isRos2Folder(file)) {
            return openBag(file, request.options);
        }
        return std::make_unique<RecordedCamera>(file, request.options);
    }
    switch (kindOf(file)) {
    case Kind::Messages:
        return openBag(file, request.options);
    case Kind::Cloud:
        return std::make_unique<PcdCamera>(file, request.options);
    case Kind::Unknown:
        refuseStandIn(file, kKinds);
        break;
    }
    const bool exists = std::filesystem::exists(file, failed);
    throw BadInput(request.file, exists ? "kind" : "file",
                   exists ? "a file of a kind that is not read" : "missing", kKinds);
}

} // namespace fathom
