// SPDX-License-Identifier: Apache-2.0
// What the program says about folders that it cannot read as they are meant.
#include "devices/recorded/recorded_camera.h"
#include "devices/recorded/unread_poses.h"
#include "tests/devices/played_bag.h"
#include "tests/realtime/listening.h"

using namespace fathom;
using namespace fathom::testing;

namespace {

// Stamps in units of which a second has so many.
void writeStamps(const TemporaryFolder& folder, long perSecond) {
    writeSmallRecording(folder, 3);
    std::string index;
    for (long i = 0; i < 3; ++i) {
        const std::string stamp = std::to_string(1700000000 * perSecond + i * perSecond / 30 + i),
                          name = std::to_string(i) + ".png";
        index += stamp + " rgb/" + name + " " + stamp + " depth/" + name + "\n";
    }
    folder.write("associations.txt", index);
}

} // namespace

TEST_CASE("Text files of a folder in UTF-16 are refused as such") {
    for (const char* name : {"intrinsics.json", "associations.txt", "poses.txt"}) {
        const TemporaryFolder folder;
        writeSmallRecording(folder, 1);
        folder.write(name, std::string("\xff\xfe{\0 \0", 6));
        lineSays(recordingRefusal(folder.path()),
                 std::string(name) + ": content: UTF-16 text: save it as UTF-8");
    }
}
