// SPDX-License-Identifier: Apache-2.0
#include "apps/convert/tum_folder.h"

#include "devices/recorded/text_file.h"
#include "engine/types/output_file.h"
#include "engine/types/split_words.h"

namespace fathom {

TumFolder::TumFolder(const std::filesystem::path& folder, const CameraInfo& camera)
    : folder_(folder)
    , colour_(camera.hasColour)
    , writer_(folder, camera, 2) {}

void TumFolder::finish() {
    writer_.finish();
    if (colour_) {
        writeIndexes();
    }
    if (std::filesystem::exists(folder_ / "poses.txt")) {
        OutputFile truth(folder_ / "groundtruth.txt");
        truth.write("# timestamp tx ty tz qx qy qz qw\n");
        DataLines lines(folder_ / "poses.txt");
        for (TextLine line; lines.next(line);) {
            truth.write(line.text + "\n");
        }
        truth.commit();
    }
}

// associations.txt holds both: "t_rgb rgb/x.png t_depth depth/x.png".
void TumFolder::writeIndexes() const {
    OutputFile colour(folder_ / "rgb.txt"), depth(folder_ / "depth.txt");
    DataLines lines(folder_ / "associations.txt");
    for (TextLine line; lines.next(line);) {
        const auto words = splitWords(line.text);
        colour.write(std::string(words[0]) + " " + std::string(words[1]) + "\n");
        depth.write(std::string(words[2]) + " " + std::string(words[3]) + "\n");
    }
    colour.commit();
    depth.commit();
}

} // namespace fathom
